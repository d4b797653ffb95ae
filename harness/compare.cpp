#include "harness/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "harness/rank_test.h"
#include "harness/record_row.h"
#include "harness/timing.h"

namespace liebench {

namespace {

std::string row_identity(const Json& record) {
  Json identity;
  for (const std::string_view key : identity_keys)
    // Runs over a number of steps end elsewhere for every step size.
    if (record.contains(key) && !(key == "t_end" && record.contains("local_steps")))
      identity[std::string(key)] = record.at(key);
  identity["steps"] = record.at("steps");
  identity["step_size"] = record.at("step_size");
  return identity.dump();
}

std::optional<double> error_of(const Json& record, const char* component, const char* norm) {
  const Json::json_pointer pointer(fmt::format("/errors/{}/{}", component, norm));
  if (!record.contains(pointer) || !record.at(pointer).is_number()) return std::nullopt;
  return record.at(pointer).get<double>();
}

std::string row_name(const Json& record) {
  std::string options;
  for (const auto& option : record.at("options").items())
    options +=
        fmt::format(" {}={}", option.key(),
                    option.value().is_string() ? option.value().get<std::string>() : option.value().dump());
  return fmt::format("{} {} {}{} h={:.4g}", record.at("problem").get<std::string>(),
                     record.at("formulation").get<std::string>(), record.at("integrator").get<std::string>(),
                     options, record.at("step_size").get<double>());
}

// The index of the old row in the new ones, or npos; each new row is taken once.
constexpr std::size_t npos = std::size_t(-1);
std::vector<std::size_t> partners(const std::vector<Json>& before, const std::vector<Json>& after) {
  std::unordered_map<std::string, std::size_t> by_key;
  for (std::size_t i = 0; i < after.size(); ++i) by_key.emplace(after[i].at("key").get<std::string>(), i);
  std::vector<std::size_t> partner(before.size(), npos);
  std::vector<bool> taken(after.size(), false);
  for (std::size_t i = 0; i < before.size(); ++i)
    if (const auto found = by_key.find(before[i].at("key").get_ref<const std::string&>());
        found != by_key.end() && !taken[found->second]) {
      partner[i] = found->second;
      taken[found->second] = true;
    }
  std::unordered_map<std::string, std::size_t> by_identity;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (!taken[i]) by_identity.emplace(row_identity(after[i]), i);
  if (by_identity.empty()) return partner;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (partner[i] != npos) continue;
    const auto found = by_identity.find(row_identity(before[i]));
    if (found == by_identity.end() || taken[found->second]) continue;
    partner[i] = found->second;
    taken[found->second] = true;
  }
  return partner;
}

void compare_counts(const Json& before, const Json& after, const std::string& prefix,
                    std::vector<std::string>& changes) {
  for (const auto& item : before.items()) {
    const std::string name = prefix + item.key();
    const auto found = after.find(item.key());
    if (found == after.end())
      changes.push_back(fmt::format("{} {} -> absent", name, item.value().dump()));
    else if (item.value().is_object() && found->is_object())
      compare_counts(item.value(), *found, name + ".", changes);
    else if (item.value() != *found)
      changes.push_back(fmt::format("{} {} -> {}", name, item.value().dump(), found->dump()));
  }
}

// The unit round-off: of double-double arithmetic in extended precision.
double round_off(const Json& record) {
  const double eps = std::numeric_limits<double>::epsilon() / 2;
  return record.at("precision") == "extended" ? eps * eps : eps;
}

void compare_errors(const Json& before, const Json& after, double band, std::vector<std::string>& changes) {
  const double relative_band = 1e-6;
  for (const char* component : {"q", "v", "lambda"}) {
    const auto relative = error_of(before, component, "end_relative");
    const auto absolute = error_of(before, component, "end_absolute");
    const double solution =
        relative && absolute && *relative > 0 ? std::max(1.0, *absolute / *relative) : 1.0;
    for (const char* norm : {"end_relative", "end_absolute", "max_absolute"}) {
      const auto a = error_of(before, component, norm), b = error_of(after, component, norm);
      if (!a && !b) continue;
      if (a.has_value() != b.has_value()) {
        changes.push_back(fmt::format("{} {} is {} now", component, norm, a ? "absent" : "present"));
        continue;
      }
      const double size = std::string_view(norm) == "end_relative" ? 1.0 : solution;
      const double allowed = relative_band * std::max(*a, *b) +
                             band * round_off(before) * before.at("steps").get<double>() * size;
      // Not "greater than": a NaN differs, too.
      if (!(std::abs(*a - *b) <= allowed))
        changes.push_back(
            fmt::format("{} {} {:.4e} -> {:.4e}, allowed {:.1e}", component, norm, *a, *b, allowed));
    }
  }
}

std::vector<double> samples(const Json& record) {
  const Json::json_pointer pointer("/time/ns_per_step/samples");
  std::vector<double> list;
  if (!record.contains(pointer) || !record.at(pointer).is_array()) return list;
  for (const Json& value : record.at(pointer))
    if (value.is_number()) list.push_back(value.get<double>());
  return list;
}

void compare_times(const Json& before, const Json& after, const std::string& name,
                   std::vector<std::string>& changes) {
  const std::vector<double> a = samples(before), b = samples(after);
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

Comparison compare_records(const std::vector<Json>& before, const std::vector<Json>& after, double band) {
  Comparison result;
  const std::vector<std::size_t> partner = partners(before, after);
  std::vector<bool> seen(after.size(), false);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Json& old_row = before[i];
    const std::string name = row_name(old_row);
    if (partner[i] == npos) {
      result.missing.push_back(name);
      continue;
    }
    seen[partner[i]] = true;
    ++result.matched;
    const Json& new_row = after[partner[i]];
    if (old_row.at("outcome") != new_row.at("outcome")) {
      // Counts and errors of another outcome differ of themselves.
      result.outcomes.push_back(fmt::format("{}: {} -> {}", name, old_row.at("outcome").get<std::string>(),
                                            new_row.at("outcome").get<std::string>()));
      continue;
    }
    std::vector<std::string> changes;
    compare_counts(old_row.at("cost"), new_row.at("cost"), "", changes);
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
