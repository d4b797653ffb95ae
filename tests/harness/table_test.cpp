#include "harness/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

namespace liebench {
namespace {

Table orders() {
  Table table("Orders of q, 100 % of the runs",
              {{.header = "method", .unit = "", .kind = ColumnKind::text},
               {.header = "k", .unit = "", .kind = ColumnKind::integer, .alignment = Alignment::right},
               {.header = "h",
                .unit = "s",
                .kind = ColumnKind::number,
                .alignment = Alignment::right,
                .digits = 2,
                .notation = Notation::scientific},
               {.header = "order",
                .unit = "",
                .kind = ColumnKind::number,
                .alignment = Alignment::right,
                .digits = 4},
               {.header = "met", .unit = "", .kind = ColumnKind::mark, .alignment = Alignment::centre}});
  table.add_row({"generalized_alpha", 2, 1e-3, 1.99951, true});
  table.add_row({"a|b & c", -12345, 2.5e-5, std::monostate{}, false});
  table.add_row({std::monostate{}, std::monostate{}, std::monostate{}, 0.1, std::monostate{}});
  return table;
}

Table one_number(double value, int digits, Notation notation = Notation::automatic) {
  Table table(
      "", {{.header = "x", .unit = "", .kind = ColumnKind::number, .digits = digits, .notation = notation}});
  table.add_row({value});
  return table;
}

std::string printed(double value, int digits, Notation notation = Notation::automatic) {
  const std::string text = to_markdown(one_number(value, digits, notation));
  const std::size_t begin = text.rfind("\n| ") + 3;
  return text.substr(begin, text.find(' ', begin) - begin);
}

TEST(TableMarkdown, PadsColumnsAndEscapesPipes) {
  EXPECT_EQ(to_markdown(orders()),
            "Orders of q, 100 % of the runs\n"
            "\n"
            "| method            |      k |  h [s] |  order | met |\n"
            "| ----------------- | -----: | -----: | -----: | :-: |\n"
            "| generalized_alpha |      2 | 1.0e-3 |  2.000 |  ✓  |\n"
            "| a\\|b & c          | -12345 | 2.5e-5 |      – |  ✗  |\n"
            "| –                 |      – |      – | 0.1000 |  –  |\n");
}

TEST(TableMarkdown, TextKeepsToOneLineAndOneCell) {
  Table table("", {{.header = "λ|", .unit = "N m"}});
  table.add_row({"two\r\nlines \\| 1"});
  EXPECT_EQ(to_markdown(table),
            "| λ\\| [N m]           |\n"
            "| ------------------- |\n"
            "| two<br>lines \\\\\\| 1 |\n");
}

TEST(TableLatex, HasRulesNumbersAndEscapes) {
  EXPECT_EQ(to_latex(orders()),
            "% needs \\usepackage{booktabs,siunitx,amssymb}\n"
            "\\begin{table}\n"
            "  \\centering\n"
            "  \\caption{Orders of q, 100 \\% of the runs}\n"
            "  \\begin{tabular}{lrrrc}\n"
            "    \\toprule\n"
            "    method & k & h {[}s{]} & order & met \\\\\n"
            "    \\midrule\n"
            "    generalized\\_alpha & \\num{2} & \\num{1.0e-3} & \\num{2.000} & $\\checkmark$ \\\\\n"
            "    a\\textbar{}b \\& c & \\num{-12345} & \\num{2.5e-5} & -- & $\\times$ \\\\\n"
            "    -- & -- & -- & \\num{0.1000} & -- \\\\\n"
            "    \\bottomrule\n"
            "  \\end{tabular}\n"
            "\\end{table}\n");
}

Table every_special_character() {
  Table table("", {{.header = "ω·λ", .unit = ""}});
  table.add_row({"[\\ { } $ & # _ % ~ ^ < > |\n≤ h²"});
  return table;
}

TEST(TableLatex, EscapesEveryCharacterSpecialToTex) {
  const std::string text = to_latex(every_special_character());
  EXPECT_NE(text.find("    $\\omega$$\\cdot$$\\lambda$ \\\\\n"), std::string::npos) << text;
  EXPECT_NE(
      text.find("    {[}\\textbackslash{} \\{ \\} \\$ \\& \\# \\_ \\% \\textasciitilde{} \\textasciicircum{} "
                "\\textless{} \\textgreater{} \\textbar{} $\\le$ h$^2$ \\\\\n"),
      std::string::npos)
      << text;
}

TEST(TableCsv, FollowsRfc4180WithAllDigits) {
  EXPECT_EQ(to_csv(orders()),
            "method,k,h [s],order,met\r\n"
            "generalized_alpha,2,0.001,1.99951,true\r\n"
            "a|b & c,-12345,2.5e-05,,false\r\n"
            ",,,0.1,\r\n");
}

TEST(TableCsv, QuotesWhatWouldBeReadOtherwise) {
  Table table("", {{.header = "a,b", .unit = ""}, {.header = "c", .unit = ""}});
  table.add_row({"say \"h\"", "two\r\nlines"});
  table.add_row({"", std::monostate{}});
  EXPECT_EQ(to_csv(table), "\"a,b\",c\r\n\"say \"\"h\"\"\",\"two\r\nlines\"\r\n\"\",\r\n");
}

TEST(TableCsv, HasNoEmptyLine) {
  Table table("", {{.header = "x", .unit = "", .kind = ColumnKind::number}});
  table.add_row({std::monostate{}});
  EXPECT_EQ(to_csv(table), "x\r\n\"\"\r\n");
}

TEST(TableCsv, NumbersReadBackAsTheSameDouble) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::pow(10, exponent(random));
    const std::string text = to_csv(one_number(value, 3));
    EXPECT_EQ(std::strtod(text.c_str() + 3, nullptr), value) << text;
  }
}

TEST(TableNumber, KeepsSignificantDigitsThroughRounding) {
  EXPECT_EQ(printed(9.996, 3), "10.0");
  EXPECT_EQ(printed(0.00012344, 3), "0.000123");
  EXPECT_EQ(printed(0.00009996, 3), "0.000100");
  EXPECT_EQ(printed(0.00001, 3), "1.00e-5");
  EXPECT_EQ(printed(150, 3), "150");
  EXPECT_EQ(printed(1500, 3), "1.50e3");
  EXPECT_EQ(printed(-2.5, 1, Notation::scientific), "-2e0");  // a tie goes to the even digit
  EXPECT_EQ(printed(0, 3), "0.00");
  EXPECT_EQ(printed(6.02214076e23, 9, Notation::scientific), "6.02214076e23");
}

TEST(TableNumber, NamesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(printed(nan, 3), "NaN");
  EXPECT_EQ(printed(-infinity, 3), "-∞");
  EXPECT_EQ(to_csv(one_number(-nan, 3)), "x\r\nnan\r\n");
  EXPECT_EQ(to_csv(one_number(-infinity, 3)), "x\r\n-inf\r\n");
  EXPECT_NE(to_latex(one_number(infinity, 3)).find("    $\\infty$ \\\\\n"), std::string::npos);
}

TEST(Table, RefusesACellOfAnotherKindAndStaysAsItWas) {
  Table table = orders();
  EXPECT_THROW(table.add_row({"x", 1, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(table.add_row({"x", 1.0, 1.0, 1.0, true}), std::invalid_argument);
  EXPECT_THROW(table.add_row({true, 1, 1.0, 1.0, true}), std::invalid_argument);
  try {
    table.add_row({"x", 1, 1.0, 1, true});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "row 4, column \"order\": the cell is not of the column's kind");
  }
  EXPECT_EQ(table.rows().size(), 3U);
}

TEST(Table, RefusesColumnsThatCannotBePrinted) {
  EXPECT_THROW(Table("", {}), std::invalid_argument);
  EXPECT_THROW(one_number(1, 0), std::invalid_argument);
  EXPECT_THROW(one_number(1, 18), std::invalid_argument);
}

TEST(Table, WithoutRowsIsItsHeaders) {
  const Table table("", {{.header = "x", .unit = "s"}});
  EXPECT_EQ(render(table, TableFormat::markdown), "| x [s] |\n| ----- |\n");
  EXPECT_EQ(render(table, TableFormat::csv), "x [s]\r\n");
  EXPECT_EQ(render(table, TableFormat::latex), to_latex(table));
}

// The tests above fix the text; this one adds that TeX itself takes it, where there is a TeX.
TEST(TableLatex, CompilesWhereThereIsATex) {
  if (std::system("pdflatex --version > /dev/null 2>&1 && kpsewhich siunitx.sty > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no pdflatex with siunitx; the text itself is compared in the other tests";
  }
  const auto folder = std::filesystem::path(testing::TempDir()) / "liebench_table_test_latex";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "table.tex")
      << "\\documentclass{article}\n\\usepackage[utf8]{inputenc}\n"
      << "\\usepackage{booktabs,siunitx,amssymb}\n\\begin{document}\n"
      << to_latex(orders()) << to_latex(every_special_character()) << "\\end{document}\n";
  const std::string command =
      "cd '" + folder.string() +
      "' && pdflatex -interaction=nonstopmode -halt-on-error table.tex > output.txt 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "see " << (folder / "output.txt");
}

}  // namespace
}  // namespace liebench
