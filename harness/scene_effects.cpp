#include "harness/scene_effects.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "groups/counted.h"
#include "harness/instances/run_time_scenes.h"
#include "harness/median.h"
#include "harness/run_method.h"
#include "harness/scene_visit.h"

namespace liebench {

namespace {

struct Variant {
  std::string left_out;
  AssembledScene scene;
};

constexpr std::string_view gyroscopic = "gyroscopic";

template <class... Effects>
void add_variants(const AssembledScene& whole, const std::tuple<std::vector<Placed<Effects>>...>&,
                  std::vector<Variant>& variants) {
  const auto attempt = [&]<class Effect>(const std::vector<Placed<Effect>>*) {
    if (std::get<std::vector<Placed<Effect>>>(whole.scene.effects).empty()) return;
    Variant variant{std::string(Effect::name), whole};
    std::get<std::vector<Placed<Effect>>>(variant.scene.scene.effects).clear();
    variants.push_back(std::move(variant));
  };
  (attempt(static_cast<const std::vector<Placed<Effects>>*>(nullptr)), ...);
}

std::vector<Variant> variants_of(const AssembledScene& scene) {
  std::vector<Variant> variants{{"", scene}};
  add_variants(scene, scene.scene.effects, variants);
  const auto model = make_scene_model<double>(scene.scene, scene.implied);
  if (std::any_of(model->bodies.begin(), model->bodies.end(),
                  [](const Body<double>& body) { return body.gyroscopic; })) {
    Variant variant{std::string(gyroscopic), scene};
    for (BodyDescription& body : variant.scene.scene.bodies) body.gyroscopic = false;
    variants.push_back(std::move(variant));
  }
  return variants;
}

double flops_per_step(const AssembledScene& scene, const SimulationPlan& plan) {
  using Run = RunTimeSystem<Counted>;
  const auto stepper = any_stepper(plan.method, run_time_scene<Counted>(scene.scene, scene.implied));
  std::vector<SolutionPoint<Run>> points(std::size_t(stepper->starting_points()));
  if (stepper->start_itself(Counted(plan.step_size), points).outcome != Outcome::ok) return 0.0;
  const std::uint64_t steps = plan.steps + 1 - std::uint64_t(stepper->steps());
  const Operations before = Counted::operations();
  if (stepper->advance(steps).outcome != Outcome::ok) return 0.0;
  return double((Counted::operations() - before).total()) / double(steps);
}

// A variant made ready to be timed: its steps from a copy of the started stepper.
class Timed {
 public:
  virtual ~Timed() = default;
  virtual double ns_per_step() = 0;
};

template <class S>
class TimedScene final : public Timed {
 public:
  TimedScene(const S& system, const SimulationPlan& plan)
      : started_(any_stepper(plan.method, system)), running_(started_->clone()) {
    std::vector<SolutionPoint<S>> points(std::size_t(started_->starting_points()));
    started_->start_itself(plan.step_size, points);
    steps_ = std::min<std::uint64_t>(plan.steps + 1 - std::uint64_t(started_->steps()), most_timed_steps);
  }
  double ns_per_step() override {
    running_->assign(*started_);
    const auto begin = std::chrono::steady_clock::now();
    running_->advance(steps_);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    return taken.count() / double(steps_);
  }

 private:
  static constexpr std::uint64_t most_timed_steps = 2000;
  std::unique_ptr<AnyStepper<S>> started_, running_;
  std::uint64_t steps_ = 1;
};

double rotation_between(const BodySample& a, const BodySample& b) {
  const Quaternion<double> p(a.orientation.data()), q(b.orientation.data());
  return quaternion_log<double>(quaternion_product<double>(quaternion_conjugate<double>(p), q)).norm();
}

}  // namespace

std::vector<Ablation> ablations(const AssembledScene& scene, const SimulationPlan& plan,
                                const std::function<void(double)>& advance) {
  const std::vector<Variant> variants = variants_of(scene);
  const double parts = double(2 * variants.size() + 1);
  std::vector<Ablation> result;
  Sample reference;
  SimulationPlan end_only = plan;
  end_only.every = plan.steps;
  for (const Variant& variant : variants) {
    Ablation ablation{.left_out = variant.left_out, .failure = std::nullopt};
    Sample end;
    ablation.failure = simulate(variant.scene, end_only, [&](const Sample& sample) { end = sample; });
    if (!ablation.failure) {
      ablation.flops_per_step = flops_per_step(variant.scene, plan);
      if (result.empty()) {
        reference = end;
      } else if (!result.front().failure) {
        for (std::size_t i = 0; i < end.bodies.size(); ++i) {
          const auto &a = reference.bodies[i], &b = end.bodies[i];
          ablation.shift = std::max(ablation.shift,
                                    std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1],
                                               a.position[2] - b.position[2]));
          if (a.rotates) ablation.turn = std::max(ablation.turn, rotation_between(a, b));
        }
      }
    }
    result.push_back(std::move(ablation));
    advance(double(result.size()) / parts);
  }
  // Interleaved, so that what else the machine does meets all alike.
  std::vector<std::unique_ptr<Timed>> timed;
  for (const Variant& variant : variants)
    timed.push_back(with_scene(variant.scene, [&](const auto& system) -> std::unique_ptr<Timed> {
      return std::make_unique<TimedScene<std::remove_cvref_t<decltype(system)>>>(system, plan);
    }));
  constexpr int repetitions = 15;
  std::vector<std::vector<double>> times(variants.size());
  for (int r = 0; r < repetitions; ++r) {
    for (std::size_t i = 0; i < timed.size(); ++i)
      if (!result[i].failure) times[i].push_back(timed[i]->ns_per_step());
    advance((double(variants.size()) + double(variants.size() + 1) * (r + 1) / repetitions) / parts);
  }
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!times[i].empty()) result[i].ns_per_step = median(times[i]);
  return result;
}

}  // namespace liebench
