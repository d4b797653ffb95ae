#include "harness/stability/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "harness/errors.h"
#include "harness/methods.h"
#include "harness/record.h"
#include "harness/stability/scaling.h"

namespace liebench {

namespace {

constexpr std::array verdicts{Verdict::passed, Verdict::degraded, Verdict::failed_as_expected,
                              Verdict::failed_unexpectedly, Verdict::passed_unexpectedly};

Verdict verdict_of(const Json& record) {
  for (const Verdict v : verdicts)
    if (record.at("verdict") == name(v)) return v;
  throw std::logic_error("no verdict " + record.at("verdict").dump());
}

std::string form_of_record(const Json& record) {
  return record.value("form", "");
}

std::string form_words(const std::string& form) {
  return form == "index3" ? "index 3" : form == "stabilized_index2" ? "stabilized" : "free";
}

std::string form_title(const std::string& form) {
  return form == "index3"              ? "Index 3"
         : form == "stabilized_index2" ? "Stabilized index 2"
                                       : "Without constraints";
}

struct Worst {
  std::optional<Verdict> verdict;
  const Json* record = nullptr;  // of the worst trial

  static double severity(const Json& r) {
    return r.contains("severity") ? r.at("severity").get<double>() : r.value("amount", 0.0);
  }
  void take(const Json& next) {
    const Verdict v = verdict_of(next);
    const bool worse = !verdict || worst(*verdict, v) != *verdict;
    if (worse || (v == *verdict && severity(next) > severity(*record))) {
      verdict = v;
      record = &next;
    }
  }
};

// Subjects and columns in their first order.
struct VerdictMatrix {
  std::vector<std::string> subjects;
  std::vector<std::pair<const StabilityCase*, std::string>> columns;  // case and form
  std::map<std::string, std::vector<Worst>> cells;

  explicit VerdictMatrix(const std::vector<Json>& records) {
    for (const StabilityCase& entry : stability_cases())
      for (const char* form : {"", "index3", "stabilized_index2"})
        if (std::any_of(records.begin(), records.end(), [&](const Json& r) {
              return !plain(r) && r.at("case") == entry.name && form_of_record(r) == form;
            }))
          columns.emplace_back(&entry, form);
    for (const Contestant& contestant : contestants(true)) subjects.push_back(contestant.name);
    for (const Json& record : records) {
      const auto subject = record.at("subject").get<std::string>();
      if (std::find(subjects.begin(), subjects.end(), subject) == subjects.end()) subjects.push_back(subject);
    }
    for (const std::string& subject : subjects) cells[subject].resize(columns.size());
    for (const Json& record : records) {
      if (plain(record)) continue;
      const auto column = std::find_if(columns.begin(), columns.end(), [&](const auto& c) {
        return record.at("case") == c.first->name && form_of_record(record) == c.second;
      });
      cells[record.at("subject").get<std::string>()][std::size_t(column - columns.begin())].take(record);
    }
    // Rows of nothing: methods where only the groups were tried.
    std::erase_if(subjects, [&](const std::string& subject) {
      const auto& line = cells.at(subject);
      return std::none_of(line.begin(), line.end(), [](const Worst& c) { return c.verdict.has_value(); });
    });
  }
};

std::string words(Verdict v) {
  switch (v) {
    case Verdict::passed:
      return "passed";
    case Verdict::degraded:
      return "degraded";
    case Verdict::failed_as_expected:
      return "fails, as theory says";
    case Verdict::failed_unexpectedly:
      return "worse than theory says";
    case Verdict::passed_unexpectedly:
      break;
  }
  return "better than theory says";
}

std::string family(const std::string& subject) {
  return subject.substr(0, subject.find_first_of(", "));
}

std::ptrdiff_t judged(const std::vector<Json>& records) {
  return std::count_if(records.begin(), records.end(), [](const Json& r) { return !plain(r); });
}

std::string summary_of(const std::vector<Json>& records) {
  std::map<Verdict, int> counts;
  for (const Json& record : records)
    if (!plain(record)) ++counts[verdict_of(record)];
  std::string text;
  for (const Verdict v : verdicts)
    if (counts[v] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[v], words(v));
  return text;
}

// How the trials that ran with and without the safeguard ended, by case.
std::string safeguard_section(const std::vector<Json>& records) {
  struct Count {
    int with = 0, without = 0, of = 0;
  };
  Table table("", {{.header = "case"},
                   {.header = "trials", .kind = ColumnKind::integer, .alignment = Alignment::right},
                   {.header = "failed without", .kind = ColumnKind::integer, .alignment = Alignment::right},
                   {.header = "failed with", .kind = ColumnKind::integer, .alignment = Alignment::right}});
  for (const StabilityCase& entry : stability_cases()) {
    std::map<std::string, std::pair<const Json*, const Json*>> pairs;
    for (const Json& record : records) {
      if (record.at("case") != entry.name || !record.contains("integrator")) continue;
      const std::string key = record.at("variant").get<std::string>() + '|' +
                              record.at("subject").get<std::string>() + '|' + form_of_record(record);
      (plain(record) ? pairs[key].second : pairs[key].first) = &record;
    }
    Count count;
    for (const auto& [key, pair] : pairs) {
      if (pair.first == nullptr || pair.second == nullptr) continue;
      ++count.of;
      count.with += pair.first->at("grade") == name(Grade::failed);
      count.without += pair.second->at("grade") == name(Grade::failed);
    }
    if (count.of > 0)
      table.add_row({std::string(entry.title), std::int64_t(count.of), std::int64_t(count.without),
                     std::int64_t(count.with)});
  }
  if (table.rows().empty()) return {};
  return "\n## What the safeguard changes\n\nTrials that failed, as expected or not, with the plain Newton "
         "iteration and with the "
         "option `safeguard`.\n\n" +
         to_markdown(table);
}

}  // namespace

bool plain(const Json& record) {
  if (!record.contains("integrator") || record.at("options").value("safeguard", false)) return false;
  const MethodInfo* method = find_method(record.at("integrator").get<std::string>());
  return method != nullptr && has_option(*method, "safeguard");
}

HeatMap stability_map(const std::vector<Json>& records) {
  const VerdictMatrix matrix(records);
  HeatMap map;
  map.title = "What each method survives";
  map.kinds = {{words(Verdict::passed), "#8ed1b8", "\u2713"},
               {words(Verdict::degraded), "#f0dc6a", "~"},
               {words(Verdict::failed_as_expected), "#8497ad", "\u00d7"},
               {words(Verdict::failed_unexpectedly), "#d55e00", "!"},
               {words(Verdict::passed_unexpectedly), "#cc79a7", "?"}};
  for (const auto& [entry, form] : matrix.columns)
    map.columns.push_back({form_words(form), std::string(entry->title)});
  for (const std::string& subject : matrix.subjects) {
    map.rows.push_back(subject);
    map.row_groups.push_back(family(subject));
    std::vector<int> line;
    for (const Worst& cell : matrix.cells.at(subject))
      line.push_back(cell.verdict
                         ? int(std::find(verdicts.begin(), verdicts.end(), *cell.verdict) - verdicts.begin())
                         : -1);
    map.cells.push_back(std::move(line));
  }
  // Only what is there needs an entry in the legend.
  for (int kind = int(map.kinds.size()) - 1; kind >= 3; --kind) {
    const bool used = std::any_of(map.cells.begin(), map.cells.end(), [&](const auto& line) {
      return std::find(line.begin(), line.end(), kind) != line.end();
    });
    if (used) continue;
    map.kinds.erase(map.kinds.begin() + kind);
    for (auto& line : map.cells)
      for (int& cell : line)
        if (cell > kind) --cell;
  }
  return map;
}

Table stability_matrix(const std::vector<Json>& records, const std::string& form, bool captioned) {
  const VerdictMatrix matrix(records);
  std::vector<Column> columns{{.header = "method"}};
  for (const auto& [entry, of] : matrix.columns)
    if (of == form) columns.push_back({.header = std::string(entry->title)});
  Table table(captioned ? form_title(form) : "", columns);
  for (const std::string& subject : matrix.subjects) {
    Row row{subject};
    bool anything = false;
    for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
      if (matrix.columns[i].second != form) continue;
      const Worst& cell = matrix.cells.at(subject)[i];
      if (!cell.verdict) {
        row.emplace_back();
        continue;
      }
      anything = true;
      std::string text = words(*cell.verdict);
      if (*cell.verdict == Verdict::degraded && cell.record->contains("amount"))
        text += fmt::format(" ({:.2g})", cell.record->at("amount").get<double>());
      row.push_back(text);
    }
    if (anything) table.add_row(std::move(row));
  }
  return table;
}

Table stability_trials(const std::vector<Json>& records) {
  Table table("", {{.header = "case"},
                   {.header = "trial"},
                   {.header = "method"},
                   {.header = "form"},
                   {.header = "verdict"},
                   {.header = "how"},
                   {.header = "what theory says"}});
  for (const Json& record : records) {
    const Verdict v = verdict_of(record);
    if (v == Verdict::passed || plain(record)) continue;
    std::string how;
    if (record.at("outcome") != "ok") {
      how = record.at("outcome").get<std::string>();
      if (record.contains("failure") && record["failure"].contains("time"))
        how += fmt::format(" at {:.3g} s", record["failure"]["time"].get<double>());
    } else if (record.contains("amount")) {
      how =
          fmt::format("{:.3g} ({})", record.at("amount").get<double>(), record.at("what").get<std::string>());
    }
    table.add_row({record.at("case").get<std::string>(), record.at("variant").get<std::string>(),
                   record.at("subject").get<std::string>(), form_words(form_of_record(record)), words(v), how,
                   record.at("reason").get<std::string>()});
  }
  return table;
}

Table stability_list(const std::vector<Json>& records) {
  std::set<std::string> measures;
  for (const Json& record : records)
    if (record.contains("measured"))
      for (const auto& [key, value] : record.at("measured").items()) measures.insert(key);
  std::vector<Column> columns;
  for (const char* header :
       {"case", "variant", "method", "form", "safeguard", "outcome", "grade", "expected", "verdict"})
    columns.push_back({.header = header});
  columns.push_back({.header = "amount", .kind = ColumnKind::number});
  columns.push_back({.header = "what"});
  for (const std::string& measure : measures)
    columns.push_back({.header = measure, .kind = ColumnKind::number});
  Table table("", columns);
  for (const Json& record : records) {
    Row row;
    for (const char* key : {"case", "variant", "subject"}) row.push_back(record.at(key).get<std::string>());
    row.push_back(form_of_record(record));
    row.push_back(std::string(!record.contains("integrator") ? "" : plain(record) ? "off" : "on"));
    for (const char* key : {"outcome", "grade", "expected"}) row.push_back(record.at(key).get<std::string>());
    // Those without the safeguard are judged by nobody.
    row.push_back(plain(record) ? std::string() : record.at("verdict").get<std::string>());
    const auto number = [&](const Json& object, const std::string& key) {
      if (object.contains(key))
        row.emplace_back(object.at(key).get<double>());
      else
        row.emplace_back();
    };
    number(record, "amount");
    row.push_back(record.at("what").get<std::string>());
    const Json measured = record.value("measured", Json::object());
    for (const std::string& measure : measures) number(measured, measure);
    table.add_row(std::move(row));
  }
  return table;
}

std::string stability_report(const std::vector<Json>& records) {
  std::string text = fmt::format(
      "# Hard cases: what each method survives\n\n"
      "Written by `liebench stability`; do not edit. {} trials: {} (and as many again without the safeguard, "
      "where short). A cell is the verdict of the worst trial "
      "of its "
      "case; \"fails, as theory says\" and \"degraded\" are what the derivations in "
      "[stability.md](../docs/stability.md) let expect.\n",
      judged(records), summary_of(records));
  for (const char* form : {"", "index3", "stabilized_index2"}) {
    const Table matrix = stability_matrix(records, form, false);
    if (!matrix.rows().empty()) text += fmt::format("\n## {}\n\n{}", form_title(form), to_markdown(matrix));
  }
  text += safeguard_section(records);
  text +=
      "\n## The scaled system\n\nWhat the scaling by h is for: the Newton matrix of the paper's top, k = 3, "
      "index 3, scaled and as the "
      "equations stand.\n\n" +
      to_markdown(scaling_table());
  text += "\n## The cases\n";
  for (const StabilityCase& entry : stability_cases()) {
    std::vector<Json> own;
    for (const Json& record : records)
      if (record.at("case") == entry.name) own.push_back(record);
    if (own.empty()) continue;
    text += fmt::format("\n### {}\n\n{} {} trials: {}.\n\n- Criterion: {}.\n- Theory: {}.\n", entry.title,
                        entry.question, judged(own), summary_of(own), entry.criterion, entry.theory);
    const Table table = stability_trials(own);
    if (!table.rows().empty()) text += "\n" + to_markdown(table);
  }
  return text;
}

Json parse_stability_record(std::string_view line, const std::string& place) {
  Json record = parse_json(line, place);
  const auto refuse = [&](const char* key) {
    throw InputError(
        place,
        fmt::format("is not a record of liebench stability: \"{}\" is missing or not as it should be", key));
  };
  if (!record.is_object()) refuse("key");
  if (record.value("schema", Json()) != record_schema)
    throw InputError(place, fmt::format("this program reads record schema {}", record_schema));
  for (const char* key : {"key", "case", "variant", "subject", "outcome", "what", "reason"})
    if (!record.contains(key) || !record[key].is_string()) refuse(key);
  const auto known = [](const Json& value, const auto& all) {
    return std::any_of(all.begin(), all.end(), [&](const auto each) { return value == name(each); });
  };
  constexpr std::array grades{Grade::survived, Grade::degraded, Grade::failed};
  for (const char* key : {"grade", "expected"})
    if (!known(record.value(key, Json()), grades)) refuse(key);
  if (!known(record.value("verdict", Json()), verdicts)) refuse("verdict");
  if (record.contains("integrator") && !record.value("options", Json()).is_object()) refuse("options");
  for (const char* key : {"amount", "severity"})
    if (record.contains(key) && !record[key].is_number()) refuse(key);
  return record;
}

}  // namespace liebench
