#include "harness/cli/scene_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/methods.h"
#include "harness/run_method.h"
#include "harness/scene_reader.h"
#include "harness/study.h"
#include "integrators/form.h"

namespace liebench {

namespace {

constexpr double usual_step_size = 1e-3;

const MethodInfo& method_of(const std::string& integrator, bool constrained) {
  std::vector<std::string> names;
  for (const MethodInfo& method : methods()) names.emplace_back(method.name);
  const MethodInfo* method = find_method(integrator);
  if (method == nullptr)
    throw InputError("--integrator", fmt::format("\"{}\" is not an integrator; allowed: {}{}", integrator,
                                                 quoted_list(names), suggestion(integrator, names)));
  if (const std::string reason = misfit(*method, "", constrained, "scene"); !reason.empty())
    throw InputError("--integrator", reason);
  return *method;
}

// Steps are either given or chosen by a tolerance.
void check_steps(const MethodInfo& method, const ScenePlanOptions& options) {
  if (method.chooses_steps && options.step_size)
    throw InputError("--h", fmt::format("{} chooses its steps, by a tolerance", method.name));
  if (!options.tolerance) return;
  if (!method.chooses_steps)
    throw InputError(
        "--tolerance",
        fmt::format("{} takes the steps of --h and knows no tolerance; methods that choose their "
                    "steps: {}",
                    method.name, methods_that_choose_steps(false)));
  for (const std::string& text : options.options)
    if (text.starts_with("tolerance="))
      throw InputError("--tolerance", fmt::format("is given twice, by --option {}, too", text));
  constexpr double least = 1e-15;
  if (*options.tolerance < least)
    throw InputError("--tolerance", fmt::format("{} is below the round-off of double; allowed: {} and more",
                                                *options.tolerance, least));
}

// "k=3", "form=stabilized_index2": values as in a study.
OptionValues method_options(const MethodInfo* method, const ScenePlanOptions& options, bool constrained) {
  std::vector<std::string> keys;
  for (const OptionInfo& info : method->options) keys.emplace_back(info.name);
  OptionValues values;
  for (const OptionInfo& info : method->options) values.set(info.name, option_default(info, true));
  std::vector<std::string> given = options.options;
  if (options.tolerance) given.push_back(fmt::format("tolerance={}", *options.tolerance));
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
  return values;
}

}  // namespace

void add_scene_plan(CLI::App& command, ScenePlanOptions& options) {
  command.add_option("scene", options.scene, "the scene, a JSON file (docs/scenes.md)")
      ->required()
      ->type_name("SCENE.json");
  command.add_option("--integrator", options.integrator, "the method; liebench list integrators")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--option", options.options,
                  "an option of the method, as often as needed; liebench describe NAME")
      ->type_name("KEY=VALUE");
  command
      .add_option("--h", options.step_size,
                  fmt::format("step size in s; made smaller until it divides the interval; {} where absent",
                              usual_step_size))
      ->type_name("H")
      ->check(positive_number());
  command.add_option("--t-end", options.t_end, "end of the interval in s; the scene's own where absent")
      ->type_name("T")
      ->check(positive_number());
}

AssembledScene assembled_scene(const std::string& file) {
  AssembledScene scene = assemble(read_scene_file(file), file);
  if (scene.moved())
    fmt::print(
        stderr,
        "the joints do not quite fit (joint \"{}\": {:.3g}); bodies were moved as little as possible\n",
        scene.gap_joint, scene.gap_before);
  std::string redundant;
  for (const std::string& joint : scene.redundant_joints)
    redundant += fmt::format("{}\"{}\"", redundant.empty() ? "" : ", ", joint);
  if (!redundant.empty())
    fmt::print(stderr, "left out, for other joints imply it: {} of the constraints of {}\n",
               std::count(scene.implied.begin(), scene.implied.end(), true), redundant);
  return scene;
}

ScenePlan plan_scene(const ScenePlanOptions& options) {
  ScenePlan result{assembled_scene(options.scene), {}};
  const AssembledScene& scene = result.scene;
  const double t_end = options.t_end > 0.0 ? options.t_end : scene.scene.duration;
  const bool constrained = !multiplier_names(scene).empty();
  const MethodInfo& method = method_of(options.integrator, constrained);
  check_steps(method, options);
  RunRequest request;
  request.integrator = options.integrator;
  request.options = method_options(&method, options, constrained);
  result.could_be_safeguarded =
      has_option(method, safeguard_option.name) && !request.options.boolean(safeguard_option.name);
  result.plan.method = detail::options_of(request);
  result.plan.chooses_steps = method.chooses_steps;
  if (method.chooses_steps) {
    result.plan.step_size = t_end;
    result.plan.steps = most_chosen_steps;
    return result;
  }
  const double h = options.step_size.value_or(usual_step_size);
  const double steps = std::ceil(t_end / h * (1.0 - 1e-12));
  if (!(steps <= most_steps))
    throw InputError(
        "--h", fmt::format("{} would take {:.3g} steps; at most {:.0e} are allowed", h, steps, most_steps));
  result.plan.step_size = t_end / steps;
  result.plan.steps = std::uint64_t(steps);
  return result;
}

}  // namespace liebench
