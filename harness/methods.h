#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/strict_json.h"
#include "integrators/fits.h"
#include "integrators/option.h"

// The integrators of integrators/list.h and the solvers from outside (harness/outside/), seen from the harness: names
// and options, and options from and to JSON.

namespace liebench {

struct OutsideMethod;

struct MethodInfo {
  std::string_view name;
  std::string_view summary;
  Fits fits;
  bool chooses_steps;  // it has the option `tolerance`, and no step size
  std::span<const OptionInfo> options;
  std::string (*title)(const OptionValues&);  // "BLieDF2nd, k = 3"
  ConvergenceOrders (*orders)(const OptionValues&);
  // Of a method of the list; integrators/fits.h.
  bool (*symmetric)(const OptionValues&) = nullptr;
  KeptConstraints (*kept)(const OptionValues&) = nullptr;
  const OutsideMethod* outside = nullptr;  // of a solver from outside
};

const std::vector<MethodInfo>& methods();
// Null where no method has this name.
const MethodInfo* find_method(std::string_view name);

bool has_option(const MethodInfo& method, std::string_view option);

// Why a method does not integrate a problem with or without constraints in this formulation, and which do; empty where
// it does. Of scenes the formulation is "scene". Solvers from outside run in studies alone: elsewhere, where the problem has no name,
// none of them fits.
std::string misfit(const MethodInfo& method, std::string_view problem, bool constrained,
                   std::string_view formulation);
// Names of the methods that choose their steps, as a message lists them.
std::string methods_that_choose_steps(bool with_outside);
// What it integrates: "problems without constraints".
std::string fits_text(const MethodInfo& method);

// Why it can't run in this program, whatever the problem: a sentence, empty where it can.
std::string_view obstacle_to(const MethodInfo& method);

// The checked value of one option. Throws InputError.
OptionValue option_value(const OptionInfo& info, const JsonView& view);
OptionValue option_default(const OptionInfo& info, bool self_start = false);

// Whether an option means something: for a problem without constraints, for the form among `values`.
bool applies(const OptionInfo& info, bool constrained, const OptionValues& values);

// Whether the option is one that is left out where it has its default.
bool goes_without_saying(const OptionInfo& info, const OptionValues& values);

// What a problem or an option must be for this one to mean something: `"form": "index3" and constraints`.
std::string scope_text(const OptionInfo& info);

// What an option takes: `an integer from 1 to 4`, `true or false`.
std::string allowed_values(const OptionInfo& info);

// All options that are there, in the order of the method's list; and back from a record.
Json options_to_json(const MethodInfo& method, const OptionValues& values);
OptionValues options_from_json(const MethodInfo& method, const Json& json);

}  // namespace liebench
