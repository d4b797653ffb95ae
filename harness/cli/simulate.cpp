#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/methods.h"
#include "harness/progress.h"
#include "harness/run_method.h"
#include "harness/scene_reader.h"
#include "harness/simulate.h"
#include "harness/study.h"

namespace liebench {

namespace {

struct SimulateOptions {
  std::string scene;
  std::string integrator = "bliedf2nd";
  std::vector<std::string> options;
  double step_size = 1e-3;
  double t_end = 0.0;
  std::uint64_t every = 1;
  std::string format = "csv";
  std::string out;
};

// "k=3", "form=stabilized_index2": values as in a study.
MethodOptions method_options(const std::string& integrator, const std::vector<std::string>& given,
                             bool constrained) {
  std::vector<std::string> names;
  for (const MethodInfo& method : methods()) names.emplace_back(method.name);
  const auto method = std::find_if(methods().begin(), methods().end(),
                                   [&](const MethodInfo& m) { return m.name == integrator; });
  if (method == methods().end())
    throw InputError("--integrator", fmt::format("\"{}\" is not an integrator; allowed: {}{}", integrator,
                                                 quoted_list(names), suggestion(integrator, names)));
  std::vector<std::string> keys;
  for (const OptionInfo& info : method->options) keys.emplace_back(info.name);
  OptionValues values;
  for (const OptionInfo& info : method->options) values.set(info.name, option_default(info, true));
  for (const std::string& text : given) {
    const std::string key = text.substr(0, text.find('='));
    const auto info = std::find_if(method->options.begin(), method->options.end(),
                                   [&](const OptionInfo& o) { return o.name == key; });
    if (info == method->options.end() || text.size() == key.size())
      throw InputError("--option", fmt::format("\"{}\" is not allowed; allowed: KEY=VALUE with a key of {}{}",
                                               text, quoted_list(keys), suggestion(key, keys)));
    const std::string word = text.substr(key.size() + 1);
    Json value = Json::parse(word, nullptr, false);
    if (value.is_discarded()) value = word;
    values.set(key, option_value(*info, JsonView(value, "--option " + key)));
  }
  for (const OptionInfo& info : method->options)
    if (!applies(info, constrained, values)) values.erase(info.name);
  RunRequest request;
  request.integrator = integrator;
  request.options = values;
  return detail::options_of(request);
}

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
  const SceneDescription described = read_scene_file(options.scene);
  const AssembledScene scene = assemble(described, options.scene);
  if (scene.moved())
    fmt::print(
        stderr,
        "the joints do not quite fit (joint \"{}\": {:.3g}); bodies were moved as little as possible\n",
        scene.gap_joint, scene.gap_before);
  if (!scene.redundant_joints.empty())
    fmt::print(stderr, "constraints that others imply are left out: {} of joint{} {}\n",
               std::count(scene.implied.begin(), scene.implied.end(), true),
               scene.redundant_joints.size() == 1 ? "" : "s", quoted_list(scene.redundant_joints));
  const double t_end = options.t_end > 0.0 ? options.t_end : described.duration;
  const double steps = std::ceil(t_end / options.step_size * (1.0 - 1e-12));
  if (!(steps <= most_steps))
    throw InputError("--h", fmt::format("{} would take {:.3g} steps; at most {:.0e} are allowed",
                                        options.step_size, steps, most_steps));
  const auto rows = multiplier_names(scene);
  const SimulationPlan plan{.method = method_options(options.integrator, options.options, !rows.empty()),
                            .step_size = t_end / steps,
                            .steps = std::uint64_t(steps),
                            .every = options.every};
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
  if (failure)
    progress.message(
        fmt::format("stopped at t = {:.6g} s, step {}: {}", failure->time, failure->step, failure->message));
}

}  // namespace

void add_simulate(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("simulate", "One trajectory of a scene, as CSV or JSON lines");
  auto options = std::make_shared<SimulateOptions>();
  command->add_option("scene", options->scene, "the scene, a JSON file (docs/scenes.md)")
      ->required()
      ->type_name("SCENE.json");
  command->add_option("--integrator", options->integrator, "the method; liebench list integrators")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--option", options->options, "an option of the method, as often as needed")
      ->type_name("KEY=VALUE");
  command->add_option("--h", options->step_size, "step size in s; made smaller until it divides the interval")
      ->type_name("H")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--t-end", options->t_end, "end of the interval in s; the scene's own where absent")
      ->type_name("T")
      ->check(CLI::PositiveNumber);
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
      "  liebench simulate problems/scenes/double_pendulum.json --out pendulum.csv\n"
      "  liebench simulate scene.json --integrator generalized_alpha --option rho_inf=0.8 --h 1e-4 --every "
      "10\n"
      "  liebench simulate scene.json --option k=4 --option form=stabilized_index2 --format jsonl");
  command->callback([options] { run_simulation(*options); });
}

}  // namespace liebench
