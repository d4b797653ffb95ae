#include "harness/record_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "harness/errors.h"
#include "harness/order_matrix.h"
#include "harness/strict_json.h"

namespace liebench {

namespace {

// Beyond, a legend of all curves is longer than anybody reads: it names the methods.
constexpr std::size_t most_named_curves = 42;
constexpr std::size_t most_panels = 12;

struct CurveLook {
  int style;
  bool secondary;
  int mark;
};

// A colour for what methods are apart from k, in the order in which they come; dashes when all colours are taken. A mark
// for each k. Where panels tell formulations and forms apart, colours need not.
class Looks {
 public:
  explicit Looks(bool panels) : panels_(panels) {}
  CurveLook operator()(const Curve& curve) {
    const int group = int(groups_.try_emplace(group_of(curve), groups_.size()).first->second);
    const Json& options = curve.identity.at("options");
    const int k = options.contains("k") ? options.at("k").get<int>() : 0;
    return {group % style_count, group / style_count % 2 == 1, k % style_count};
  }

 private:
  std::string group_of(const Curve& curve) const {
    Json identity = curve.identity;
    identity["options"].erase("k");
    if (panels_) {
      for (const char* key : {"form", "modified_start"}) identity["options"].erase(key);
      identity.erase("formulation");
    }
    return identity.dump();
  }

  bool panels_;
  std::map<std::string, std::size_t> groups_;
};

std::string panel_name(const Json& record) {
  const std::string form = record.at("options").value("form", "");
  const std::string formulation = record.at("formulation").get<std::string>();
  return form.empty() ? formulation : fmt::format("{}, {}", formulation, form);
}

// "bliedf2nd, correction = true": what a colour stands for.
std::string group_label(const Curve& curve) {
  std::string text = curve.identity.at("integrator").get<std::string>();
  for (const auto& option : curve.identity.at("options").items())
    if (option.key() != "k")
      text +=
          fmt::format(", {} = {}", option.key(),
                      option.value().is_string() ? option.value().get<std::string>() : option.value().dump());
  return text;
}

// The names of methods where they tell the curves apart, else the labels; of very many, what their colours stand for.
std::vector<std::string> labels_of(const std::vector<Curve>& list) {
  std::vector<std::string> names, labels;
  for (const Curve& curve : list) {
    names.push_back(list.size() > most_named_curves ? group_label(curve) : method_name(curve.identity));
    labels.push_back(curve.label);
  }
  const bool distinct = std::set<std::string>(names.begin(), names.end()).size() == names.size();
  return distinct || list.size() > most_named_curves ? names : labels;
}

Series series_of(const std::string& label, const CurveLook& look, std::size_t curves) {
  return {.label = plain_text(label),
          .style = look.style,
          .secondary = look.secondary,
          .mark = curves > most_named_curves ? look.style : look.mark};
}

// A number for each entry of the legend, in its order.
class Tags {
 public:
  std::string operator()(const Series& series) {
    const auto key = std::tuple(series.label, series.style, series.secondary, series.mark);
    return std::to_string(numbers_.try_emplace(key, numbers_.size() + 1).first->second);
  }
  std::size_t count() const { return numbers_.size(); }

 private:
  std::map<std::tuple<std::string, int, bool, int>, std::size_t> numbers_;
};

using Rows = std::vector<const Json*>;

// The records in panels, in the order of their first record.
std::vector<std::pair<std::string, Rows>> split(const std::vector<Json>& records, bool panels) {
  std::vector<std::pair<std::string, Rows>> parts;
  std::map<std::string, std::size_t> places;
  Rows all;
  for (const Json& record : records) {
    all.push_back(&record);
    if (!panels) continue;
    const auto [place, fresh] = places.try_emplace(panel_name(record), parts.size());
    if (fresh) parts.push_back({place->first, {}});
    parts[place->second].second.push_back(&record);
  }
  if (parts.size() > 1 && parts.size() <= most_panels) return parts;
  return {{"", std::move(all)}};
}

// Columns and rows of so many panels.
void arrange(Figure& figure) {
  const int count = int(figure.panels.size());
  figure.columns = count <= 3 ? std::max(count, 1) : count == 4 ? 2 : 3;
  figure.rows = (count + figure.columns - 1) / figure.columns;
}

}  // namespace

const std::vector<Abscissa>& abscissae() {
  static const std::vector<Abscissa> list{
      {"step_size", "step size h in s", "", "step_size", 1.0},
      {"time", "computing time of the run in s", "time", "total_ns", 1e-9},
      {"flops", "floating point operations of the run", "cost", "flops", 1.0},
      {"residuals", "residuals of the run", "cost", "residuals", 1.0},
      {"steps", "steps", "", "steps", 1.0},
      {"jacobians", "Newton matrices of the run", "cost", "jacobians", 1.0},
      {"factorizations", "factorizations of the run", "cost", "factorizations", 1.0},
      {"solves", "back-substitutions of the run", "cost", "solves", 1.0},
      {"newton_iterations", "Newton iterations of the run", "cost", "newton_iterations", 1.0},
      {"exp", "exponentials of the run", "cost", "exp", 1.0},
      {"log", "logarithms of the run", "cost", "log", 1.0},
      {"tangent", "tangent operators of the run", "cost", "tangent", 1.0},
      {"tangent_inverse", "inverse tangent operators of the run", "cost", "tangent_inverse", 1.0},
      {"commutators", "commutators of the run", "cost", "commutators", 1.0}};
  return list;
}

const Abscissa& abscissa(const std::string& name) {
  std::vector<std::string> names;
  for (const Abscissa& x : abscissae()) {
    if (x.name == name) return x;
    names.emplace_back(x.name);
  }
  throw InputError("--x", fmt::format("unknown abscissa \"{}\"; allowed: {}{}", name, quoted_list(names),
                                      suggestion(name, names)));
}

std::optional<double> value_of(const Json& record, const Abscissa& x) {
  const Json* section = &record;
  if (!x.section.empty()) {
    const auto found = record.find(x.section);
    if (found == record.end()) return std::nullopt;
    section = &*found;
  }
  const auto value = section->find(x.key);
  if (value == section->end() || !value->is_number() || !(value->get<double>() > 0.0)) return std::nullopt;
  return value->get<double>() * x.factor;
}

const Abscissa& dearest_abscissa(const std::vector<Json>& records) {
  Rows asked;
  for (const Json& record : records)
    if (record.at("outcome") == "ok" && record.at("precision") == "double") asked.push_back(&record);
  for (const char* name : {"time", "flops"}) {
    const Abscissa& x = abscissa(name);
    if (!asked.empty() && std::all_of(asked.begin(), asked.end(),
                                      [&](const Json* record) { return value_of(*record, x).has_value(); }))
      return x;
  }
  return abscissa("residuals");
}

std::string failures_text(const std::vector<Json>& records) {
  std::map<std::string, int> outcomes;
  for (const Json& record : records)
    if (record.at("outcome") != "ok") ++outcomes[record.at("outcome").get<std::string>()];
  std::string text;
  for (const auto& [outcome, count] : outcomes)
    text += fmt::format("{}{} {}", text.empty() ? "failed run: " : ", ", count, outcome);
  return text;
}

RecordFigure error_figure(const std::vector<Json>& records, const Abscissa& x, const Quantity& quantity,
                          bool panels) {
  RecordFigure result;
  Tags tags;
  const auto parts = split(records, panels);
  Looks looks(parts.size() > 1);
  for (const auto& [title, rows] : parts) {
    // A failed run has no error: whether it has one of lambda, those that ended well say.
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const Json* record) { return error_of(*record, quantity).has_value(); }))
      continue;
    Panel panel{.title = plain_text(title),
                .x_label = std::string(x.label),
                .y_label = plain_text(describe(quantity))};
    const std::vector<Curve> list = curves_of(rows);
    const std::vector<std::string> labels = labels_of(list);
    for (std::size_t i = 0; i < list.size(); ++i) {
      Series series = series_of(labels[i], looks(list[i]), list.size());
      std::size_t without_place = 0;
      bool ended_well = false, has_error = false;
      for (const Json* record : list[i].records) {
        const std::optional<double> value = value_of(*record, x);
        if (record->at("outcome") != "ok") {
          if (value)
            series.failures.push_back({*value, 0.0});
          else
            ++without_place;
          continue;
        }
        ended_well = true;
        const auto error = error_of(*record, quantity);
        if (!error) continue;
        has_error = true;
        if (value)
          series.points.push_back({*value, *error});
        else
          ++result.left_out;
      }
      if (ended_well && !has_error) continue;
      if (series.points.empty())
        result.left_out += without_place;
      else
        series.failures.insert(series.failures.end(), without_place, {series.points.front().x, 0.0});
      if (series.points.empty() && series.failures.empty()) continue;
      if (list.size() <= most_named_curves) series.tag = tags(series);
      panel.series.push_back(std::move(series));
    }
    if (!panel.series.empty()) result.figure.panels.push_back(std::move(panel));
  }
  if (tags.count() == 1)
    for (Panel& panel : result.figure.panels)
      for (Series& series : panel.series) series.tag.clear();
  result.figure.failures = plain_text(failures_text(records));
  arrange(result.figure);
  return result;
}

RecordFigure drift_figure(const std::vector<Json>& records) {
  const std::vector<std::pair<const char*, const char*>> invariants{
      {"energy", "drift of the energy in J"},
      {"angular_momentum", "drift of the angular momentum in kg m^2/s"},
      {"position_constraint", "position constraint in m"},
      {"velocity_constraint", "velocity constraint in m/s"},
      {"group", "distance from the group"}};
  RecordFigure result;
  const Abscissa& x = abscissa("step_size");
  const std::vector<Curve> list = curves(records);
  const std::vector<std::string> labels = labels_of(list);
  for (const auto& [key, label] : invariants) {
    Looks looks(false);
    Panel panel{.x_label = std::string(x.label), .y_label = label};
    bool applies = false;
    for (std::size_t i = 0; i < list.size(); ++i) {
      Series series = series_of(labels[i], looks(list[i]), list.size());
      bool ended_well = false;
      for (const Json* record : list[i].records) {
        const double h = record->at("step_size").get<double>();
        if (record->at("outcome") != "ok") {
          series.failures.push_back({h, 0.0});
          continue;
        }
        ended_well = true;
        const auto drift = record->find("drift");
        if (drift == record->end() || !drift->contains(key)) continue;
        series.points.push_back({h, drift->at(key).get<double>()});
        applies = true;
      }
      if (series.points.empty() && (ended_well || series.failures.empty())) continue;
      panel.series.push_back(std::move(series));
    }
    if (applies) result.figure.panels.push_back(std::move(panel));
  }
  result.figure.failures = plain_text(failures_text(records));
  arrange(result.figure);
  return result;
}

}  // namespace liebench
