#include "harness/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "harness/large_pages.h"
#include "harness/parallel.h"

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

// Appends a finite number with the column's significant digits; trailing zeros stay, for they are digits too.
void add_rounded(std::string& text, double value, const Column& column) {
  std::array<char, 40> buffer;
  const auto result = fmt::format_to_n(buffer.data(), buffer.size(), "{:.{}e}", value, column.digits - 1);
  const std::string_view scientific(buffer.data(), result.size);
  const std::size_t e = scientific.find('e');
  // Of the rounded number: 9.996 with three digits is 10.0.
  int exponent = 0;
  const char* const sign = scientific.data() + e + 1;
  std::from_chars(*sign == '+' ? sign + 1 : sign, scientific.data() + scientific.size(), exponent);
  if (column.notation == Notation::automatic && exponent >= -4 && exponent < column.digits) {
    fmt::format_to(std::back_inserter(text), "{:.{}f}", value, column.digits - 1 - exponent);
  } else {
    text += scientific.substr(0, e);
    fmt::format_to(std::back_inserter(text), "e{}", exponent);
  }
}

std::string header_text(const Column& column) {
  return column.unit.empty() ? column.header : fmt::format("{} [{}]", column.header, column.unit);
}

// The same cell in the writer's own words: one member for each thing a cell can be.
struct Wording {
  void (*add_text)(std::string& text, std::string_view added);
  std::string before_number;
  std::string after_number;
  std::string absent;
  std::string nan;
  std::string infinity;
  std::string minus_infinity;
  std::string yes;
  std::string no;
};

void add_cell(std::string& text, const Cell& cell, const Column& column, const Wording& wording) {
  if (const auto* words = std::get_if<std::string>(&cell)) {
    wording.add_text(text, *words);
  } else if (const auto* integer = std::get_if<std::int64_t>(&cell)) {
    fmt::format_to(std::back_inserter(text), "{}{}{}", wording.before_number, *integer, wording.after_number);
  } else if (const auto* mark = std::get_if<bool>(&cell)) {
    text += *mark ? wording.yes : wording.no;
  } else if (const auto* number = std::get_if<double>(&cell)) {
    if (std::isnan(*number)) {
      text += wording.nan;
    } else if (std::isinf(*number)) {
      text += *number > 0 ? wording.infinity : wording.minus_infinity;
    } else {
      text += wording.before_number;
      add_rounded(text, *number, column);
      text += wording.after_number;
    }
  } else {
    text += wording.absent;
  }
}

// Width on screen in columns: code points, which is right for every character that our tables use.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void add_padded(std::string& text, std::string_view added, std::size_t to_width, Alignment alignment) {
  const std::size_t space = to_width - width(added);
  const std::size_t left = alignment == Alignment::left    ? 0
                           : alignment == Alignment::right ? space
                                                           : space / 2;
  text.append(left, ' ').append(added).append(space - left, ' ');
}

void add_markdown(std::string& text, std::string_view added) {
  for (const char c : added) {
    if (c == '|' || c == '\\') text += '\\';
    if (c == '\n') {
      text += "<br>";
    } else if (c != '\r') {
      text += c;
    }
  }
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

void add_latex(std::string& text, std::string_view added) {
  while (!added.empty()) {
    std::size_t i = 0;
    while (i < latex_translations.size() && !added.starts_with(latex_translations[i])) i += 2;
    const bool known = i < latex_translations.size();
    text += known ? latex_translations[i + 1] : added.substr(0, 1);
    added.remove_prefix(known ? latex_translations[i].size() : 1);
  }
}

void add_csv(std::string& text, std::string_view added) {
  if (!added.empty() && added.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += added;
    return;
  }
  text += '"';
  for (const char c : added) {
    if (c == '"') text += '"';
    text += c;
  }
  text += '"';
}

void add_csv_cell(std::string& text, const Cell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) {
    add_csv(text, *words);
  } else if (const auto* integer = std::get_if<std::int64_t>(&cell)) {
    fmt::format_to(std::back_inserter(text), "{}", *integer);
  } else if (const auto* mark = std::get_if<bool>(&cell)) {
    text += *mark ? "true" : "false";
  } else if (const auto* number = std::get_if<double>(&cell)) {
    // The sign of a NaN says nothing and is not the same on all machines.
    if (std::isnan(*number))
      text += "nan";
    else
      fmt::format_to(std::back_inserter(text), "{}", *number);
  }
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

namespace {

// Consecutive rows of a Markdown table.
struct MarkdownRows {
  std::string cells;              // one after the other
  std::vector<std::size_t> ends;  // of the cells
  std::vector<std::size_t> widths;
  std::string text;

  explicit MarkdownRows(std::size_t columns) : widths(columns, 3) {}  // three, for the rule below the headers

  void end_cell() {
    const std::size_t begin = ends.empty() ? 0 : ends.back();
    std::size_t& widest = widths[ends.size() % widths.size()];
    widest = std::max(widest, width(std::string_view(cells).substr(begin)));
    ends.push_back(cells.size());
  }
  // With columns of these widths.
  void write(const std::vector<Column>& columns, const std::vector<std::size_t>& common_widths) {
    std::size_t begin = 0;
    for (std::size_t cell = 0; cell < ends.size(); begin = ends[cell++]) {
      const std::size_t i = cell % columns.size();
      text += "| ";
      add_padded(text, std::string_view(cells).substr(begin, ends[cell] - begin), common_widths[i],
                 columns[i].alignment);
      text += i + 1 < columns.size() ? " " : " |\n";
    }
  }
};

}  // namespace

std::string to_markdown(const Table& table) {
  static const Wording wording{.add_text = add_markdown,
                               .before_number = "",
                               .after_number = "",
                               .absent = "–",
                               .nan = "NaN",
                               .infinity = "∞",
                               .minus_infinity = "-∞",
                               .yes = "✓",
                               .no = "✗"};
  const auto& columns = table.columns();
  MarkdownRows headers(columns.size());
  for (const Column& column : columns) {
    add_markdown(headers.cells, header_text(column));
    headers.end_cell();
  }
  // A cost-accuracy table of many curves has 10^5 rows.
  constexpr std::size_t block_size = 4096;
  std::vector<MarkdownRows> blocks((table.rows().size() + block_size - 1) / block_size,
                                   MarkdownRows(columns.size()));
  for_each_in_parallel(blocks.size(), [&](std::size_t number) {
    const std::size_t end = std::min(table.rows().size(), (number + 1) * block_size);
    for (std::size_t i = number * block_size; i < end; ++i)
      for (std::size_t j = 0; j < columns.size(); ++j) {
        add_cell(blocks[number].cells, table.rows()[i][j], columns[j], wording);
        blocks[number].end_cell();
      }
  });
  std::vector<std::size_t> widths = headers.widths;
  for (const MarkdownRows& block : blocks)
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], block.widths[i]);
  headers.write(columns, widths);
  for_each_in_parallel(blocks.size(), [&](std::size_t i) { blocks[i].write(columns, widths); });

  std::string text;
  std::size_t size = table.caption().size() + 1000 + 2 * headers.text.size();
  for (const MarkdownRows& block : blocks) size += block.text.size();
  reserve_in_large_pages(text, size);
  if (!table.caption().empty()) {
    add_markdown(text, table.caption());
    text += "\n\n";
  }
  text += headers.text;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool right = columns[i].alignment != Alignment::left;
    const bool centre = columns[i].alignment == Alignment::centre;
    text += fmt::format("| {}{}{} ", centre ? ":" : "",
                        std::string(widths[i] - (right ? 1 : 0) - (centre ? 1 : 0), '-'), right ? ":" : "");
  }
  text += "|\n";
  for (const MarkdownRows& block : blocks) text += block.text;
  return text;
}

std::string to_latex(const Table& table) {
  static const Wording wording{.add_text = add_latex,
                               .before_number = "\\num{",
                               .after_number = "}",
                               .absent = "--",
                               .nan = "NaN",
                               .infinity = "$\\infty$",
                               .minus_infinity = "$-\\infty$",
                               .yes = "$\\checkmark$",
                               .no = "$\\times$"};
  const auto& columns = table.columns();
  std::string text = "% needs \\usepackage{booktabs,siunitx,amssymb}\n\\begin{table}\n  \\centering\n";
  if (!table.caption().empty()) {
    text += "  \\caption{";
    add_latex(text, table.caption());
    text += "}\n";
  }
  text += "  \\begin{tabular}{";
  for (const Column& column : columns) {
    text += column.alignment == Alignment::left ? 'l' : column.alignment == Alignment::right ? 'r' : 'c';
  }
  text += "}\n    \\toprule\n    ";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) text += " & ";
    add_latex(text, header_text(columns[i]));
  }
  text += " \\\\\n    \\midrule\n";
  for (const Row& row : table.rows()) {
    text += "    ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += " & ";
      add_cell(text, row[i], columns[i], wording);
    }
    text += " \\\\\n";
  }
  return text + "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

std::string to_csv(const Table& table) {
  const auto& columns = table.columns();
  std::string text;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) text += ',';
    add_csv(text, header_text(columns[i]));
  }
  text += "\r\n";
  for (const Row& row : table.rows()) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      add_csv_cell(text, row[i]);
    }
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
