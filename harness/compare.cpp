#include "harness/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "harness/median.h"
#include "harness/rank_test.h"
#include "harness/select.h"

namespace liebench {

namespace {

std::string row_name(const RecordRow& record) {
  const CurveIdentity& curve = *record.curve;
  std::string options;
  for (const auto& option : curve.options->items())
    options +=
        fmt::format(" {}={}", option.key(),
                    option.value().is_string() ? option.value().get<std::string>() : option.value().dump());
  const auto tolerance = record[record_number("options/tolerance")];
  return fmt::format("{} {} {}{} {}={:.4g}", curve.problem, curve.formulation, curve.integrator, options,
                     tolerance ? "tolerance" : "h", tolerance.value_or(record.step_size()));
}

// What was run: rows of other keys belong together by it.
struct WhatRan {
  const RecordRow* row;
  // What sets it apart from others of its curve: the tolerance, where the method chooses its steps, which may be others then.
  double place() const { return (*row)[record_number("options/tolerance")].value_or(row->step_size()); }
  bool operator==(const WhatRan& other) const {
    const auto tolerance = record_number("options/tolerance");
    return place() == other.place() && (*row)[tolerance] == (*other.row)[tolerance] &&
           ((*row)[tolerance] || row->steps() == other.row->steps()) && *row->curve == *other.row->curve;
  }
};
struct HashOfWhatRan {
  std::size_t operator()(const WhatRan& run) const {
    return run.row->curve->hash() ^ std::hash<double>{}(run.place());
  }
};

// The index of the old row in the new ones, or npos; each new row is taken once.
constexpr std::size_t npos = std::size_t(-1);
std::vector<std::size_t> partners(const std::vector<RecordRow>& before, const std::vector<RecordRow>& after) {
  std::unordered_map<std::string_view, std::size_t> by_key;
  for (std::size_t i = 0; i < after.size(); ++i) by_key.emplace(after[i].key, i);
  std::vector<std::size_t> partner(before.size(), npos);
  std::vector<bool> taken(after.size(), false);
  for (std::size_t i = 0; i < before.size(); ++i)
    if (const auto found = by_key.find(before[i].key); found != by_key.end() && !taken[found->second]) {
      partner[i] = found->second;
      taken[found->second] = true;
    }
  std::unordered_map<WhatRan, std::size_t, HashOfWhatRan> by_run;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (!taken[i]) by_run.emplace(WhatRan{&after[i]}, i);
  if (by_run.empty()) return partner;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (partner[i] != npos) continue;
    const auto found = by_run.find(WhatRan{&before[i]});
    if (found == by_run.end() || taken[found->second]) continue;
    partner[i] = found->second;
    taken[found->second] = true;
  }
  return partner;
}

void compare_counts(const RecordRow& before, const RecordRow& after, std::vector<std::string>& changes) {
  constexpr std::string_view section = "cost/";
  for (std::size_t i = 0; i < number_paths.size(); ++i) {
    if (!number_paths[i].starts_with(section)) continue;
    const auto a = before[RecordNumber(i)], b = after[RecordNumber(i)];
    if (!a || a == b) continue;
    std::string name(number_paths[i].substr(section.size()));
    std::replace(name.begin(), name.end(), '/', '.');
    changes.push_back(fmt::format("{} {:.0f} -> {}", name, *a, b ? fmt::format("{:.0f}", *b) : "absent"));
  }
}

// The unit round-off: of double-double arithmetic in extended precision.
double round_off(const RecordRow& record) {
  const double eps = std::numeric_limits<double>::epsilon() / 2;
  return record.curve->precision == "extended" ? eps * eps : eps;
}

void compare_errors(const RecordRow& before, const RecordRow& after, double band,
                    std::vector<std::string>& changes) {
  const double relative_band = 1e-6;
  for (const char* component : {"q", "v", "lambda"}) {
    const auto relative = error_of(before, {component, "end_relative"});
    const auto absolute = error_of(before, {component, "end_absolute"});
    const double solution =
        relative && absolute && *relative > 0 ? std::max(1.0, *absolute / *relative) : 1.0;
    for (const char* norm : {"end_relative", "end_absolute", "max_absolute"}) {
      const Quantity quantity{component, norm};
      const auto a = error_of(before, quantity), b = error_of(after, quantity);
      if (!a && !b) continue;
      if (a.has_value() != b.has_value()) {
        changes.push_back(fmt::format("{} {} is {} now", component, norm, a ? "absent" : "present"));
        continue;
      }
      const double size = quantity.norm == "end_relative" ? 1.0 : solution;
      const double allowed =
          relative_band * std::max(*a, *b) + band * round_off(before) * before.steps() * size;
      // Not "greater than": a NaN differs, too.
      if (!(std::abs(*a - *b) <= allowed))
        changes.push_back(
            fmt::format("{} {} {:.4e} -> {:.4e}, allowed {:.1e}", component, norm, *a, *b, allowed));
    }
  }
}

void compare_times(const RecordRow& before, const RecordRow& after, const std::string& name,
                   std::vector<std::string>& changes) {
  const std::vector<double>&a = before.time_samples, &b = after.time_samples;
  if (a.empty() || b.empty()) return;
  const double old_median = median(a), new_median = median(b);
  const double probability = rank_test(a, b);
  if (probability < 0.01 && std::abs(new_median - old_median) > 0.1 * old_median)
    changes.push_back(fmt::format("{}: {:.4g} -> {:.4g} ns a step, {:+.0f} %, p = {:.1e}", name, old_median,
                                  new_median, 100 * (new_median / old_median - 1), probability));
}

void add_group(std::string& text, const char* title, const std::vector<std::string>& lines) {
  constexpr std::size_t most = 20;
  if (lines.empty()) return;
  text += fmt::format("\n{} ({})\n", title, lines.size());
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i) text += "  " + lines[i] + "\n";
  if (lines.size() > most) text += fmt::format("  ... and {} more\n", lines.size() - most);
}

}  // namespace

Comparison compare_records(const std::vector<RecordRow>& before, const std::vector<RecordRow>& after,
                           double band) {
  Comparison result;
  const std::vector<std::size_t> partner = partners(before, after);
  std::vector<bool> seen(after.size(), false);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const RecordRow& old_row = before[i];
    const std::string name = row_name(old_row);
    if (partner[i] == npos) {
      result.missing.push_back(name);
      continue;
    }
    seen[partner[i]] = true;
    ++result.matched;
    const RecordRow& new_row = after[partner[i]];
    if (old_row.outcome != new_row.outcome) {
      // Counts and errors of another outcome differ of themselves.
      result.outcomes.push_back(fmt::format("{}: {} -> {}", name, old_row.outcome, new_row.outcome));
      continue;
    }
    std::vector<std::string> changes;
    compare_counts(old_row, new_row, changes);
    if (!changes.empty()) result.counts.push_back(fmt::format("{}: {}", name, fmt::join(changes, "; ")));
    changes.clear();
    compare_errors(old_row, new_row, band, changes);
    if (!changes.empty()) result.errors.push_back(fmt::format("{}: {}", name, fmt::join(changes, "; ")));
    compare_times(old_row, new_row, name, result.times);
  }
  for (std::size_t i = 0; i < after.size(); ++i)
    if (!seen[i]) result.added.push_back(row_name(after[i]));
  return result;
}

std::string report(const Comparison& c) {
  std::string text = fmt::format(
      "{} rows in both; changed: {} outcomes, {} counts, {} errors, {} times; {} missing, {} new\n",
      c.matched, c.outcomes.size(), c.counts.size(), c.errors.size(), c.times.size(), c.missing.size(),
      c.added.size());
  add_group(text, "Outcomes", c.outcomes);
  add_group(text, "Counts", c.counts);
  add_group(text, "Errors", c.errors);
  add_group(text, "Missing", c.missing);
  add_group(text, "New", c.added);
  add_group(text, "Times", c.times);
  return text;
}

}  // namespace liebench
