#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

// One table object and three writers. What a table says is decided once; how it looks is the writer's
// business.

namespace liebench {

// What the cells of a column hold, and how the readable formats (Markdown, LaTeX) print them.
enum class ColumnKind {
  text,     // std::string
  integer,  // std::int64_t
  number,   // double, rounded to Column::digits significant digits; CSV has all digits
  mark      // bool: a tick or a cross, in CSV true or false
};

enum class Alignment { left, centre, right };

enum class Notation {
  automatic,  // scientific below 1e-4 and where the integer part has more places than there are digits, as
              // "%g"
  scientific  // always mantissa and exponent, so that a column of errors can be compared by eye
};

struct Column {
  std::string header;
  std::string unit{};  // plain text, printed in brackets after the header; empty for a pure number
  ColumnKind kind = ColumnKind::text;
  Alignment alignment = Alignment::left;
  int digits = 3;  // significant digits of a number, 1 to 17
  Notation notation = Notation::automatic;
};

// std::monostate is a cell whose quantity does not apply: a dash to a reader, an empty field in CSV.
using Cell = std::variant<std::monostate, std::string, std::int64_t, double, bool>;
using Row = std::vector<Cell>;

class Table {
 public:
  // Throws std::invalid_argument without columns, or where a column's digits are not 1 to 17.
  Table(std::string caption, std::vector<Column> columns);

  // Throws std::invalid_argument where the number of cells is not that of the columns, or a cell that is
  // present is not of its column's kind; the message names the row and the column. The table is then as
  // before.
  void add_row(Row row);

  const std::string& caption() const { return caption_; }
  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }

 private:
  std::string caption_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

enum class TableFormat { markdown, latex, csv };

// Markdown (GitHub's tables): the caption as a paragraph, then the table with its columns padded to equal
// width. Pipes and backslashes are escaped, line breaks become <br>; other markup in a text cell is left to
// work.
std::string to_markdown(const Table& table);

// LaTeX: a table environment with booktabs rules and siunitx numbers; a document needs the packages booktabs,
// siunitx and amssymb. Every character special to TeX is escaped; Greek letters and the common mathematical
// signs are translated, other characters beyond ASCII pass as UTF-8.
std::string to_latex(const Table& table);

// CSV by RFC 4180: comma, CRLF, quotes doubled; the first record is the headers, the caption is not written.
// A number is the shortest text that reads back as the same double; not-a-number and the infinities are nan,
// inf and -inf. An empty text is
// "" and an absent cell an empty field, save in a table of one column, where an empty line would be no
// record.
std::string to_csv(const Table& table);

std::string render(const Table& table, TableFormat format);

}  // namespace liebench
