#include "harness/sheets.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "harness/embedded.h"
#include "harness/instances/heavy_top_steppers.h"
#include "harness/outside/outside_methods.h"
#include "harness/run_method.h"
#include "harness/stability/contestant.h"
#include "harness/table.h"
#include "integrators/form.h"

namespace liebench {

namespace {

// --- what a step costs ---------------------------------------------------------------------------------------

// The paper's top, which turns by 0.075 rad in such a step: within the bound of every method in every form.
constexpr double step_size = 5e-4;
constexpr std::uint64_t counted_steps = 200;

struct StepCost {
  Outcome outcome = Outcome::ok;
  double steps = 0.0;
  RunCost cost;  // of all of them, the start not among them

  double per_step(std::uint64_t count) const { return double(count) / steps; }
};

RunCost difference(const RunCost& a, const RunCost& b) {
  RunCost d = a;
  d.kernel.iterations -= b.kernel.iterations;
  d.kernel.factorizations -= b.kernel.factorizations;
  d.system = a.system - b.system;
  d.group = a.group - b.group;
  d.operations = *a.operations - *b.operations;
  return d;
}

template <MechanicalSystem S>
StepCost step_cost(const Contestant& contestant, const OptionValues& options) {
  const S system{HeavyTopParameters{}};
  const RunRequest request{.integrator = std::string(contestant.method->name),
                           .options = options,
                           .start = Start::self,
                           .step_size = contestant.chooses_steps() ? counted_steps * step_size : step_size};
  const auto stepper = any_stepper(detail::options_of(request), system);
  const detail::Counting counting;
  detail::Beginning<S> beginning;
  StepCost result;
  result.outcome = beginning.start(*stepper, request).outcome;
  const RunCost start = counting.cost(*stepper);
  while (result.outcome == Outcome::ok && !stepper->finished() &&
         (contestant.chooses_steps() || result.steps < double(counted_steps))) {
    result.outcome = stepper->step().outcome;
    if (result.outcome == Outcome::ok) result.steps += 1.0;
  }
  result.cost = difference(counting.cost(*stepper), start);
  return result;
}

// One decimal, and three digits of what is large.
std::string count_text(double x) {
  if (x >= 1000.0) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
    const std::string digits = fmt::format("{:.0f}", std::round(x / unit) * unit);
    std::string grouped;
    for (std::size_t i = 0; i < digits.size(); ++i) {
      if (i > 0 && (digits.size() - i) % 3 == 0) grouped += ',';
      grouped += digits[i];
    }
    return grouped;
  }
  std::string text = fmt::format("{:.{}f}", x, x >= 100.0 ? 0 : 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::string orders_text(const ConvergenceOrders& orders, bool constrained) {
  if (constrained) return fmt::format("{}, {}, {}", orders.q, orders.v, orders.lambda);
  return orders.q == orders.v ? fmt::format("{}", orders.q) : fmt::format("{}, {}", orders.q, orders.v);
}

std::string form_text(std::string_view form) {
  return form == "index3" ? "R3xSO3, index 3" : form.empty() ? "SO3" : "R3xSO3, stabilized";
}

// The members of a method, on the problems that it fits, in its forms.
std::string costs_table(const MethodInfo& method) {
  std::vector<Column> columns{{.header = "member"}, {.header = "heavy top"}, {.header = "order"}};
  for (const char* header : {"residuals", "Newton iterations", "factorizations", "exp", "log", "T", "T^{-1}",
                             "commutators", "operations"})
    columns.push_back({.header = header, .alignment = Alignment::right});
  Table table("", columns);
  const auto add = [&](const Contestant& member, std::string_view form) {
    const OptionValues options = member.options_for(form);
    const bool constrained = !form.empty();
    const StepCost step =
        constrained ? step_cost<CountedR3xSO3>(member, options) : step_cost<CountedSO3>(member, options);
    Row row{member.name, has_option(method, form_option.name) || !constrained ? form_text(form) : "R3xSO3",
            member.chooses_steps() ? fmt::format("up to {}", method.orders(options).q)
                                   : orders_text(method.orders(options), constrained)};
    if (step.outcome != Outcome::ok)
      throw std::logic_error(fmt::format("{}, {}: {} on the heavy top with h = {} s", member.name,
                                         form_text(form), name(step.outcome), step_size));
    const RunCost& cost = step.cost;
    for (const std::uint64_t count :
         {cost.system.forces, cost.kernel.iterations, cost.kernel.factorizations, cost.group.exp,
          cost.group.log, cost.group.tangent, cost.group.tangent_inverse, cost.group.commutators,
          cost.operations->total()})
      row.emplace_back(count_text(step.per_step(count)));
    table.add_row(std::move(row));
  };
  for (const bool constrained : {false, true})
    for (const Contestant& member : contestants(false)) {
      if (member.method != &method || !fits(method.fits, constrained)) continue;
      if (!constrained)
        add(member, "");
      else if (!has_option(method, form_option.name))
        add(member, member.own_form());
      else
        for (const std::string_view form : {"index3", "stabilized_index2"}) add(member, form);
    }
  return to_markdown(table);
}

// --- what it declares ----------------------------------------------------------------------------------------

OptionValues defaults_of(const MethodInfo& method, bool constrained) {
  OptionValues values;
  for (const OptionInfo& info : method.options)
    if (info.scope == OptionScope::everywhere || constrained) values.set(info.name, option_default(info));
  return values;
}

std::string kept_text(const KeptConstraints& kept) {
  if (kept.position && kept.velocity) return "Phi(q) = 0 and B(q) v = 0 hold to round-off in every step";
  if (kept.position)
    return "Phi(q) = 0 holds to round-off in every step, the hidden constraint to the order of the method";
  return "B(q) v = 0 holds to round-off in every step, Phi(q) = 0 to the order of the method";
}

}  // namespace

std::string declarations_text(const MethodInfo& method) {
  std::string text;
  if (method.fits != Fits::without_constraints) {
    const OptionValues values = defaults_of(method, true);
    text = kept_text(method.kept(values));
    if (has_option(method, form_option.name))
      text = "with \"form\": \"index3\" " + text + "; with \"stabilized_index2\" both do";
    else if (has_option(method, "projection"))
      text += "; with \"projection\" both do";
    text[0] = text[0] == 'w' ? 'W' : text[0];
    text += '.';
  }
  if (method.fits != Fits::with_constraints && method.symmetric(defaults_of(method, false)))
    text += text.empty() ? "Symmetric." : " Symmetric.";
  return text;
}

MethodSheet read_sheet(std::string_view text, std::string_view file) {
  constexpr std::array<std::string_view, 3> openings{"Source: ", "Use it: ", "Not: "};
  std::array<std::size_t, 4> begins{};
  for (std::size_t i = 0; i < 3; ++i) {
    begins[i] = text.find("\n\n" + std::string(openings[i]), i == 0 ? 0 : begins[i - 1]);
    if (begins[i] == std::string_view::npos)
      throw std::logic_error(
          fmt::format("{} has no paragraph that begins with \"{}\" in its place", file, openings[i]));
  }
  begins[3] = text.size();
  const auto part = [&](std::size_t i) {
    std::string_view words =
        text.substr(begins[i] + 2 + openings[i].size(), begins[i + 1] - begins[i] - 2 - openings[i].size());
    while (!words.empty() && words.back() == '\n') words.remove_suffix(1);
    if (words.empty()) throw std::logic_error(fmt::format("{} says nothing after \"{}\"", file, openings[i]));
    return std::string(words);
  };
  const std::string_view definition = text.substr(0, begins[0]);
  if (definition.substr(0, 4) != "    ")
    throw std::logic_error(
        fmt::format("{} does not begin with a definition, four blanks before each line", file));
  return {std::string(definition), part(0), part(1), part(2)};
}

MethodSheet sheet_of(const MethodInfo& method) {
  const std::string file = fmt::format("{}.md", method.name);
  const std::string_view text = embedded_sheet(file);
  if (text.empty()) throw std::logic_error(fmt::format("there is no integrators/sheets/{}", file));
  return read_sheet(text, "integrators/sheets/" + file);
}

std::string sheet_text(const MethodInfo& method) {
  const MethodSheet sheet = sheet_of(method);
  return fmt::format(
      "{}\n\nSource: {}\n\nUse it: {}\n\nNot: {}\n\nCost of a step of {} s of the heavy top "
      "(docs/integrators.md):\n\n{}",
      sheet.definition, sheet.source, sheet.use, sheet.avoid, step_size, costs_table(method));
}

std::string integrators_page() {
  std::string overview = "| integrator | integrates | |\n| --- | --- | --- |\n", sheets;
  Table outside("", {{.header = "solver"}, {.header = "what it is"}, {.header = "formulation"}});
  for (const MethodInfo& method : methods()) {
    if (method.outside != nullptr) {
      outside.add_row({fmt::format("`{}`", method.name), std::string(method.summary),
                       std::string(method.outside->formulation)});
      continue;
    }
    overview += fmt::format("| [{0}](#{0}) | {1} | {2} |\n", method.name, fits_text(method), method.summary);
    const MethodSheet sheet = sheet_of(method);
    std::string options;
    for (const OptionInfo& info : method.options)
      options +=
          fmt::format("{}`{}` ({})", options.empty() ? "Options: " : ", ", info.name, allowed_values(info));
    const std::string declared = declarations_text(method);
    sheets += fmt::format(
        "## {}\n\n{}.\n\n{}\n\n**Source.** {}\n\n**Integrates** {}.{}{} {}\n\n**Use it:** {}\n\n**Not:** "
        "{}\n\n{}\n",
        method.name, method.summary, sheet.definition, sheet.source, fits_text(method),
        declared.empty() ? "" : " ", declared, options.empty() ? "No options." : options + ".", sheet.use,
        sheet.avoid, costs_table(method));
  }
  return fmt::format(
      "# Integrators\n\n"
      "Written by `liebench describe integrators`; do not edit: definition, source and use are in\n"
      "[integrators/sheets](../integrators/sheets), the rest is what the methods declare and what the "
      "program counts. One of them alone:\n"
      "`liebench describe NAME`; all keys of the options: [studies](studies.md). Which for which accuracy, "
      "measured: [field](field.md);\n"
      "what each survives: [hard cases](stability.md); that orders are what they are called here: "
      "[verification](verification.md).\n\n"
      "Systems are q' = DL_q(e) v~, M(q) v' = -g(t, q, v) - B(q)^T lambda, Phi(q) = 0, and T(s) is the "
      "tangent operator, d exp(s~) = exp(s~) (T(s) ds)~\n"
      "([theory](theory.md)). Orders are those of q, v and lambda, one number where they are the same and "
      "there is no lambda. Costs are those of a step of {} s of the\n"
      "paper's heavy top, without constraints (SO3) and with three (R3xSO3): the mean of {} steps after the "
      "method's own start, counted\n"
      "in an audit. A method that chooses its steps covers the same time; its counts are over the steps that "
      "it accepted, whose length is another.\n"
      "Operations are those in floating point, all kinds together.\n\n{}\n{}"
      "## Solvers from outside\n\nOf SUNDIALS, where the program was built with it. On the heavy top they "
      "run in "
      "the formulation whose unknowns they have.\n\n{}",
      step_size, counted_steps, overview, sheets, to_markdown(outside));
}

}  // namespace liebench
