#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

// Pages that print a file print it as it is: a line `<!-- FILE -->` before the block says which. LIEBENCH_UPDATE_DOCS=1 writes them anew.

namespace liebench {
namespace {

const std::filesystem::path root = LIEBENCH_SOURCE_DIR;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PrintedCode, IsThatOfItsFile) {
  const bool update = std::getenv("LIEBENCH_UPDATE_DOCS") != nullptr;
  const std::regex opening("<!-- ([^ ]+) -->\n```(?:cpp|text)\n");
  int blocks = 0;
  for (const auto& entry : std::filesystem::directory_iterator(root / "docs")) {
    if (entry.path().extension() != ".md") continue;
    const std::string page = text_of(entry.path());
    std::string renewed;
    auto from = page.cbegin();
    std::smatch match;
    while (std::regex_search(from, page.cend(), match, opening)) {
      const auto begin = match[0].second;
      const std::size_t end = page.find("```\n", std::size_t(begin - page.cbegin()));
      ASSERT_NE(end, std::string::npos) << entry.path();
      const std::string code = text_of(root / match[1].str());
      if (!update) {
        EXPECT_EQ(std::string(begin, page.cbegin() + std::ptrdiff_t(end)), code)
            << entry.path() << ": " << match[1] << " has changed";
      }
      renewed.append(from, begin);
      renewed += code;
      from = page.cbegin() + std::ptrdiff_t(end);
      ++blocks;
    }
    renewed.append(from, page.cend());
    if (update && renewed != page) std::ofstream(entry.path()) << renewed;
  }
  EXPECT_GE(blocks, 6);
}

}  // namespace
}  // namespace liebench
