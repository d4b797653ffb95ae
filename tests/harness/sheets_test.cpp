#include "harness/sheets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include "harness/embedded.h"

namespace liebench {
namespace {

using ::testing::HasSubstr;

TEST(Sheets, AreThereForEveryIntegratorAndForNothingElse) {
  std::set<std::string> listed, written;
  for (const MethodInfo& method : methods()) {
    if (method.outside != nullptr) continue;
    listed.insert(std::string(method.name) + ".md");
    EXPECT_NO_THROW(sheet_of(method)) << method.name;
  }
  for (const std::string_view name : embedded_sheet_names()) written.emplace(name);
  EXPECT_EQ(written, listed) << "integrators/sheets";
}

std::string complaint(const std::string& text) {
  try {
    read_sheet(text, "mine.md");
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

TEST(Sheets, OfWhichAPartIsMissingAreRefusedByItsName) {
  const std::string definition = "    q_{n+1} = q_n o exp(h v~)\n";
  EXPECT_EQ(complaint(definition + "\nSource: a\n\nUse it: b\nand b\n\nNot: c\n"), "");
  EXPECT_THAT(complaint(definition + "\nUse it: b\n\nNot: c\n"),
              HasSubstr("mine.md has no paragraph that begins with \"Source: \""));
  EXPECT_THAT(complaint(definition + "\nSource: a\n\nNot: c\n\nUse it: b\n"),
              HasSubstr("\"Not: \" in its place"));
  EXPECT_THAT(complaint(definition + "\nSource: a\n\nUse it: \n\nNot: c\n"),
              HasSubstr("says nothing after \"Use it: \""));
  EXPECT_THAT(complaint("Words\n\nSource: a\n\nUse it: b\n\nNot: c\n"),
              HasSubstr("does not begin with a definition"));
}

TEST(Sheets, HaveThePartsOfTheirText) {
  const MethodSheet sheet =
      read_sheet("    one\n    two\n\nSource: a\n\nUse it: b\nand b\n\nNot: c\n", "mine.md");
  EXPECT_EQ(sheet.definition, "    one\n    two");
  EXPECT_EQ(sheet.source, "a");
  EXPECT_EQ(sheet.use, "b\nand b");
  EXPECT_EQ(sheet.avoid, "c");
}

// LIEBENCH_UPDATE_DOCS=1 writes it anew.
TEST(Sheets, AreThePageOfTheRepository) {
  const std::filesystem::path file = std::filesystem::path(LIEBENCH_SOURCE_DIR) / "docs/integrators.md";
  const std::string page = integrators_page();
  if (std::getenv("LIEBENCH_UPDATE_DOCS") != nullptr) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << page;
    GTEST_SKIP() << "wrote " << file;
  }
  std::ifstream stream(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), page)
      << "if this is meant: liebench describe integrators > docs/integrators.md";
}

}  // namespace
}  // namespace liebench
