#include "harness/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace liebench {
namespace {

bool fits(const Cell& cell, ColumnKind kind) {
  if (std::holds_alternative<std::monostate>(cell)) return true;
  switch (kind) {
    case ColumnKind::text:
      return std::holds_alternative<std::string>(cell);
    case ColumnKind::integer:
      return std::holds_alternative<std::int64_t>(cell);
    case ColumnKind::number:
      return std::holds_alternative<double>(cell);
    case ColumnKind::mark:
      break;
  }
  return std::holds_alternative<bool>(cell);
}

// A finite number with the column's significant digits; trailing zeros stay, for they are digits too.
std::string rounded(double value, const Column& column) {
  const std::string scientific = fmt::format("{:.{}e}", value, column.digits - 1);
  const std::size_t e = scientific.find('e');
  // Of the rounded number: 9.996 with three digits is 10.0.
  const int exponent = std::stoi(scientific.substr(e + 1));
  if (column.notation == Notation::automatic && exponent >= -4 && exponent < column.digits) {
    return fmt::format("{:.{}f}", value, column.digits - 1 - exponent);
  }
  return fmt::format("{}e{}", scientific.substr(0, e), exponent);
}

std::string header_text(const Column& column) {
  return column.unit.empty() ? column.header : fmt::format("{} [{}]", column.header, column.unit);
}

// The same cell in the writer's own words: one member for each thing a cell can be.
struct Wording {
  std::string (*text)(std::string_view);
  std::string (*number)(const std::string&);  // from digits and perhaps e
  std::string absent;
  std::string nan;
  std::string infinity;
  std::string minus_infinity;
  std::string yes;
  std::string no;
};

std::string worded(const Cell& cell, const Column& column, const Wording& wording) {
  if (const auto* text = std::get_if<std::string>(&cell)) return wording.text(*text);
  if (const auto* integer = std::get_if<std::int64_t>(&cell))
    return wording.number(fmt::format("{}", *integer));
  if (const auto* mark = std::get_if<bool>(&cell)) return *mark ? wording.yes : wording.no;
  if (const auto* number = std::get_if<double>(&cell)) {
    if (std::isnan(*number)) return wording.nan;
    if (std::isinf(*number)) return *number > 0 ? wording.infinity : wording.minus_infinity;
    return wording.number(rounded(*number, column));
  }
  return wording.absent;
}

// Width on screen in columns: code points, which is right for every character that our tables use.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t to_width, Alignment alignment) {
  const std::size_t space = to_width - width(text);
  const std::size_t left = alignment == Alignment::left    ? 0
                           : alignment == Alignment::right ? space
                                                           : space / 2;
  return std::string(left, ' ') + text + std::string(space - left, ' ');
}

std::string markdown_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '\\') escaped += '\\';
    if (c == '\n') {
      escaped += "<br>";
    } else if (c != '\r') {
      escaped += c;
    }
  }
  return escaped;
}

// A character and its LaTeX in turn. A bracket is braced because at the start of a row TeX would read it as
// the argument of the line break before it.
// clang-format off
constexpr auto latex_translations = std::to_array<std::string_view>({
    "\\", "\\textbackslash{}",  "{", "\\{",  "}", "\\}",  "$", "\\$",  "&", "\\&",  "#", "\\#",
    "_", "\\_",  "%", "\\%",  "~", "\\textasciitilde{}",  "^", "\\textasciicircum{}",
    "<", "\\textless{}",  ">", "\\textgreater{}",  "|", "\\textbar{}",  "[", "{[}",  "]", "{]}",
    "\r", "",  "\n", " ",  "α", "$\\alpha$",  "β", "$\\beta$",  "γ", "$\\gamma$",  "δ", "$\\delta$",
    "ε", "$\\varepsilon$",  "θ", "$\\theta$",  "λ", "$\\lambda$",  "μ", "$\\mu$",  "π", "$\\pi$",
    "ρ", "$\\rho$",  "σ", "$\\sigma$",  "τ", "$\\tau$",  "φ", "$\\varphi$",  "ω", "$\\omega$",
    "Δ", "$\\Delta$",  "Φ", "$\\Phi$",  "Ω", "$\\Omega$",  "²", "$^2$",  "³", "$^3$",  "±", "$\\pm$",
    "×", "$\\times$",  "·", "$\\cdot$",  "−", "$-$",  "≤", "$\\le$",  "≥", "$\\ge$",  "≈", "$\\approx$",
    "∞", "$\\infty$",  "→", "$\\to$",  "°", "$^\\circ$",  "–", "--",  "—", "---"});
// clang-format on

std::string latex_text(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    std::size_t i = 0;
    while (i < latex_translations.size() && !text.starts_with(latex_translations[i])) i += 2;
    const bool known = i < latex_translations.size();
    escaped += known ? latex_translations[i + 1] : text.substr(0, 1);
    text.remove_prefix(known ? latex_translations[i].size() : 1);
  }
  return escaped;
}

std::string csv_text(std::string_view text) {
  if (!text.empty() && text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_cell(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return csv_text(*text);
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *integer);
  if (const auto* mark = std::get_if<bool>(&cell)) return *mark ? "true" : "false";
  if (const auto* number = std::get_if<double>(&cell)) {
    // The sign of a NaN says nothing and is not the same on all machines.
    return std::isnan(*number) ? "nan" : fmt::format("{}", *number);
  }
  return "";
}

}  // namespace

Table::Table(std::string caption, std::vector<Column> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)) {
  if (columns_.empty()) throw std::invalid_argument("a table needs at least one column");
  for (const Column& column : columns_) {
    if (column.digits < 1 || column.digits > 17) {
      throw std::invalid_argument(fmt::format("column \"{}\": {} significant digits, allowed are 1 to 17",
                                              column.header, column.digits));
    }
  }
}

void Table::add_row(Row row) {
  if (row.size() != columns_.size()) {
    throw std::invalid_argument(fmt::format("row {} has {} cells, the table has {} columns", rows_.size() + 1,
                                            row.size(), columns_.size()));
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (fits(row[i], columns_[i].kind)) continue;
    throw std::invalid_argument(fmt::format("row {}, column \"{}\": the cell is not of the column's kind",
                                            rows_.size() + 1, columns_[i].header));
  }
  rows_.push_back(std::move(row));
}

std::string to_markdown(const Table& table) {
  static const Wording wording{.text = markdown_text,
                               .number = [](const std::string& digits) { return digits; },
                               .absent = "–",
                               .nan = "NaN",
                               .infinity = "∞",
                               .minus_infinity = "-∞",
                               .yes = "✓",
                               .no = "✗"};
  const auto& columns = table.columns();
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& column : columns) lines.front().push_back(markdown_text(header_text(column)));
  for (const Row& row : table.rows()) {
    auto& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) line.push_back(worded(row[i], columns[i], wording));
  }
  std::vector<std::size_t> widths(columns.size(), 3);  // three, for the rule below the headers
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], width(line[i]));
  }

  std::string text;
  if (!table.caption().empty()) text += markdown_text(table.caption()) + "\n\n";
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      text += "| " + padded(lines[n][i], widths[i], columns[i].alignment) + ' ';
    text += "|\n";
    if (n > 0) continue;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool right = columns[i].alignment != Alignment::left;
      const bool centre = columns[i].alignment == Alignment::centre;
      text += fmt::format("| {}{}{} ", centre ? ":" : "",
                          std::string(widths[i] - (right ? 1 : 0) - (centre ? 1 : 0), '-'), right ? ":" : "");
    }
    text += "|\n";
  }
  return text;
}

std::string to_latex(const Table& table) {
  static const Wording wording{
      .text = latex_text,
      .number = [](const std::string& digits) { return fmt::format("\\num{{{}}}", digits); },
      .absent = "--",
      .nan = "NaN",
      .infinity = "$\\infty$",
      .minus_infinity = "$-\\infty$",
      .yes = "$\\checkmark$",
      .no = "$\\times$"};
  const auto& columns = table.columns();
  std::string text = "% needs \\usepackage{booktabs,siunitx,amssymb}\n\\begin{table}\n  \\centering\n";
  if (!table.caption().empty()) text += fmt::format("  \\caption{{{}}}\n", latex_text(table.caption()));
  text += "  \\begin{tabular}{";
  for (const Column& column : columns) {
    text += column.alignment == Alignment::left ? 'l' : column.alignment == Alignment::right ? 'r' : 'c';
  }
  text += "}\n    \\toprule\n    ";
  for (std::size_t i = 0; i < columns.size(); ++i)
    text += (i > 0 ? " & " : "") + latex_text(header_text(columns[i]));
  text += " \\\\\n    \\midrule\n";
  for (const Row& row : table.rows()) {
    text += "    ";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += (i > 0 ? " & " : "") + worded(row[i], columns[i], wording);
    text += " \\\\\n";
  }
  return text + "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

std::string to_csv(const Table& table) {
  const auto& columns = table.columns();
  std::string text;
  for (std::size_t i = 0; i < columns.size(); ++i)
    text += (i > 0 ? "," : "") + csv_text(header_text(columns[i]));
  text += "\r\n";
  for (const Row& row : table.rows()) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + csv_cell(row[i]);
    const bool blank_line = row.size() == 1 && std::holds_alternative<std::monostate>(row.front());
    text += blank_line ? "\"\"\r\n" : "\r\n";
  }
  return text;
}

std::string render(const Table& table, TableFormat format) {
  switch (format) {
    case TableFormat::markdown:
      return to_markdown(table);
    case TableFormat::latex:
      return to_latex(table);
    case TableFormat::csv:
      break;
  }
  return to_csv(table);
}

}  // namespace liebench
