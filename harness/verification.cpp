#include "harness/verification.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "harness/order_matrix.h"
#include "harness/select.h"
#include "harness/table.h"

namespace liebench {

namespace {

struct Claim {
  std::string study;
  std::string formulation;
  std::string method;  // as the table says it
  Json options;        // those that tell its curve from the others of the study
  Quantity quantity;
  int order;
};

Claim bliedf2nd(const std::string& study, const std::string& formulation, int k, bool correction,
                bool modified_start, const Quantity& quantity, int order) {
  Json options;
  options["k"] = k;
  options["correction"] = correction;
  if (formulation != "SO3" && study != "stabilized_index2") options["modified_start"] = modified_start;
  return {study, formulation, fmt::format("BLieDF2nd, k = {}", k), std::move(options), quantity, order};
}

Claim generalized_alpha(const std::string& formulation, const std::string& form, bool modified_start,
                        const Quantity& quantity, int order) {
  Json options;
  options["rho_inf"] = 0.9;
  if (formulation != "SO3") options["form"] = form;
  if (formulation != "SO3" && form == "index3") options["modified_start"] = modified_start;
  return {"generalized_alpha", formulation, "generalized-alpha, rho_inf = 0.9",
          std::move(options),  quantity,    order};
}

struct Section {
  std::string title;
  std::string source;
  std::vector<Claim> claims;
};

std::vector<Section> sections() {
  Section local{"Local errors",
                "Theorem 1: l^q and l^v are O(h^{k+1}); one step from exact starting values. (On R^3 x SO(3) "
                "the constraint ties "
                "v after one step to l^q / h, so that l^v is read on SO(3))",
                {}};
  Section local_without{"Local errors without L_k", "Section 4.2: O(h^3) for every k when L_k = 0", {}};
  Section global{"Global errors", "Theorem 2: order k in q, v and lambda at t_end = 2 s", {}};
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
      local.claims.push_back(bliedf2nd("figure2", formulation, k, true, false, q_local, k + 1));
      local_without.claims.push_back(bliedf2nd("figure2", formulation, k, false, false, q_local, 3));
    }
    local.claims.push_back(bliedf2nd("figure2", "SO3", k, true, false, v_local, k + 1));
    for (const Quantity& quantity : {q_end, v_end}) {
      global.claims.push_back(bliedf2nd("figure3", "SO3", k, true, false, quantity, k));
      global_without.claims.push_back(bliedf2nd("figure3", "SO3", k, false, false, quantity, 2));
    }
    for (const Quantity& quantity : {q_end, v_end, lambda_end}) {
      global.claims.push_back(bliedf2nd("figure4", "R3xSO3", k, true, false, quantity, k));
      global_without.claims.push_back(bliedf2nd("figure4", "R3xSO3", k, false, false, quantity, 2));
    }
    for (const Quantity& quantity : {q_max, v_max, lambda_end})
      transient.claims.push_back(bliedf2nd("figure1", "R3xSO3", k, true, false, quantity, k));
    transient.claims.push_back(bliedf2nd("figure1", "R3xSO3", k, true, false, lambda_max, k - 1));
    for (const Quantity& quantity : {q_max, v_max, lambda_max, lambda_end})
      cure.claims.push_back(bliedf2nd("figure1", "R3xSO3", k, true, true, quantity, k));
  }
  Section first{"First steps",
                "Theorem 3, eq. (55): from starting velocities by eq. (56), over the first steps (n <= 2k - "
                "1 at least) q "
                "has order k + 1, v and lambda have order k; from exact ones lambda has order k - 1",
                {}};
  for (int k = 2; k <= 4; ++k) {
    first.claims.push_back(bliedf2nd("first_steps", "R3xSO3", k, true, true, q_max, k + 1));
    first.claims.push_back(bliedf2nd("first_steps", "R3xSO3", k, true, true, v_max, k));
    first.claims.push_back(bliedf2nd("first_steps", "R3xSO3", k, true, true, lambda_max, k));
    first.claims.push_back(bliedf2nd("first_steps", "R3xSO3", k, true, false, lambda_max, k - 1));
  }
  Section alpha{
      "Generalized-alpha",
      "Order 2 in q and v; in the index-3 form lambda has order 1 in the transient phase and 2 at t_end",
      {}};
  Section alpha_cure{
      "Generalized-alpha, starting velocity perturbed", "Order 2 in lambda from the first step on", {}};
  Section alpha_stabilized{
      "Generalized-alpha, stabilized index 2", "Order 2 in all components from the first step on", {}};
  for (const Quantity& quantity : {q_end, v_end})
    alpha.claims.push_back(generalized_alpha("SO3", "index3", false, quantity, 2));
  for (const Quantity& quantity : {q_max, v_max, lambda_end}) {
    alpha.claims.push_back(generalized_alpha("R3xSO3", "index3", false, quantity, 2));
    alpha_cure.claims.push_back(generalized_alpha("R3xSO3", "index3", true, quantity, 2));
    alpha_stabilized.claims.push_back(generalized_alpha("R3xSO3", "stabilized_index2", false, quantity, 2));
  }
  alpha.claims.push_back(generalized_alpha("R3xSO3", "index3", false, lambda_max, 1));
  alpha_cure.claims.push_back(generalized_alpha("R3xSO3", "index3", true, lambda_max, 2));
  alpha_stabilized.claims.push_back(generalized_alpha("R3xSO3", "stabilized_index2", false, lambda_max, 2));
  Section faltinsen{
      "Faltinsen BDF, exact",
      "Order 2 for k = 2; in the index-3 form lambda has order 1 in the transient phase from exact starting "
      "velocities, 2 from modified ones and in the stabilized form",
      {}};
  const auto faltinsen_claim = [&](const char* form, std::optional<bool> modified, const Quantity& quantity,
                                   int order) {
    Json options;
    options["variant"] = "exact";
    options["form"] = form;
    if (modified) options["modified_start"] = *modified;
    faltinsen.claims.push_back(
        {"faltinsen_bdf", "R3xSO3", "Faltinsen BDF exact, k = 2", options, quantity, order});
  };
  for (const Quantity& quantity : {q_max, v_max, lambda_end}) {
    faltinsen_claim("index3", false, quantity, 2);
    faltinsen_claim("index3", true, quantity, 2);
    faltinsen_claim("stabilized_index2", std::nullopt, quantity, 2);
  }
  faltinsen_claim("index3", false, lambda_max, 1);
  faltinsen_claim("index3", true, lambda_max, 2);
  faltinsen_claim("stabilized_index2", std::nullopt, lambda_max, 2);
  Section stabilized{"BLieDF2nd, stabilized index 2",
                     "Order k in all components over the whole interval, from exact starting velocities",
                     {}};
  for (int k = 2; k <= 4; ++k)
    for (const Quantity& quantity : {q_end, v_end, lambda_end, q_max, v_max, lambda_max})
      stabilized.claims.push_back(bliedf2nd("stabilized_index2", "R3xSO3", k, true, false, quantity, k));
  return {local, local_without, global,     global_without,   first,      transient,
          cure,  alpha,         alpha_cure, alpha_stabilized, stabilized, faltinsen};
}

Curve select(const std::vector<RecordRow>& records, const Claim& claim) {
  Curve curve;
  for (const RecordRow& record : records) {
    if (record.curve->precision != "extended" || record.curve->formulation != claim.formulation) continue;
    bool matches = true;
    for (const auto& option : claim.options.items())
      matches = matches && record.curve->has_option(option.key().c_str(), option.value());
    if (matches) curve.records.push_back(&record);
  }
  return curve;
}

Table section_table() {
  return Table(
      "", {{.header = "problem"},
           {.header = "method"},
           {.header = "error"},
           {.header = "expected", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "measured", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 4},
           {.header = "±", .kind = ColumnKind::number, .alignment = Alignment::right, .digits = 2},
           {.header = "window in h", .unit = "s"},
           {.header = "points", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "verdict"}});
}

struct MatrixSection {
  std::string study;
  std::string title;
  std::string source;
};

// Every method, form and formulation: a table each, and all windows as CSV.
std::string matrices(const std::map<std::string, std::vector<RecordRow>>& records_by_study,
                     Verification& result) {
  const std::vector<MatrixSection> sections{
      {"verification", "Every method, form and formulation, exact starting values",
       "Order k (generalized-alpha: 2) in all components, but in the index-3 form, from exact starting "
       "velocities, the "
       "largest error of lambda has order k - 1 where velocities are inertial (R3xSO3, R3xS3). Where they "
       "are body-fixed "
       "(SE3, S3|xR3, UDQ) the constraint of the top is a subalgebra, B l = 0, and nothing is lost"},
      {"verification_own_start", "Every method, form and formulation, own start",
       "Order k (generalized-alpha: 2) in all components and over the whole interval, from initial values "
       "alone: "
       "Runge-Kutta-Munthe-Kaas start, modified starting velocities in the index-3 form"},
      {"verification_unconstrained", "The rest of the field, without constraints",
       "On the group as in a linear space: the order of the tableau, of CF4 four, of Crouch-Grossman three, "
       "k of k-step "
       "methods, two of the symmetric methods of one stage, 2 s of Gauss and 5 of Radau IIA, at the end and "
       "over the "
       "whole interval"},
      {"verification_constrained", "The rest of the field, with constraints",
       "BDF centred at the new point has the orders of the other BDF methods. RATTLie and SHAKELie have "
       "order 2 in all "
       "components and no transient phase; half-explicit methods "
       "and Radau IIA "
       "lose one order in lambda, Radau IIA of index 3 two orders in v and three in lambda, but for HERK4, "
       "HEDOP5 and Radau IIA where velocities are body-fixed (SE3, S3|xR3, UDQ): "
       "there the constraint is a subalgebra, and nothing is lost"},
      {"verification_step_control", "Steps by a tolerance",
       "Errors against tol^{1/(k+1)} of BLieDF2nd and tol^{1/5} of the pair of Dormand and Prince, the step "
       "that "
       "a tolerance asks for, "
       "by least squares over all tolerances: order k, and 5. Where velocities are inertial the first steps "
       "of "
       "BLieDF2nd, of order 1 "
       "and in proportion to tol^{1/2}, have the largest errors: (k + 1) / 2 in lambda, in the index-3 form "
       "in v, "
       "and none at all in its lambda, which "
       "at the end depends on how long ago a step changed (in brackets, no entry)"}};
  std::string text;
  Table csv("", order_matrix_columns());
  for (const MatrixSection& section : sections) {
    const auto records = records_by_study.find(section.study);
    if (records == records_by_study.end()) continue;
    const OrderMatrix matrix = order_matrix(records->second);
    result.claims += matrix.entries;
    result.confirmed += matrix.confirmed;
    for (const Row& row : matrix.rows) csv.add_row(row);
    text += fmt::format(
        "## {}\n\n{}. {} of {} entries confirmed. Each order with its uncertainty; the window of step sizes "
        "is the union of "
        "those of the row, [verification.csv](verification.csv) has that of every entry. A top that turns "
        "slowly "
        "(|Omega| = 4.3 rad/s), without symmetry of its motion, over 0.4 s. (Other ends were looked at: at "
        "0.5, 0.6 and 1 s the "
        "error of some component passes through zero, so that its order at the end can't be read there; the "
        "orders of the "
        "largest errors are the same.)\n\n{}",
        section.title, section.source, matrix.confirmed, matrix.entries, matrix.markdown);
  }
  if (!csv.rows().empty()) result.csv = to_csv(csv);
  return text;
}

}  // namespace

Verification verify(const std::map<std::string, std::vector<RecordRow>>& records_by_study,
                    const std::string& note) {
  Verification result;
  std::string body;
  for (const Section& section : sections()) {
    Table table = section_table();
    for (const Claim& claim : section.claims) {
      const auto records = records_by_study.find(claim.study);
      if (records == records_by_study.end()) continue;
      ++result.claims;
      const Judgement judgement = judge(select(records->second, claim), claim.quantity, claim.order);
      const OrderFit& fit = judgement.fit;
      Row row{claim.formulation, claim.method, describe(claim.quantity), std::int64_t(claim.order)};
      if (!fit.estimate) {
        row.insert(row.end(), {Cell{}, Cell{}, Cell{}, Cell{}, "no order: " + fit.reason});
      } else {
        const OrderEstimate& e = *fit.estimate;
        const bool confirmed = judgement.confirmed;
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
  body += matrices(records_by_study, result);
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
      order_tolerance, widest_order_tolerance, note.empty() ? "" : " " + note, result.confirmed,
      result.claims, body);
  return result;
}

}  // namespace liebench
