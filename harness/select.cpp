#include "harness/select.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

namespace liebench {

namespace {

constexpr std::array identity_keys{"problem", "formulation", "parameters", "integrator",
                                   "options", "start",       "precision",  "t_0"};

// Runs over a fixed number of steps end elsewhere for every step size.
const char* length_key(const Json& record) {
  return record.contains("local_steps") ? "local_steps" : "t_end";
}

std::size_t mixed(std::size_t seed, std::size_t value) {
  return seed ^ (value + 0x9e3779b97f4a7c15U + (seed << 6U) + (seed >> 2U));
}

// Equal values have equal hashes, 1 and 1.0 as well; nothing is copied or printed.
std::size_t hash_of(const Json& value) {
  std::size_t seed = 0;
  if (value.is_object()) {
    for (const auto& item : value.items())
      seed = mixed(mixed(seed, std::hash<std::string>{}(item.key())), hash_of(item.value()));
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

template <class Visit>
void for_identity(const Json& record, const Visit& visit) {
  for (const char* key : identity_keys)
    if (const auto found = record.find(key); found != record.end()) visit(key, *found);
  const char* length = length_key(record);
  if (const auto found = record.find(length); found != record.end()) visit(length, *found);
}

std::size_t identity_hash(const Json& record) {
  std::size_t seed = 0;
  for_identity(record, [&](const char* key, const Json& value) {
    seed = mixed(mixed(seed, std::hash<std::string_view>{}(key)), hash_of(value));
  });
  return seed;
}

bool has_identity(const Json& record, const Json& identity) {
  std::size_t count = 0;
  bool same = true;
  for_identity(record, [&](const char* key, const Json& value) {
    ++count;
    if (!same) return;
    const auto found = identity.find(key);
    same = found != identity.end() && *found == value;
  });
  return same && count == identity.size();
}

// Leaves of the identity as "name" -> text, so that labels can leave out what all curves share.
void flatten(const std::string& name, const Json& value,
             std::vector<std::pair<std::string, std::string>>& leaves) {
  if (value.is_object()) {
    for (const auto& item : value.items()) flatten(item.key(), item.value(), leaves);
    return;
  }
  leaves.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
}

bool speaks_for_itself(const std::string& name) {
  return name == "problem" || name == "formulation" || name == "integrator" || name == "precision";
}

using Leaves = std::vector<std::pair<std::string, std::string>>;

// The label of a curve from those of its leaves that `shown` chooses.
template <class Shown>
std::string label_of(const Curve& curve, const Leaves& leaves, const Shown& shown) {
  std::string text;
  for (const auto& [name, value] : leaves) {
    if (!shown(name)) continue;
    if (!text.empty()) text += ", ";
    text += speaks_for_itself(name) ? value : name + " = " + value;
  }
  return text.empty() ? curve.identity.at("integrator").get<std::string>() : text;
}

// What has several values among the curves; and, where that does not tell them all apart, what some of them have and others
// have not.
void label(std::vector<Curve>& curves) {
  std::map<std::string, std::set<std::string>> values;
  std::map<std::string, std::size_t> holders;
  std::vector<Leaves> leaves(curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    flatten("", curves[i].identity, leaves[i]);
    for (const auto& [name, text] : leaves[i]) values[name].insert(text);
    for (const auto& leaf : leaves[i]) ++holders[leaf.first];
  }
  const auto differs = [&](const std::string& name) { return values[name].size() > 1; };
  std::set<std::string> labels;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].label = label_of(curves[i], leaves[i], differs);
    labels.insert(curves[i].label);
  }
  if (labels.size() == curves.size()) return;
  for (std::size_t i = 0; i < curves.size(); ++i)
    curves[i].label = label_of(curves[i], leaves[i], [&](const std::string& name) {
      return differs(name) || holders[name] < curves.size();
    });
}

}  // namespace

Json identity_of(const Json& record) {
  Json identity;
  for_identity(record, [&](const char* key, const Json& value) { identity[key] = value; });
  return identity;
}

std::string describe(const Quantity& quantity) {
  const std::string unit = quantity.component == "lambda" ? " in N" : "";
  if (quantity.norm == "end_relative") return "relative error of " + quantity.component + " at the end";
  if (quantity.norm == "end_absolute") return "error of " + quantity.component + " at the end" + unit;
  return "maximum error of " + quantity.component + unit;
}

std::optional<double> error_of(const Json& record, const Quantity& quantity) {
  const auto errors = record.find("errors");
  if (errors == record.end()) return std::nullopt;
  const auto component = errors->find(quantity.component);
  if (component == errors->end()) return std::nullopt;
  const auto value = component->find(quantity.norm);
  if (value == component->end() || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

std::vector<Curve> curves(const std::vector<Json>& records) {
  std::vector<const Json*> pointers;
  for (const Json& record : records) pointers.push_back(&record);
  return curves_of(pointers);
}

std::vector<Curve> curves_of(const std::vector<const Json*>& records) {
  std::vector<Curve> list;
  std::unordered_map<std::size_t, std::vector<std::size_t>> index;  // more than one where hashes collide
  for (const Json* each : records) {
    const Json& record = *each;
    std::vector<std::size_t>& places = index[identity_hash(record)];
    auto place = std::find_if(places.begin(), places.end(),
                              [&](std::size_t i) { return has_identity(record, list[i].identity); });
    if (place == places.end()) {
      place = places.insert(places.end(), list.size());
      list.push_back({.label = "", .identity = identity_of(record), .records = {}});
    }
    list[*place].records.push_back(&record);
  }
  for (Curve& curve : list)
    std::stable_sort(curve.records.begin(), curve.records.end(), [](const Json* a, const Json* b) {
      return a->at("step_size").get<double>() > b->at("step_size").get<double>();
    });
  label(list);
  return list;
}

OrderFit fit_curve(const Curve& curve, const Quantity& quantity) {
  std::vector<ErrorPoint> points;
  double reference_error = 0.0;
  for (const Json* record : curve.records) {
    const std::optional<double> error = error_of(*record, quantity);
    if (!error) continue;
    points.push_back({record->at("step_size").get<double>(), *error});
    reference_error = std::max(reference_error, record->at("reference").at("error_estimate").get<double>());
  }
  return fit_order(points, reference_error);
}

}  // namespace liebench
