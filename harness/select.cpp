#include "harness/select.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>
#include <unordered_map>

namespace liebench {

namespace {

// A part of an identity that a label can name: the name, and the value as text or as JSON.
struct Leaf {
  std::string_view name;
  const std::string* text = nullptr;
  const Json* value = nullptr;

  std::string shown() const {
    if (text != nullptr) return *text;
    return value->is_string() ? value->get<std::string>() : value->dump();
  }
};
using Leaves = std::vector<Leaf>;

void add_leaves(std::string_view name, const Json& value, Leaves& leaves) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.get_ref<const Json::object_t&>()) add_leaves(key, member, leaves);
    return;
  }
  leaves.push_back({.name = name, .value = &value});
}

Leaves leaves_of(const CurveIdentity& identity) {
  Leaves leaves{{.name = "problem", .text = &identity.problem},
                {.name = "formulation", .text = &identity.formulation}};
  add_leaves("parameters", *identity.parameters, leaves);
  leaves.push_back({.name = "integrator", .text = &identity.integrator});
  add_leaves("options", *identity.options, leaves);
  leaves.push_back({.name = "start", .text = &identity.start});
  leaves.push_back({.name = "precision", .text = &identity.precision});
  add_leaves("t_0", identity.t_0, leaves);
  add_leaves(identity.length_key, identity.length, leaves);
  return leaves;
}

// Whether two values have the same text for certain: 1 and 1.0 are equal and have not.
bool same_text(const Json& a, const Json& b) {
  if (a.type() != b.type()) return false;
  if (a.is_number_float()) {
    const double x = a.get<double>(), y = b.get<double>();
    return std::memcmp(&x, &y, sizeof x) == 0;
  }
  if (!a.is_array()) return a == b;
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_text);
}

bool same_text(const Leaf& a, const Leaf& b) {
  if (a.text != nullptr && b.text != nullptr) return *a.text == *b.text;
  return a.value != nullptr && b.value != nullptr && (a.value == b.value || same_text(*a.value, *b.value));
}

bool speaks_for_itself(std::string_view name) {
  return name == "problem" || name == "formulation" || name == "integrator" || name == "precision";
}

// The label of a curve from those of its leaves that `named` has.
std::string label_of(const Curve& curve, const Leaves& leaves, const std::set<std::string_view>& named) {
  std::string text;
  for (const Leaf& leaf : leaves) {
    if (!named.contains(leaf.name)) continue;
    if (!text.empty()) text += ", ";
    if (!speaks_for_itself(leaf.name)) {
      text += leaf.name;
      text += " = ";
    }
    text += leaf.shown();
  }
  return text.empty() ? curve.identity->integrator : text;
}

// What has several values among the curves; and, where that does not tell them all apart, what some of them have and others
// have not.
void label(std::vector<Curve>& curves) {
  struct Seen {
    const Leaf* first;
    std::size_t holders = 0;
    bool differs = false;
  };
  std::vector<Leaves> leaves(curves.size());
  std::map<std::string_view, Seen> seen;
  // Of the curve before: most have the same leaves in the same order.
  std::vector<Seen*> places;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    leaves[i] = leaves_of(*curves[i].identity);
    places.resize(std::max(places.size(), leaves[i].size()), nullptr);
    for (std::size_t j = 0; j < leaves[i].size(); ++j) {
      const Leaf& leaf = leaves[i][j];
      if (places[j] == nullptr || places[j]->first->name != leaf.name)
        places[j] = &seen.try_emplace(leaf.name, Seen{&leaf}).first->second;
      Seen& name = *places[j];
      ++name.holders;
      if (!name.differs && !same_text(*name.first, leaf)) name.differs = name.first->shown() != leaf.shown();
    }
  }
  // The hash of a scene's content tells those apart only whose names do not.
  constexpr std::string_view hash = "content";
  std::set<std::string_view> named;
  for (const auto& [name, what] : seen)
    if (what.differs && name != hash) named.insert(name);
  std::set<std::string_view> labels;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].label = label_of(curves[i], leaves[i], named);
    labels.insert(curves[i].label);
  }
  if (labels.size() == curves.size()) return;
  for (const auto& [name, what] : seen)
    if (what.holders < curves.size() || (what.differs && name == hash)) named.insert(name);
  for (std::size_t i = 0; i < curves.size(); ++i) curves[i].label = label_of(curves[i], leaves[i], named);
}

}  // namespace

std::string describe(const Quantity& quantity) {
  const std::string unit = quantity.component == "lambda" ? " in N" : "";
  if (quantity.norm == "end_relative") return "relative error of " + quantity.component + " at the end";
  if (quantity.norm == "end_absolute") return "error of " + quantity.component + " at the end" + unit;
  return "maximum error of " + quantity.component + unit;
}

std::optional<double> error_of(const RecordRow& record, const Quantity& quantity) {
  constexpr std::array<std::string_view, 3> components{"q", "v", "lambda"};
  constexpr std::array<std::string_view, 3> norms{"end_relative", "end_absolute", "max_absolute"};
  constexpr std::array<std::array<RecordNumber, 3>, 3> numbers{{
      {record_number("errors/q/end_relative"), record_number("errors/q/end_absolute"),
       record_number("errors/q/max_absolute")},
      {record_number("errors/v/end_relative"), record_number("errors/v/end_absolute"),
       record_number("errors/v/max_absolute")},
      {record_number("errors/lambda/end_relative"), record_number("errors/lambda/end_absolute"),
       record_number("errors/lambda/max_absolute")},
  }};
  const auto component = std::find(components.begin(), components.end(), quantity.component);
  const auto norm = std::find(norms.begin(), norms.end(), quantity.norm);
  if (component == components.end() || norm == norms.end()) return std::nullopt;
  return record[numbers[std::size_t(component - components.begin())][std::size_t(norm - norms.begin())]];
}

std::vector<Curve> curves(const std::vector<RecordRow>& records) {
  std::vector<const RecordRow*> pointers;
  pointers.reserve(records.size());
  for (const RecordRow& record : records) pointers.push_back(&record);
  return curves_of(pointers);
}

std::vector<Curve> curves_of(const std::vector<const RecordRow*>& records) {
  std::vector<Curve> list;
  std::unordered_map<const CurveIdentity*, std::size_t> place_of;
  // Identities that were read apart may be equal all the same; more than one place where hashes collide.
  std::unordered_map<std::size_t, std::vector<std::size_t>> places_of_hash;
  for (const RecordRow* record : records) {
    const auto [known, fresh] = place_of.try_emplace(record->curve.get(), list.size());
    if (fresh) {
      std::vector<std::size_t>& places = places_of_hash[record->curve->hash()];
      const auto same = std::find_if(places.begin(), places.end(),
                                     [&](std::size_t i) { return *list[i].identity == *record->curve; });
      if (same != places.end()) {
        known->second = *same;
      } else {
        places.push_back(list.size());
        list.push_back({.identity = record->curve});
      }
    }
    list[known->second].records.push_back(record);
  }
  const auto coarser = [](const RecordRow* a, const RecordRow* b) { return a->step_size() > b->step_size(); };
  for (Curve& curve : list)
    if (!std::is_sorted(curve.records.begin(), curve.records.end(), coarser))
      std::stable_sort(curve.records.begin(), curve.records.end(), coarser);
  label(list);
  return list;
}

OrderFit fit_curve(const Curve& curve, const Quantity& quantity) {
  std::vector<ErrorPoint> points;
  double reference_error = 0.0;
  for (const RecordRow* record : curve.records) {
    const std::optional<double> error = error_of(*record, quantity);
    if (!error) continue;
    points.push_back({record->step_size(), *error});
    reference_error =
        std::max(reference_error, record->numbers[std::size_t(record_number("reference/error_estimate"))]);
  }
  return fit_order(points, reference_error);
}

}  // namespace liebench
