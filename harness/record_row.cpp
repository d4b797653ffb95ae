#include "harness/record_row.h"

#include <functional>
#include <utility>

namespace liebench {

namespace {

std::size_t mixed(std::size_t seed, std::size_t value) {
  return seed ^ (value + 0x9e3779b97f4a7c15U + (seed << 6U) + (seed >> 2U));
}

// Nothing is copied or printed.
std::size_t hash_of(const Json& value) {
  std::size_t seed = 0;
  if (value.is_object()) {
    for (const auto& [key, member] : value.get_ref<const Json::object_t&>())
      seed = mixed(mixed(seed, std::hash<std::string>{}(key)), hash_of(member));
  } else if (value.is_array()) {
    for (const Json& element : value) seed = mixed(seed, hash_of(element));
  } else if (value.is_number()) {
    seed = std::hash<double>{}(value.get<double>());
  } else if (value.is_string()) {
    seed = std::hash<std::string>{}(value.get_ref<const std::string&>());
  } else if (value.is_boolean()) {
    seed = value.get<bool>() ? 1 : 2;
  }
  return mixed(seed, value.is_number() ? 0 : std::size_t(value.type()));
}

}  // namespace

SharedJson::SharedJson(Json value)
    : value_(std::make_shared<const Json>(std::move(value))), hash_(hash_of(*value_)) {}

bool CurveIdentity::has_option(const char* name, const Json& value) const {
  const auto option = options->find(name);
  return option != options->end() && *option == value;
}

CurveIdentity identity_of(const Json& record) {
  return identity_of(record, SharedJson(record.at("parameters")), SharedJson(record.at("options")));
}

CurveIdentity identity_of(const Json& record, SharedJson parameters, SharedJson options) {
  const auto text = [&](const char* key) { return record.at(key).get<std::string>(); };
  if (options->contains("tolerance")) {
    Json others = *options;
    others.erase("tolerance");
    options = SharedJson(std::move(others));
  }
  // Runs over a fixed number of steps end elsewhere for every step size.
  const char* length_key = record.contains("local_steps") ? "local_steps" : "t_end";
  return {.problem = text("problem"),
          .formulation = text("formulation"),
          .parameters = std::move(parameters),
          .integrator = text("integrator"),
          .options = std::move(options),
          .start = text("start"),
          .precision = text("precision"),
          .t_0 = record.at("t_0"),
          .length_key = length_key,
          .length = record.at(length_key)};
}

std::size_t CurveIdentity::hash() const {
  std::size_t seed = mixed(parameters.hash(), options.hash());
  for (const std::string* text : {&problem, &formulation, &integrator, &start, &precision, &length_key})
    seed = mixed(seed, std::hash<std::string>{}(*text));
  return mixed(mixed(seed, hash_of(t_0)), hash_of(length));
}

}  // namespace liebench
