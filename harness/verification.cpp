#include "harness/verification.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/select.h"
#include "harness/table.h"

namespace liebench {

namespace {

struct Claim {
  std::string study;
  std::string formulation;
  int k;
  bool correction;
  bool modified_start;
  Quantity quantity;
  int order;
};

struct Section {
  std::string title;
  std::string source;
  std::vector<Claim> claims;
};

// A claimed order counts as measured when the fit lies within this of it, or within twice its uncertainty
// where that is larger, but never further than 0.2.
constexpr double tolerance = 0.1;
constexpr double widest_tolerance = 0.2;

std::vector<Section> sections() {
  Section local{
      "Local errors", "Theorem 1: l^q and l^v are O(h^{k+1}); one step from exact starting values", {}};
  Section local_without{"Local errors without L_k", "Section 4.2: O(h^3) for every k when L_k = 0", {}};
  Section global{"Global errors", "Theorems 2 and 3: order k in q, v and lambda at t_end = 2 s", {}};
  Section global_without{"Global errors without L_k", "Section 4.2: order min(2, k) when L_k = 0", {}};
  Section transient{
      "Transient phase, exact starting velocities",
      "Section 3.3: over the whole interval q and v have order k, lambda only k - 1 (the paper shows "
      "k = 2; k = 3 and 4 go beyond it); at t_end lambda has order k again",
      {}};
  Section cure{"Transient phase, starting velocities modified by eq. (56)",
               "Section 3.3: order k in q, v and lambda over the whole interval (the paper shows k = 2)",
               {}};
  const Quantity q_end{"q", "end_relative"}, v_end{"v", "end_relative"}, lambda_end{"lambda", "end_relative"};
  const Quantity q_local{"q", "end_absolute"}, v_local{"v", "end_absolute"};
  const Quantity q_max{"q", "max_absolute"}, v_max{"v", "max_absolute"}, lambda_max{"lambda", "max_absolute"};
  for (int k = 2; k <= 4; ++k) {
    for (const char* formulation : {"R3xSO3", "SO3"}) {
      local.claims.push_back({"figure2", formulation, k, true, false, q_local, k + 1});
      local_without.claims.push_back({"figure2", formulation, k, false, false, q_local, 3});
    }
    local.claims.push_back({"figure2", "SO3", k, true, false, v_local, k + 1});
    for (const Quantity& quantity : {q_end, v_end}) {
      global.claims.push_back({"figure3", "SO3", k, true, false, quantity, k});
      global_without.claims.push_back({"figure3", "SO3", k, false, false, quantity, 2});
    }
    for (const Quantity& quantity : {q_end, v_end, lambda_end}) {
      global.claims.push_back({"figure4", "R3xSO3", k, true, false, quantity, k});
      global_without.claims.push_back({"figure4", "R3xSO3", k, false, false, quantity, 2});
    }
    for (const Quantity& quantity : {q_max, v_max, lambda_end})
      transient.claims.push_back({"figure1", "R3xSO3", k, true, false, quantity, k});
    transient.claims.push_back({"figure1", "R3xSO3", k, true, false, lambda_max, k - 1});
    for (const Quantity& quantity : {q_max, v_max, lambda_max, lambda_end})
      cure.claims.push_back({"figure1", "R3xSO3", k, true, true, quantity, k});
  }
  return {local, local_without, global, global_without, transient, cure};
}

Curve select(const std::vector<Json>& records, const Claim& claim) {
  Curve curve;
  for (const Json& record : records) {
    const Json& options = record.at("options");
    if (record.at("precision") == "extended" && record.at("formulation") == claim.formulation &&
        options.at("k") == claim.k && options.at("correction") == claim.correction &&
        options.at("modified_start") == claim.modified_start)
      curve.records.push_back(&record);
  }
  return curve;
}

Table section_table() {
  return Table(
      "", {{.header = "problem"},
           {.header = "k", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "error"},
           {.header = "expected", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "measured", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 4},
           {.header = "±", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 2},
           {.header = "window in h", .unit = "s"},
           {.header = "points", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "verdict"}});
}

}  // namespace

Verification verify(const std::map<std::string, std::vector<Json>>& records_by_study,
                    const std::string& note) {
  Verification result;
  std::string body;
  for (const Section& section : sections()) {
    Table table = section_table();
    for (const Claim& claim : section.claims) {
      const auto records = records_by_study.find(claim.study);
      if (records == records_by_study.end()) continue;
      ++result.claims;
      const OrderFit fit = fit_curve(select(records->second, claim), claim.quantity);
      Row row{claim.formulation, std::int64_t(claim.k), describe(claim.quantity), std::int64_t(claim.order)};
      if (!fit.estimate) {
        row.insert(row.end(), {Cell{}, Cell{}, Cell{}, Cell{}, "no order: " + fit.reason});
      } else {
        const OrderEstimate& e = *fit.estimate;
        const double allowed = std::min(widest_tolerance, std::max(tolerance, 2.0 * e.uncertainty));
        const bool confirmed = std::abs(e.order - claim.order) <= allowed;
        result.confirmed += confirmed ? 1 : 0;
        row.insert(row.end(),
                   {e.order, e.uncertainty, fmt::format("{:.2g} to {:.2g}", e.h_min, e.h_max),
                    std::int64_t(e.points),
                    confirmed ? std::string(e.still_changing ? "confirmed, slope still moving" : "confirmed")
                              : std::string(e.still_changing ? "not shown: slope still moving" : "differs")});
      }
      table.add_row(std::move(row));
    }
    if (table.rows().empty()) continue;
    body += fmt::format("## {}\n\n{}.\n\n{}\n", section.title, section.source, to_markdown(table));
  }
  result.markdown = fmt::format(
      "# What the paper claims, and what was measured\n\n"
      "Written by `liebench figures`; do not edit. Heavy top with the paper's data, BLieDF2nd started by eq. "
      "(21) from "
      "the reference solution, runs in extended precision (106 bits), where round-off rules nowhere. "
      "Orders are fits over a window found by one rule, the same for all (docs/orders.md); ± is the standard "
      "uncertainty, the drift of the slope inside the window included. A claim counts as confirmed when the "
      "measured order "
      "lies within {} of the expected one, or within twice its uncertainty where that is larger, but never "
      "further than "
      "{}.{}\n\n"
      "**{} of {} claims confirmed.**\n\n{}",
      tolerance, widest_tolerance, note.empty() ? "" : " " + note, result.confirmed, result.claims, body);
  return result;
}

}  // namespace liebench
