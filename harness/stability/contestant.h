#pragma once

#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/methods.h"
#include "integrators/option.h"

namespace liebench {

// A method with its options as the stability suite runs it: a row of its picture.
struct Contestant {
  const MethodInfo* method = nullptr;
  OptionValues options;    // complete but for the form, and what depends on it
  std::string name;        // as in all tables, method_name(); with the tolerance, which is no part of that
  bool safeguard = false;  // the option of the kernel

  // A generalized-alpha method has one step.
  int steps() const;
  // Of convergence.
  int order() const;
  // Of convergence of the multipliers in a form.
  int order_of_multipliers(std::string_view form) const;
  bool is(std::string_view integrator) const { return method->name == integrator; }
  // "explicit", "implicit" or "" where no correction term is computed.
  std::string_view correction() const;
  // Whether the method has the option `safeguard`. (bliedf2nd_variable needs none: it always goes on damped where the plain iteration
  // fails.)
  bool can_be_safeguarded() const;
  // Of a method without the option "form": that whose constraints its steps fulfil. SHAKELie has Phi = 0 alone, RATTLie the hidden
  // constraint too, half-explicit methods that one alone: what they declare.
  std::string_view own_form() const;
  // rho_inf of generalized-alpha.
  std::optional<double> rho_inf() const;
  // Of one that chooses its steps; empty of another.
  std::optional<double> tolerance() const;
  bool chooses_steps() const { return method->chooses_steps; }
  // All options for a form; "" for a system without constraints. `modified_start`: where it means something.
  OptionValues options_for(std::string_view form, bool modified_start = true) const;
};

// Every method of the list with the options that set its members apart.
const std::vector<Contestant>& contestants(bool safeguard);
// One that the suite wants beside them.
Contestant contestant(std::string_view integrator,
                      const std::vector<std::pair<std::string, OptionValue>>& options);

}  // namespace liebench
