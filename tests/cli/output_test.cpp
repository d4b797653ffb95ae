#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <regex>

#include "harness/embedded.h"
#include "harness/record_reader.h"
#include "tests/cli/program_test.h"
#include "tests/harness/json_schema.h"

// What the program prints, word for word, against the files of tests/cli/golden. What differs from machine to
// machine is taken out first. LIEBENCH_UPDATE_GOLDEN=1 writes the files anew; read the difference before
// committing it.

namespace liebench {
namespace {

class OutputTest : public ProgramTest {
 protected:
  const std::filesystem::path golden = std::filesystem::path(LIEBENCH_SOURCE_DIR) / "tests/cli/golden";

  void expect_golden(const std::string& name, const std::string& text) const {
    if (const char* update = std::getenv("LIEBENCH_UPDATE_GOLDEN"); update != nullptr && *update != '\0') {
      std::ofstream(golden / name, std::ios::binary | std::ios::trunc) << text;
      GTEST_SKIP() << "wrote " << name;
    }
    ASSERT_TRUE(std::filesystem::exists(golden / name)) << golden / name;
    EXPECT_EQ(text, read_text(golden / name)) << "if this is meant: LIEBENCH_UPDATE_GOLDEN=1";
  }

  std::string output(std::vector<std::string> arguments) const {
    const ProgramResult result = run(std::move(arguments));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }

  std::string small_records() const { return (golden / "small.jsonl").string(); }
};

TEST_F(OutputTest, OfHelpIsAsExpected) {
  std::string text;
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{{},
                                                                                       {"figures"},
                                                                                       {"run"},
                                                                                       {"simulate"},
                                                                                       {"effects"},
                                                                                       {"check-problem"},
                                                                                       {"table"},
                                                                                       {"plot"},
                                                                                       {"compare"},
                                                                                       {"list"},
                                                                                       {"describe"}}) {
    std::vector<std::string> arguments = command;
    arguments.push_back("--help");
    text += fmt::format("$ liebench {}\n", fmt::join(arguments, " ")) + output(arguments);
  }
  // The default is the number of cores.
  expect_golden("help.txt", std::regex_replace(text, std::regex("(--jobs N[^\\n]*=)[0-9]+"), "$1#"));
}

TEST_F(OutputTest, OfHelpNamesEveryCommand) {
  const std::string text = output({"--help"});
  for (const char* command : {"figures", "run", "simulate", "effects", "check-problem", "table", "plot",
                              "compare", "list", "describe", "--version"})
    EXPECT_TRUE(contains(text, command)) << command;
}

TEST_F(OutputTest, OfVersionIsOneLineWithTheCommit) {
  EXPECT_TRUE(
      std::regex_match(output({"--version"}),
                       std::regex("liebench [0-9.]+ \\(([0-9a-f]{12}|unknown)(, changed)?, [^\\n]*\\)\\n")))
      << output({"--version"});
}

TEST_F(OutputTest, OfListIsAsExpected) {
  // What solvers from outside it was built with is the machine's.
  const std::string integrators =
      std::regex_replace(output({"list", "integrators"}), std::regex("; not in this build"), "");
  expect_golden("list.txt", "$ liebench list problems\n" + output({"list", "problems"}) +
                                "$ liebench list integrators\n" + integrators + "$ liebench list effects\n" +
                                output({"list", "effects"}));
}

TEST_F(OutputTest, OfDescribeIsAsExpected) {
  expect_golden("describe.txt", "$ liebench describe bliedf2nd\n" + output({"describe", "bliedf2nd"}) +
                                    "$ liebench describe heavy_top\n" + output({"describe", "heavy_top"}) +
                                    "$ liebench describe spring_damper\n" +
                                    output({"describe", "spring_damper"}));
}

TEST_F(OutputTest, OfDescribeHasTheSheetOfEveryIntegratorThatListNames) {
  int integrators = 0;
  for (const std::string& line : lines_of(output({"list", "integrators"}))) {
    const std::string name = line.substr(0, line.find(' '));
    const std::string text = output({"describe", name});
    EXPECT_TRUE(text.starts_with(name + ": ")) << text;
    // Solvers from outside have their own manuals.
    if (contains(line, "SUNDIALS")) continue;
    for (const char* part : {"\nSource: ", "\nUse it: ", "\nNot: "})
      EXPECT_TRUE(contains(text, part)) << text;
    ++integrators;
  }
  EXPECT_GE(integrators, 18);
}

TEST_F(OutputTest, OfCheckProblemIsAsExpected) {
  // Which entry of a law that holds is the worst is round-off's choice: laws and how many numbers they looked at.
  std::string text;
  for (const char* problem : {"heavy_top", "problems/scenes/chain_3.json"}) {
    const std::string name = *problem == 'h' ? problem : std::string(LIEBENCH_SOURCE_DIR) + "/" + problem;
    const Json check = parse_json(output({"check-problem", name, "--json"}), problem);
    for (const Json& entry : check.at("formulations")) {
      text += fmt::format("{}, {}\n", problem, entry.at("formulation").get<std::string>());
      for (const Json& law : entry.at("laws"))
        text += fmt::format("  {:<24} {:<6} {:>5}  {}\n", law.at("law").get<std::string>(),
                            law.at("holds").get<bool>() ? "holds" : "fails", law.at("compared").get<int>(),
                            law.at("formula").get<std::string>());
    }
  }
  expect_golden("check_problem.txt", text);
}

TEST_F(OutputTest, TheStudyThatDescribeShowsCanBeRun) {
  Json study = small_study();
  for (const auto& [list, name] : std::vector<std::pair<std::string, std::string>>{
           {"integrators", "bliedf2nd"}, {"problems", "heavy_top"}}) {
    const std::string text = output({"describe", name});
    const std::size_t begin = text.find("In a study:\n");
    ASSERT_NE(begin, std::string::npos) << text;
    study[list] = Json::array({parse_json(text.substr(begin + 12), name)});
  }
  write_study(study);
  const ProgramResult result = run({"run", "study.json"});
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(OutputTest, TheFixedRecordsAreRecordsOfToday) {
  const JsonSchema schema(embedded_file("record.schema.json"));
  for (const std::string& line : lines_of(read_text(small_records())))
    ASSERT_EQ(schema.violations(line), "") << line;
}

TEST_F(OutputTest, OfTableOrdersIsAsExpected) {
  expect_golden("orders.md", output({"table", small_records(), "--kind", "orders"}));
}

TEST_F(OutputTest, OfTableOrdersInLatexIsAsExpected) {
  expect_golden("orders.tex", output({"table", small_records(), "--kind", "orders", "--format", "latex"}));
}

TEST_F(OutputTest, OfTableOutcomesIsAsExpected) {
  expect_golden("outcomes.md", output({"table", small_records(), "--kind", "outcomes"}));
}

TEST_F(OutputTest, OfTableOutcomesInCsvIsAsExpected) {
  expect_golden("outcomes.csv", output({"table", small_records(), "--kind", "outcomes", "--format", "csv"}));
}

TEST_F(OutputTest, OfTableIsTheSameInAFile) {
  const ProgramResult result = run({"table", small_records(), "--kind", "outcomes", "--out", "t.md"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(read_text(folder / "t.md"), output({"table", small_records(), "--kind", "outcomes"}));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"t.md"});
}

// Six digits where a number means something; round-off, counts that hang on it and what the machine is are
// checked for sense and taken out.
void sanitise(Json& record) {
  EXPECT_LT(record["reference"]["error_estimate"].get<double>(), 1e-25);
  record["reference"]["error_estimate"] = 0.0;
  record["reference"]["method"] = std::regex_replace(record["reference"]["method"].get<std::string>(),
                                                     std::regex("[0-9.]+(e-[0-9]+)? away"), "# away");
  const auto six_digits = [](Json& value) { value = std::stod(fmt::format("{:.5e}", value.get<double>())); };
  if (record.contains("errors"))
    for (auto& component : record["errors"])
      for (auto& value : component) six_digits(value);
  if (record.contains("drift"))
    for (auto& value : record["drift"]) {
      if (value.get<double>() < 1e-9)
        value = 0.0;
      else
        six_digits(value);
    }
  if (record.contains("failure")) record["failure"].erase("residual");  // of an iteration that runs away
  const std::function<void(Json&)> without_counts = [&](Json& counts) {
    for (auto& value : counts) {
      if (value.is_object()) {
        without_counts(value);
      } else {
        EXPECT_TRUE(value.is_number_unsigned());
        value = 0;
      }
    }
  };
  without_counts(record["cost"]);
  for (const char* name : {"commit", "compiler", "flags", "cpu", "date"}) record["provenance"][name] = "#";
  record["provenance"]["dirty"] = false;
  record["provenance"]["libraries"].erase("sundials");  // of a build that has it
  for (auto& version : record["provenance"]["libraries"]) version = "#";
}

TEST_F(OutputTest, OfATinyRunIsAsExpected) {
  Json unconstrained = small_study(), constrained = small_study();
  unconstrained["problems"][0]["formulation"] = "SO3";
  unconstrained["step_sizes"] = {0.1, 0.005};  // half a turn in 0.1 s: the first fails
  constrained["problems"][0]["formulation"] = "R3xSO3";
  constrained["step_sizes"] = {0.005};
  std::string text;
  for (Json study : {unconstrained, constrained}) {
    study["t_end"] = 0.4;
    write_study(study);
    const ProgramResult result = run({"run", "study.json"});
    EXPECT_EQ(result.status, 0) << result.err;
    text += result.err;
    for (Json& record : records_of(result.out)) {
      sanitise(record);
      text += record.dump(2) + '\n';
    }
  }
  expect_golden("run.txt", text);
}

}  // namespace
}  // namespace liebench
