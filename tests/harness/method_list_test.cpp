#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "harness/embedded.h"
#include "harness/figures.h"
#include "harness/methods.h"
#include "harness/stability/contestant.h"
#include "harness/study.h"

// What is listed (integrators/list.h) is measured, and what is there is listed.

namespace liebench {
namespace {

using Names = std::set<std::string>;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Of the program itself: solvers from outside are listed where they are.
Names listed() {
  Names names;
  for (const MethodInfo& method : methods())
    if (!method.outside) names.emplace(method.name);
  return names;
}

TEST(MethodList, HasEveryMethodThatAHeaderDefines) {
  const std::regex definition("static constexpr std::string_view name = \"([a-z0-9_]+)\"");
  Names defined;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(LIEBENCH_SOURCE_DIR) / "integrators")) {
    if (entry.path().extension() != ".h") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match)
      defined.insert((*match)[1]);
  }
  EXPECT_EQ(defined, listed()) << "a method is in integrators/ and not in integrators/list.h";
}

TEST(MethodList, IsWholeInTheVerification) {
  Names verified;
  for (const PaperFigure& figure : paper_figures())
    if (figure.name == "verification")
      for (const std::string_view file : figure.studies)
        for (const RunSpec& run : read_study(parse_json(embedded_file(file), std::string(file))).runs)
          verified.emplace(run.method->name);
  EXPECT_EQ(verified, listed()) << "harness/studies/verification_*.json";
}

TEST(MethodList, IsWholeInTheStudyOfTheField) {
  Names shown;
  for (const PaperFigure& figure : paper_figures())
    if (figure.name == "field")
      for (const std::string_view file : figure.studies)
        for (const RunSpec& run : read_study(parse_json(embedded_file(file), std::string(file))).runs)
          shown.emplace(run.method->name);
  EXPECT_EQ(shown, listed()) << "harness/studies/field_*.json";
}

TEST(MethodList, IsWholeInTheStabilitySuite) {
  Names tried;
  for (const Contestant& contestant : contestants(false)) tried.emplace(contestant.method->name);
  EXPECT_EQ(tried, listed()) << "harness/stability/contestant.cpp";
}

TEST(MethodList, IsWholeInTheBenchmarks) {
  std::string text;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(LIEBENCH_SOURCE_DIR) / "benchmarks"))
    if (entry.path().extension() == ".cpp") text += text_of(entry.path());
  for (const std::string& name : listed())
    EXPECT_NE(text.find('"' + name + '/'), std::string::npos) << name << " has no benchmark";
}

}  // namespace
}  // namespace liebench
