#include "harness/record_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "harness/errors.h"
#include "harness/order_matrix.h"

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
    const Json& options = *curve.identity->options;
    const int k = options.contains("k") ? options.at("k").get<int>() : 0;
    return {group % style_count, group / style_count % 2 == 1, k % style_count};
  }

 private:
  std::string group_of(const Curve& curve) {
    const CurveIdentity& id = *curve.identity;
    Json options = *id.options;
    options.erase("k");
    if (panels_)
      for (const char* key : {"form", "modified_start"}) options.erase(key);
    const auto known = std::find(parameters_.begin(), parameters_.end(), id.parameters);
    const auto parameters = known - parameters_.begin();
    if (known == parameters_.end()) parameters_.push_back(id.parameters);
    return Json::array({id.problem, panels_ ? "" : id.formulation, parameters, id.integrator, options,
                        id.start, id.precision, id.t_0, id.length_key, id.length})
        .dump();
  }

  bool panels_;
  std::map<std::string, std::size_t> groups_;
  std::vector<SharedJson> parameters_;
};

std::string panel_name(const CurveIdentity& curve) {
  const std::string form = curve.form();
  return form.empty() ? curve.formulation : fmt::format("{}, {}", curve.formulation, form);
}

// "bliedf2nd, correction = true": what a colour stands for.
std::string group_label(const Curve& curve) {
  std::string text = curve.identity->integrator;
  for (const auto& option : curve.identity->options->items())
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
    names.push_back(list.size() > most_named_curves ? group_label(curve) : method_name(*curve.identity));
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

using Rows = std::vector<const RecordRow*>;

// The records in panels, in the order of their first record.
std::vector<std::pair<std::string, Rows>> split(const std::vector<RecordRow>& records, bool panels) {
  std::vector<std::pair<std::string, Rows>> parts;
  std::map<std::string, std::size_t> places;
  std::unordered_map<const CurveIdentity*, std::size_t> place_of;
  Rows all;
  for (const RecordRow& record : records) {
    all.push_back(&record);
    if (!panels) continue;
    const auto [known, fresh_curve] = place_of.try_emplace(record.curve.get(), 0);
    if (fresh_curve) {
      const auto [place, fresh] = places.try_emplace(panel_name(*record.curve), parts.size());
      if (fresh) parts.push_back({place->first, {}});
      known->second = place->second;
    }
    parts[known->second].second.push_back(&record);
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
      {"step_size", "step size h in s", record_number("step_size"), 1.0},
      {"time", "computing time of the run in s", record_number("time/total_ns"), 1e-9},
      {"flops", "floating point operations of the run", record_number("cost/flops"), 1.0},
      {"residuals", "residuals of the run", record_number("cost/residuals"), 1.0},
      {"steps", "steps", record_number("steps"), 1.0},
      {"jacobians", "Newton matrices of the run", record_number("cost/jacobians"), 1.0},
      {"factorizations", "factorizations of the run", record_number("cost/factorizations"), 1.0},
      {"solves", "back-substitutions of the run", record_number("cost/solves"), 1.0},
      {"newton_iterations", "Newton iterations of the run", record_number("cost/newton_iterations"), 1.0},
      {"exp", "exponentials of the run", record_number("cost/exp"), 1.0},
      {"log", "logarithms of the run", record_number("cost/log"), 1.0},
      {"tangent", "tangent operators of the run", record_number("cost/tangent"), 1.0},
      {"tangent_inverse", "inverse tangent operators of the run", record_number("cost/tangent_inverse"), 1.0},
      {"commutators", "commutators of the run", record_number("cost/commutators"), 1.0}};
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

std::optional<double> value_of(const RecordRow& record, const Abscissa& x) {
  const std::optional<double> value = record[x.number];
  if (!value || !(*value > 0.0)) return std::nullopt;
  return *value * x.factor;
}

const Abscissa& dearest_abscissa(const std::vector<RecordRow>& records) {
  Rows asked;
  for (const RecordRow& record : records)
    if (record.ended_well() && record.curve->precision == "double") asked.push_back(&record);
  for (const char* name : {"time", "flops"}) {
    const Abscissa& x = abscissa(name);
    if (!asked.empty() && std::all_of(asked.begin(), asked.end(), [&](const RecordRow* record) {
          return value_of(*record, x).has_value();
        }))
      return x;
  }
  return abscissa("residuals");
}

std::string failures_text(const std::vector<RecordRow>& records) {
  std::map<std::string, int> outcomes;
  for (const RecordRow& record : records)
    if (!record.ended_well()) ++outcomes[record.outcome];
  std::string text;
  for (const auto& [outcome, count] : outcomes)
    text += fmt::format("{}{} {}", text.empty() ? "failed run: " : ", ", count, outcome);
  return text;
}

RecordFigure error_figure(const std::vector<RecordRow>& records, const Abscissa& x, const Quantity& quantity,
                          bool panels) {
  RecordFigure result;
  Tags tags;
  const auto parts = split(records, panels);
  Looks looks(parts.size() > 1);
  for (const auto& [title, rows] : parts) {
    // A failed run has no error: whether it has one of lambda, those that ended well say.
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const RecordRow* record) { return error_of(*record, quantity).has_value(); }))
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
      for (const RecordRow* record : list[i].records) {
        const std::optional<double> value = value_of(*record, x);
        if (!record->ended_well()) {
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

RecordFigure drift_figure(const std::vector<RecordRow>& records) {
  const std::vector<std::pair<RecordNumber, const char*>> invariants{
      {record_number("drift/energy"), "drift of the energy in J"},
      {record_number("drift/angular_momentum"), "drift of the angular momentum in kg m^2/s"},
      {record_number("drift/position_constraint"), "position constraint in m"},
      {record_number("drift/velocity_constraint"), "velocity constraint in m/s"},
      {record_number("drift/group"), "distance from the group"}};
  RecordFigure result;
  const Abscissa& x = abscissa("step_size");
  const std::vector<Curve> list = curves(records);
  const std::vector<std::string> labels = labels_of(list);
  Looks looks(false);
  std::vector<CurveLook> looks_of_curves;
  for (const Curve& curve : list) looks_of_curves.push_back(looks(curve));
  for (const auto& [number, label] : invariants) {
    Panel panel{.x_label = std::string(x.label), .y_label = label};
    bool applies = false;
    for (std::size_t i = 0; i < list.size(); ++i) {
      Series series = series_of(labels[i], looks_of_curves[i], list.size());
      bool ended_well = false;
      for (const RecordRow* record : list[i].records) {
        const double h = record->step_size();
        if (!record->ended_well()) {
          series.failures.push_back({h, 0.0});
          continue;
        }
        ended_well = true;
        const std::optional<double> drift = (*record)[number];
        if (!drift) continue;
        series.points.push_back({h, *drift});
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
