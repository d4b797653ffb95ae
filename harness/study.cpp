#include "harness/study.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "groups/decimal.h"
#include "harness/errors.h"
#include "harness/scene_problem.h"

namespace liebench {

namespace {

constexpr int most_step_sizes = 1000;

struct ProblemChoice {
  const ProblemInfo* problem;
  const FormulationInfo* formulation;
  Json parameters;
};

struct MethodChoice {
  const MethodInfo* method;
  OptionValues options;
  JsonView entry;
};

struct Interval {
  double t_0 = 0.0;
  double t_end = 0.0;
  int local_steps = 0;  // 0: the interval counts
};

// Values of a key that may hold one or a list; the fallback where it is absent.
std::vector<JsonView> alternatives(const JsonView& object, const std::string& key) {
  if (!object.has(key)) return {};
  const JsonView value = object[key];
  if (!value.is_array()) return {value};
  value.require_array();
  std::vector<JsonView> list;
  for (std::size_t i = 0; i < value.size(); ++i) list.push_back(value[i]);
  return list;
}

template <class Info>
const Info& by_name(const std::vector<Info>& list, const JsonView& view, std::string_view what) {
  std::vector<std::string> names;
  for (const Info& info : list) names.emplace_back(info.name);
  const std::string word = view.word(names, what);
  return *std::find_if(list.begin(), list.end(), [&](const Info& info) { return info.name == word; });
}

// One set of parameters, and where those of its values stand that come out of a list.
struct ParameterSet {
  Json values;
  std::map<std::string, std::string> places;  // pointer of the parameter -> pointer of the element
};

// Parameters whose own shape is a number may be lists; the product of all of them.
std::vector<ParameterSet> expand_parameters(const ProblemInfo& problem, const JsonView& view) {
  std::vector<ParameterSet> expanded{{view.value(), {}}};
  for (const ParameterInfo& info : problem.parameters) {
    const std::string key(info.name);
    if (!info.fallback.is_number() || !view.has(key) || !view[key].is_array()) continue;
    const JsonView list = view[key];
    list.require_array();
    std::vector<ParameterSet> next;
    for (const ParameterSet& set : expanded)
      for (std::size_t i = 0; i < list.size(); ++i) {
        next.push_back(set);
        next.back().values[key] = list[i].value();
        next.back().places[list.pointer()] = list[i].pointer();
      }
    expanded = std::move(next);
  }
  return expanded;
}

Json complete(const ProblemInfo& problem, const ParameterSet& set, const std::string& pointer) {
  try {
    return problem.complete({set.values, pointer});
  } catch (const InputError& error) {
    const auto place = set.places.find(error.place());
    if (place == set.places.end()) throw;
    throw InputError(place->second, error.message());
  }
}

std::vector<ProblemChoice> read_problems(const JsonView& list) {
  list.require_array();
  std::vector<ProblemChoice> choices;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView entry = list[i];
    if (entry.value().is_object() && entry.has("scene")) {
      entry.require_object({"scene"});
      const ProblemInfo& scene = scene_problem(entry["scene"].text());
      choices.push_back({&scene, &scene.formulations.front(), scene.complete(entry)});
      continue;
    }
    entry.require_object({"name", "formulation", "parameters", "scene"});
    entry.require_key("name");
    const ProblemInfo& problem = by_name(problems(), entry["name"], "problem");
    std::vector<const FormulationInfo*> formulations;
    for (const JsonView& view : alternatives(entry, "formulation"))
      formulations.push_back(&by_name(problem.formulations, view, "formulation"));
    if (formulations.empty()) formulations.push_back(&problem.formulations.front());
    const Json none = Json::object();
    const JsonView parameters =
        entry.has("parameters") ? entry["parameters"] : JsonView(none, entry.pointer() + "/parameters");
    if (!parameters.value().is_object()) parameters.reject("an object");
    std::vector<Json> sets;
    for (const ParameterSet& set : expand_parameters(problem, parameters))
      sets.push_back(complete(problem, set, parameters.pointer()));
    for (const FormulationInfo* formulation : formulations)
      for (const Json& set : sets) choices.push_back({&problem, formulation, set});
  }
  return choices;
}

// Where other methods have it; another key is refused with those that are allowed.
void refuse_option_of_others(const MethodInfo& method, const JsonView& entry, const std::string& key) {
  std::vector<std::string> others;
  for (const MethodInfo& other : methods())
    if (has_option(other, key)) others.emplace_back(other.name);
  if (others.empty()) return;
  throw InputError(entry[key].pointer(),
                   fmt::format("{} has no option \"{}\" and integrates {}; methods that have it: {}",
                               method.name, key, fits_text(method), quoted_list(others)));
}

std::vector<MethodChoice> read_methods(const JsonView& list, Start start) {
  list.require_array();
  std::vector<MethodChoice> choices;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView entry = list[i];
    if (!entry.value().is_object()) entry.reject("an object with the key \"name\"");
    entry.require_key("name");
    const MethodInfo& method = by_name(methods(), entry["name"], "integrator");
    if (entry.has("tolerance") && !method.chooses_steps)
      throw InputError(
          entry["tolerance"].pointer(),
          fmt::format(
              "{} takes the steps of \"step_sizes\" and knows no tolerance; methods that choose their "
              "steps: {}",
              method.name, methods_that_choose_steps(true)));
    std::vector<std::string> keys{"name"};
    for (const OptionInfo& info : method.options) keys.emplace_back(info.name);
    for (const auto& [key, value] : entry.value().items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) refuse_option_of_others(method, entry, key);
    entry.require_object(keys);
    std::vector<OptionValues> expanded(1);
    for (const OptionInfo& info : method.options) {
      std::vector<OptionValue> values;
      for (const JsonView& view : alternatives(entry, std::string(info.name)))
        values.push_back(option_value(info, view));
      if (values.empty()) values.push_back(option_default(info, start == Start::self));
      std::vector<OptionValues> next;
      for (const OptionValues& options : expanded)
        for (const OptionValue& value : values) {
          next.push_back(options);
          next.back().set(info.name, value);
        }
      expanded = std::move(next);
    }
    for (OptionValues& options : expanded) choices.push_back({&method, std::move(options), entry});
  }
  return choices;
}

// Options without those that mean nothing for this formulation.
OptionValues applicable_options(const MethodInfo& method, OptionValues options,
                                const FormulationInfo& formulation) {
  for (const OptionInfo& info : method.options)
    if (!applies(info, formulation.constraints > 0, options) || goes_without_saying(info, options))
      options.erase(info.name);
  return options;
}

// An option that the study gives must mean something in one of its runs at least.
void require_scopes(const std::vector<ProblemChoice>& problems, const std::vector<MethodChoice>& methods) {
  for (const MethodChoice& choice : methods)
    for (const OptionInfo& info : choice.method->options) {
      const std::string key(info.name);
      if (info.scope == OptionScope::everywhere || !choice.entry.has(key)) continue;
      const bool somewhere = std::any_of(problems.begin(), problems.end(), [&](const ProblemChoice& problem) {
        return std::any_of(methods.begin(), methods.end(), [&](const MethodChoice& other) {
          return other.entry.pointer() == choice.entry.pointer() &&
                 applies(info, problem.formulation->constraints > 0, other.options);
        });
      });
      if (!somewhere)
        throw InputError(
            choice.entry[key].pointer(),
            fmt::format("\"{}\" has no effect in any run of this entry: it needs {}; leave it out", key,
                        scope_text(info)));
    }
}

// Every method must integrate every problem of the study, and be able to run at all.
void require_fits(const std::vector<ProblemChoice>& problems, const std::vector<MethodChoice>& methods) {
  for (const MethodChoice& choice : methods) {
    for (const ProblemChoice& problem : problems)
      if (const std::string reason = misfit(*choice.method, problem.problem->name,
                                            problem.formulation->constraints > 0, problem.formulation->name);
          !reason.empty())
        throw InputError(choice.entry["name"].pointer(), fmt::format("{} in {}: {}", problem.problem->name,
                                                                     problem.formulation->name, reason));
    if (const std::string_view reason = obstacle_to(*choice.method); !reason.empty())
      throw InputError(choice.entry["name"].pointer(), fmt::format("{}: {}", choice.method->name, reason));
  }
}

// Solvers from outside know double alone.
void require_precision(const JsonView& extended, const std::vector<MethodChoice>& choices) {
  for (const MethodChoice& choice : choices) {
    if (choice.method->outside == nullptr) continue;
    std::vector<std::string> fitting;
    for (const MethodInfo& other : methods())
      if (other.outside == nullptr) fitting.emplace_back(other.name);
    throw InputError(extended.pointer(),
                     fmt::format("{} runs in \"double\" alone. What runs in \"extended\": {}",
                                 choice.method->name, quoted_list(fitting)));
  }
}

double positive_step(const JsonView& view) {
  const double h = view.number("a positive step size in s");
  if (!(h > 0.0)) view.reject("a positive step size in s");
  return h;
}

struct StepSize {
  double value;
  std::string pointer;
};

std::vector<StepSize> read_step_sizes(const JsonView& view) {
  std::vector<StepSize> sizes;
  if (view.value().is_object()) {
    view.require_object({"from", "to", "per_decade"});
    for (const char* key : {"from", "to", "per_decade"}) view.require_key(key);
    const double from = positive_step(view["from"]), to = positive_step(view["to"]);
    const int per_decade = view["per_decade"].integer_in(1, 100);
    if (to > from) view["to"].reject(fmt::format("at most \"from\", {}", from));
    const double exact_count = std::floor((std::log10(from) - std::log10(to)) * per_decade + 1e-9) + 1.0;
    if (exact_count > most_step_sizes)
      view.reject(fmt::format("at most {} step sizes; this is {:.0f}", most_step_sizes, exact_count));
    const int count = int(exact_count);
    for (int i = 0; i < count; ++i)
      sizes.push_back({from * std::pow(10.0, -double(i) / per_decade), view.pointer()});
    return sizes;
  }
  view.require_array();
  for (std::size_t i = 0; i < view.size(); ++i) sizes.push_back({positive_step(view[i]), view[i].pointer()});
  return sizes;
}

Interval read_interval(const JsonView& study) {
  Interval interval;
  if (study.has("t_0")) interval.t_0 = study["t_0"].number("a finite time in s");
  if (study.has("steps")) {
    if (study.has("t_end")) study["steps"].reject("either \"t_end\" or \"steps\", not both");
    interval.local_steps = study["steps"].integer_in(1, 1000000);
    return interval;
  }
  study.require_key("t_end");
  interval.t_end = study["t_end"].number("a time in s after t_0");
  if (!(interval.t_end > interval.t_0))
    study["t_end"].reject(fmt::format("a time after t_0 = {} s", interval.t_0));
  return interval;
}

// The number of steps a method's start covers: k of a k-step method.
int start_steps(const MethodChoice& choice) {
  const auto k = choice.options.all().find("k");
  return k == choice.options.all().end() ? 1 : std::get<int>(k->second);
}

// The whole interval is the grid of a method that chooses its steps.
void set_interval(RunSpec& run, const Interval& interval, const MethodChoice& choice) {
  if (interval.local_steps > 0)
    throw InputError(choice.entry["name"].pointer(),
                     fmt::format("{} chooses its steps; a study with \"steps\" gives their number: give "
                                 "\"t_end\" in its place",
                                 choice.method->name));
  run.t_0 = interval.t_0;
  run.t_end = interval.t_end;
  run.request.chooses_steps = true;
  run.request.steps = most_chosen_steps;
  run.request.step_size = decimal<Extended>(interval.t_end) - decimal<Extended>(interval.t_0);
}

void set_grid(RunSpec& run, const Interval& interval, const StepSize& size, const MethodChoice& choice) {
  run.requested_step_size = size.value;
  run.t_0 = interval.t_0;
  const int k = start_steps(choice);
  if (interval.local_steps > 0) {
    run.local_steps = interval.local_steps;
    run.request.step_size = decimal<Extended>(size.value);
    run.request.steps = std::uint64_t(k - 1 + interval.local_steps);
    run.t_end = interval.t_0 + double(run.request.steps) * size.value;
    return;
  }
  const double length = interval.t_end - interval.t_0;
  // Round-off of a division that comes out even must not add a step.
  const double steps = std::ceil(length / size.value * (1.0 - 1e-12));
  if (!(steps <= most_steps))
    throw InputError(size.pointer, fmt::format("{} would take {:.3g} steps; at most {:.0e} are allowed",
                                               size.value, steps, most_steps));
  if (steps < k)
    throw InputError(
        size.pointer,
        fmt::format("{} gives {:.0f} steps in [{}, {}]; allowed: at least {}, the steps that {} with "
                    "k = {} starts from",
                    size.value, steps, interval.t_0, interval.t_end, k, choice.method->name, k));
  run.request.steps = std::uint64_t(steps);
  run.request.step_size =
      (decimal<Extended>(interval.t_end) - decimal<Extended>(interval.t_0)) / Extended(steps);
  run.t_end = interval.t_end;
}

}  // namespace

std::string_view name(Start start) {
  return start == Start::reference ? "reference" : "self";
}

std::string_view name(Precision precision) {
  return precision == Precision::extended ? "extended" : "double";
}

double RunSpec::duration() const {
  return step_size() * (method->chooses_steps ? 1.0 : double(request.steps));
}

Json RunSpec::canonical_input() const {
  Json j;
  j["numerical_version"] = numerical_version;
  j["problem"] = problem->name;
  j["formulation"] = formulation->name;
  j["parameters"] = parameters;
  if (problem->fingerprint) j["fingerprint"] = problem->fingerprint(parameters);
  j["integrator"] = method->name;
  j["options"] = options_to_json(*method, request.options);
  j["start"] = name(request.start);
  j["precision"] = name(precision);
  j["t_0"] = t_0;
  if (method->chooses_steps) {
    j["t_end"] = t_end;
    return j;
  }
  j["steps"] = request.steps;
  // The step size of an interval follows from its ends and the number of steps; that of local runs is given.
  if (local_steps > 0)
    j["step_size"] = requested_step_size;
  else
    j["t_end"] = t_end;
  return j;
}

std::string RunSpec::key() const {
  const std::string text = canonical_input().dump();
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

Study read_study(const Json& json) {
  const JsonView root(json, "");
  root.require_object(
      {"name", "problems", "integrators", "step_sizes", "t_0", "t_end", "steps", "start", "precision"});
  for (const char* key : {"name", "problems", "integrators"}) root.require_key(key);
  Study study;
  study.name = root["name"].text();
  if (study.name.empty()) root["name"].reject("a name that is not empty");
  const auto problem_choices = read_problems(root["problems"]);
  const Start start = root.has("start") && root["start"].word({"self", "reference"}, "start") == "reference"
                          ? Start::reference
                          : Start::self;
  const auto method_choices = read_methods(root["integrators"], start);
  require_fits(problem_choices, method_choices);
  require_scopes(problem_choices, method_choices);
  const bool all_choose = std::all_of(method_choices.begin(), method_choices.end(),
                                      [](const MethodChoice& c) { return c.method->chooses_steps; });
  if (!all_choose) root.require_key("step_sizes");
  if (all_choose && root.has("step_sizes"))
    throw InputError(
        root["step_sizes"].pointer(),
        "is not allowed here: all methods of this study choose their steps, by their \"tolerance\"");
  const auto sizes = root.has("step_sizes") ? read_step_sizes(root["step_sizes"]) : std::vector<StepSize>{};
  const Interval interval = read_interval(root);
  std::vector<Precision> precisions;
  for (const JsonView& view : alternatives(root, "precision")) {
    precisions.push_back(view.word({"double", "extended"}, "precision") == "extended"
                             ? Precision::extended
                             : Precision::double_precision);
    if (precisions.back() == Precision::extended) require_precision(view, method_choices);
  }
  if (precisions.empty()) precisions.push_back(Precision::double_precision);

  std::set<std::string> keys;
  for (const ProblemChoice& problem : problem_choices)
    for (const MethodChoice& method : method_choices)
      for (const Precision precision : precisions) {
        RunSpec run;
        run.study = study.name;
        run.problem = problem.problem;
        run.formulation = problem.formulation;
        run.parameters = problem.parameters;
        run.method = method.method;
        run.request.integrator = std::string(method.method->name);
        run.request.options = applicable_options(*method.method, method.options, *problem.formulation);
        run.request.start = start;
        run.precision = precision;
        const auto add = [&](const std::string& pointer) {
          const std::string obstacle = run.problem->obstacle(run.parameters, run.duration());
          if (!obstacle.empty()) throw InputError(pointer, obstacle);
          // Two ways to say the same run are one run.
          if (keys.insert(run.key()).second) study.runs.push_back(run);
        };
        if (method.method->chooses_steps) {
          set_interval(run, interval, method);
          add("/t_end");
          continue;
        }
        for (const StepSize& size : sizes) {
          set_grid(run, interval, size, method);
          add(run.local_steps > 0 ? size.pointer : "/t_end");
        }
      }
  return study;
}

}  // namespace liebench
