#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "harness/cli/commands.h"
#include "harness/cli/scene_plan.h"
#include "harness/errors.h"
#include "harness/progress.h"
#include "harness/simulate.h"
#include "harness/strict_json.h"

namespace liebench {

namespace {

struct SimulateOptions {
  ScenePlanOptions plan;
  std::uint64_t every = 1;
  std::string format = "csv";
  std::string out;
};

void append_csv(std::string& line, double value) {
  fmt::format_to(std::back_inserter(line), ",{}", value);
}

std::string csv_header(const AssembledScene& scene) {
  std::string line = "t";
  for (const BodyDescription& body : scene.scene.bodies) {
    for (const char* part : {"x", "y", "z"}) line += fmt::format(",{}.{}", body.name, part);
    if (body.kind != BodyKind::r3)
      for (const char* part : {"qw", "qx", "qy", "qz"}) line += fmt::format(",{}.{}", body.name, part);
    for (const char* part : {"vx", "vy", "vz"}) line += fmt::format(",{}.{}", body.name, part);
    if (body.kind != BodyKind::r3)
      for (const char* part : {"omega_x", "omega_y", "omega_z"})
        line += fmt::format(",{}.{}", body.name, part);
  }
  for (const std::string& name : multiplier_names(scene)) line += ",lambda." + name;
  return line + ",energy,position_constraint,velocity_constraint\n";
}

std::string csv_line(const Sample& sample) {
  std::string line = fmt::format("{}", sample.time);
  for (const BodySample& body : sample.bodies) {
    for (const double x : body.position) append_csv(line, x);
    if (body.rotates)
      for (const double x : body.orientation) append_csv(line, x);
    for (const double x : body.velocity) append_csv(line, x);
    if (body.rotates)
      for (const double x : body.angular_velocity) append_csv(line, x);
  }
  for (const double x : sample.multipliers) append_csv(line, x);
  for (const double x : {sample.energy, sample.position_constraint, sample.velocity_constraint})
    append_csv(line, x);
  return line + "\n";
}

std::string json_line(const Sample& sample, const AssembledScene& scene,
                      const std::vector<std::string>& names) {
  Json row;
  row["t"] = sample.time;
  for (std::size_t i = 0; i < sample.bodies.size(); ++i) {
    const BodySample& body = sample.bodies[i];
    Json& entry = row["bodies"][scene.scene.bodies[i].name];
    entry["position"] = body.position;
    if (body.rotates) entry["orientation"] = body.orientation;
    entry["velocity"] = body.velocity;
    if (body.rotates) entry["angular_velocity"] = body.angular_velocity;
  }
  for (std::size_t i = 0; i < names.size(); ++i) row["multipliers"][names[i]] = sample.multipliers[i];
  row["energy"] = sample.energy;
  row["position_constraint"] = sample.position_constraint;
  row["velocity_constraint"] = sample.velocity_constraint;
  return row.dump() + "\n";
}

void run_simulation(const SimulateOptions& options) {
  const ScenePlan made = plan_scene(options.plan);
  const AssembledScene& scene = made.scene;
  SimulationPlan plan = made.plan;
  plan.every = options.every;
  const auto rows = multiplier_names(scene);
  const double t_end = plan.length();
  std::FILE* file = stdout;
  if (!options.out.empty()) {
    file = std::fopen(options.out.c_str(), "w");
    if (file == nullptr) throw MachineError(options.out + ": cannot be written");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> closing(options.out.empty() ? nullptr : file,
                                                                std::fclose);
  const auto write = [&](const std::string& line) {
    if (std::fwrite(line.data(), 1, line.size(), file) != line.size())
      throw MachineError((options.out.empty() ? "standard output" : options.out) + ": cannot write");
  };
  const bool csv = options.format == "csv";
  if (csv) write(csv_header(scene));
  Progress progress(scene.scene.name, t_end);
  double reached = 0.0;
  const auto failure = simulate(scene, plan, [&](const Sample& sample) {
    write(csv ? csv_line(sample) : json_line(sample, scene, rows));
    progress.advance(sample.time - reached);
    reached = sample.time;
  });
  if (std::fflush(file) != 0) throw MachineError(options.out + ": cannot write");
  if (!failure) return;
  progress.message(fmt::format("stopped at t = {:.6g} s, step {}: {}{}", failure->time, failure->step,
                               failure->message,
                               made.could_be_safeguarded ? "; --option safeguard=true may help" : ""));
}

}  // namespace

void add_simulate(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("simulate", "One trajectory of a scene, as CSV or JSON lines");
  auto options = std::make_shared<SimulateOptions>();
  add_scene_plan(*command, options->plan);
  command
      ->add_option(
          "--tolerance", options->plan.tolerance,
          "in place of --h, of a method that chooses its steps: the error of one; rows are its own steps")
      ->type_name("TOL")
      ->check(positive_number());
  command->add_option("--every", options->every, "write every n-th step only")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1000000000}))
      ->capture_default_str();
  command->add_option("--format", options->format, "csv or jsonl")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"csv", "jsonl"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "file to write; standard output where absent")
      ->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  liebench simulate builtin:double_pendulum --out pendulum.csv\n"
      "  liebench simulate scene.json --integrator generalized_alpha --option rho_inf=0.8 --h 1e-4 --every "
      "10\n"
      "  liebench simulate scene.json --integrator bliedf2nd_variable --tolerance 1e-8\n"
      "  liebench simulate scene.json --option k=4 --option form=stabilized_index2 --format jsonl");
  command->callback([options] { run_simulation(*options); });
}

}  // namespace liebench
