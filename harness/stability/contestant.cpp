#include "harness/stability/contestant.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "integrators/form.h"
#include "integrators/step_control.h"

namespace liebench {

int Contestant::steps() const {
  return options.has("k") ? options.integer("k") : 1;
}

int Contestant::order() const {
  return method->orders(options).q;
}

int Contestant::order_of_multipliers(std::string_view form) const {
  return method->orders(options_for(form)).lambda;
}

std::string_view Contestant::correction() const {
  if (!options.has("correction") || steps() < 3) return "";
  if (options.is_choice("correction")) return "implicit";
  return options.boolean("correction") ? "explicit" : "";
}

std::optional<double> Contestant::rho_inf() const {
  if (!options.has("rho_inf")) return std::nullopt;
  return options.real("rho_inf");
}

std::optional<double> Contestant::tolerance() const {
  if (!options.has(tolerance_option.name)) return std::nullopt;
  return options.real(tolerance_option.name);
}

std::string_view Contestant::own_form() const {
  return method->kept(options).velocity ? "stabilized_index2" : "index3";
}

bool Contestant::can_be_safeguarded() const {
  return has_option(*method, safeguard_option.name);
}

OptionValues Contestant::options_for(std::string_view form, bool modified_start) const {
  OptionValues values = options;
  values.set("form", std::string(form.empty() ? "index3" : form));
  values.set("modified_start", modified_start);
  values.set("safeguard", safeguard);
  for (const std::string_view key : {form_option.name, modified_start_option.name, safeguard_option.name})
    if (!has_option(*method, key)) values.erase(key);
  for (const OptionInfo& info : method->options)
    if (!applies(info, !form.empty(), values) || goes_without_saying(info, values)) values.erase(info.name);
  return values;
}

Contestant contestant(std::string_view integrator,
                      const std::vector<std::pair<std::string, OptionValue>>& options) {
  const MethodInfo* method = find_method(integrator);
  if (method == nullptr) throw std::logic_error("no integrator " + std::string(integrator));
  Contestant result;
  result.method = method;
  for (const OptionInfo& info : method->options)
    if (info.scope == OptionScope::everywhere) result.options.set(info.name, option_default(info));
  for (const auto& [key, value] : options) result.options.set(key, value);
  result.name = method->title(result.options);
  if (const auto tolerance = result.tolerance()) result.name += fmt::format(", tolerance {:.0e}", *tolerance);
  return result;
}

const std::vector<Contestant>& contestants(bool safeguard) {
  const auto list = [](bool safeguarded) {
    std::vector<Contestant> all;
    for (const int k : {1, 2, 3, 4, 5, 6}) all.push_back(contestant("bliedf2nd", {{"k", k}}));
    all.push_back(contestant("bliedf2nd", {{"k", 3}, {"correction", false}}));
    for (const int k : {4, 5, 6})
      all.push_back(contestant("bliedf2nd", {{"k", k}, {"correction", std::string("implicit")}}));
    for (const double tolerance : {1e-4, 1e-8})
      all.push_back(contestant("bliedf2nd_variable", {{"tolerance", tolerance}}));
    for (const double rho : {1.0, 0.9, 0.5, 0.0})
      all.push_back(contestant("generalized_alpha", {{"rho_inf", rho}}));
    for (const int k : {2, 3, 4})
      all.push_back(contestant("faltinsen_bdf", {{"k", k}, {"variant", std::string("exact")}}));
    for (const int k : {3, 4})
      all.push_back(contestant("faltinsen_bdf", {{"k", k}, {"variant", std::string("bch")}}));
    for (const int k : {2, 4, 6}) all.push_back(contestant("centred_bdf", {{"k", k}}));
    for (const char* name : {"rattlie", "shakelie", "radau"}) all.push_back(contestant(name, {}));
    for (const char* tableau : {"herk3", "herk4", "hedop5"})
      all.push_back(contestant("half_explicit", {{"tableau", std::string(tableau)}}));
    for (const int stages : {2, 4}) all.push_back(contestant("gauss", {{"stages", stages}}));
    for (const char* name : {"implicit_midpoint", "newmark", "liemid"}) all.push_back(contestant(name, {}));
    for (const int k : {2, 4, 6}) all.push_back(contestant("faltinsen_adams", {{"k", k}}));
    for (const char* tableau : {"rk4", "dopri5", "butcher6"})
      all.push_back(contestant("rkmk", {{"tableau", std::string(tableau)}}));
    for (const double tolerance : {1e-4, 1e-8})
      all.push_back(contestant("rkmk_variable", {{"tolerance", tolerance}}));
    all.push_back(contestant("commutator_free", {}));
    all.push_back(contestant("crouch_grossman", {}));
    for (Contestant& each : all) each.safeguard = safeguarded;
    return all;
  };
  static const std::vector<Contestant> plain = list(false), safeguarded = list(true);
  return safeguard ? safeguarded : plain;
}

}  // namespace liebench
