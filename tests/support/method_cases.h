#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "integrators/fits.h"
#include "integrators/form.h"
#include "integrators/list.h"
#include "integrators/option.h"
#include "integrators/step_control.h"
#include "tests/support/steppers.h"

// Every integrator of the program in every combination of its options, with what it declares of itself, for laws that hold
// for all of them. A new method joins by its line in integrators/list.h.

namespace liebench {

// What a test tries of one option: all integers, all words, both booleans; of a real its ends and its default, of a tolerance
// (whose ends are below round-off, and none at all) its default.
inline std::vector<OptionValue> values_to_try(const OptionInfo& option) {
  std::vector<OptionValue> values;
  if (option.name == tolerance_option.name) return {option.fallback};
  switch (option.kind) {
    case OptionKind::integer:
      for (int i = int(option.least); i <= int(option.most); ++i) values.emplace_back(i);
      break;
    case OptionKind::real:
      for (const double x : {option.fallback, option.least, option.most}) values.emplace_back(x);
      break;
    case OptionKind::boolean:
    case OptionKind::boolean_or_choice:
      for (const bool x : {false, true}) values.emplace_back(x);
      break;
    case OptionKind::choice:
      break;
  }
  for (const std::string_view word : option.choices)
    if (!word.empty()) values.emplace_back(std::string(word));
  return values;
}

template <class Method>
std::vector<OptionValues> option_combinations(bool constrained) {
  std::vector<OptionValues> all{{}};
  for (const OptionInfo& option : Method::option_list) {
    if (option.scope != OptionScope::everywhere && !constrained) continue;
    std::vector<OptionValues> longer;
    for (const OptionValues& values : all)
      for (const OptionValue& value : values_to_try(option)) {
        longer.push_back(values);
        longer.back().set(option.name, value);
      }
    all = std::move(longer);
  }
  // What is there for the index-3 form alone is absent in another.
  std::vector<OptionValues> different;
  for (OptionValues values : all) {
    if (values.choice_or(form_option.name, "index3") != "index3")
      for (const OptionInfo& option : Method::option_list)
        if (option.scope == OptionScope::index3) values.erase(option.name);
    const auto same = [&](const OptionValues& other) { return other.all() == values.all(); };
    if (std::none_of(different.begin(), different.end(), same)) different.push_back(values);
  }
  return different;
}

inline std::string to_text(const OptionValue& value) {
  struct Text {
    std::string operator()(int x) const { return std::to_string(x); }
    std::string operator()(double x) const { return std::to_string(x); }
    std::string operator()(bool x) const { return x ? "true" : "false"; }
    std::string operator()(const std::string& x) const { return x; }
  };
  return std::visit(Text{}, value);
}

// One method with one combination of options, and what it declares with them.
template <MechanicalSystem S>
struct MethodCase {
  std::string_view method;
  OptionValues options;
  std::function<std::unique_ptr<AnyStepper<S>>(const S&)> stepper;
  ConvergenceOrders orders;
  bool symmetric;
  KeptConstraints kept;
  bool chooses_steps;

  std::string text() const {
    std::string s(method);
    for (const auto& [name, value] : options.all()) s += ", " + name + " = " + to_text(value);
    return s;
  }
};

// `stepper` makes the stepper of the method for a system.
template <class Method, MechanicalSystem S>
MethodCase<S> method_case(const OptionValues& values,
                          std::function<std::unique_ptr<AnyStepper<S>>(const S&)> stepper) {
  return {.method = Method::name,
          .options = values,
          .stepper = std::move(stepper),
          .orders = Method::orders(values),
          .symmetric = is_symmetric<Method>(values),
          .kept = kept_constraints<Method>(values),
          .chooses_steps = chooses_steps<Method>()};
}

template <class Method, MechanicalSystem S>
std::vector<MethodCase<S>> cases_of() {
  std::vector<MethodCase<S>> cases;
  if constexpr (may_fit<Method, S>())
    for (const OptionValues& values : option_combinations<Method>(S::constraints > 0))
      cases.push_back(method_case<Method, S>(values, [options = Method::options(values)](const S& system) {
        return make_stepper<Method, S>(options, system);
      }));
  return cases;
}

template <MechanicalSystem S, class... Methods>
std::vector<MethodCase<S>> cases_of_all(IntegratorList<Methods...>) {
  std::vector<MethodCase<S>> all;
  const auto append = [&](const std::vector<MethodCase<S>>& cases) {
    all.insert(all.end(), cases.begin(), cases.end());
  };
  (append(cases_of<Methods, S>()), ...);
  return all;
}

template <MechanicalSystem S>
std::vector<MethodCase<S>> every_method() {
  return cases_of_all<S>(Integrators{});
}

// Those that take the steps that they are told to.
template <MechanicalSystem S>
std::vector<MethodCase<S>> every_method_of_fixed_steps() {
  std::vector<MethodCase<S>> methods = every_method<S>();
  std::erase_if(methods, [](const MethodCase<S>& method) { return method.chooses_steps; });
  return methods;
}

}  // namespace liebench
