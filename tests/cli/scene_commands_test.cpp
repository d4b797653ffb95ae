#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/cli/program_test.h"

// Scenes as their users run them: one trajectory, what each effect costs, and scenes in studies.

namespace liebench {
namespace {

class SceneCommandsTest : public ProgramTest {
 protected:
  static std::string scene(const std::string& name) {
    return std::string(LIEBENCH_SOURCE_DIR) + "/problems/scenes/" + name + ".json";
  }
  static std::vector<double> numbers_of(const std::string& line) {
    std::vector<double> numbers;
    for (const char* place = line.c_str(); *place != '\0';) {
      char* end = nullptr;
      numbers.push_back(std::strtod(place, &end));
      place = *end == ',' ? end + 1 : end;
    }
    return numbers;
  }
  static std::size_t column_of(const std::string& header, const std::string& name) {
    std::size_t column = 0;
    std::string rest = header;
    while (rest.substr(0, rest.find(',')) != name) {
      if (rest.find(',') == std::string::npos) return std::string::npos;
      rest = rest.substr(rest.find(',') + 1);
      ++column;
    }
    return column;
  }
};

TEST_F(SceneCommandsTest, SimulateWritesTheTrajectoryAsCsv) {
  const ProgramResult result =
      run({"simulate", scene("slow_top"), "--h", "1e-3", "--t-end", "0.1", "--every", "10"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 12u);  // header, t = 0, 0.01, ..., 0.1
  const std::size_t energy = column_of(lines[0], "energy");
  const std::size_t constraint = column_of(lines[0], "position_constraint");
  ASSERT_NE(energy, std::string::npos) << lines[0];
  const auto first = numbers_of(lines[1]), last = numbers_of(lines.back());
  EXPECT_EQ(first[0], 0.0);
  EXPECT_NEAR(last[0], 0.1, 1e-15);
  // Weight and arm make 150 J, of which a step of h Omega = 0.0015 rad leaves much less than a thousandth.
  EXPECT_NEAR(last[energy], first[energy], 1e-3);
  EXPECT_LE(last[constraint], 1e-14);
}

TEST_F(SceneCommandsTest, SimulateByToleranceWritesTheStepsThatTheMethodChooses) {
  const auto rows = [&](const char* tolerance) {
    const ProgramResult result = run({"simulate", scene("slow_top"), "--integrator", "bliedf2nd_variable",
                                      "--tolerance", tolerance, "--t-end", "0.5"});
    EXPECT_EQ(result.status, 0) << result.err;
    return lines_of(result.out);
  };
  const auto coarse = rows("1e-4"), fine = rows("1e-7");
  EXPECT_GT(coarse.size(), 10u);
  EXPECT_GT(fine.size(), 2 * coarse.size());
  const std::size_t energy = column_of(fine[0], "energy");
  for (const auto& lines : {coarse, fine}) {
    EXPECT_EQ(numbers_of(lines[1])[0], 0.0);
    EXPECT_EQ(numbers_of(lines.back())[0], 0.5);
    for (std::size_t i = 2; i < lines.size(); ++i)
      EXPECT_GT(numbers_of(lines[i])[0], numbers_of(lines[i - 1])[0]) << i;
  }
  const auto drift = [&](const std::vector<std::string>& lines) {
    return std::abs(numbers_of(lines.back())[energy] - numbers_of(lines[1])[energy]);
  };
  EXPECT_LT(drift(fine), drift(coarse));
}

TEST_F(SceneCommandsTest, StepsAreGivenOrChosenByATolerance) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& what) {
    arguments.insert(arguments.begin(), {"simulate", scene("slow_top")});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(contains(result.err, what)) << result.err;
  };
  refused({"--integrator", "bliedf2nd_variable", "--h", "1e-3"},
          "--h: bliedf2nd_variable chooses its steps, by a tolerance");
  refused({"--tolerance", "1e-3"},
          "--tolerance: bliedf2nd takes the steps of --h and knows no tolerance; methods that choose their "
          "steps: "
          "\"bliedf2nd_variable\"");
  refused({"--integrator", "bliedf2nd_variable", "--tolerance", "1e-30"}, "below the round-off of double");
  refused({"--integrator", "bliedf2nd_variable", "--tolerance", "1e-6", "--option", "tolerance=1e-3"},
          "is given twice");
  const ProgramResult effects = run({"effects", scene("slow_top"), "--integrator", "bliedf2nd_variable"});
  EXPECT_EQ(effects.status, 2);
  EXPECT_TRUE(contains(effects.err, "chooses its steps")) << effects.err;
}

TEST_F(SceneCommandsTest, SimulateWritesJsonLinesOfTheSameNumbers) {
  const std::vector<std::string> common{"simulate", scene("double_pendulum"), "--h", "0.01", "--t-end", "0.1",
                                        "--option", "form=stabilized_index2"};
  auto csv = common, json = common;
  json.insert(json.end(), {"--format", "jsonl", "--out", "out.jsonl"});
  const ProgramResult text = run(csv);
  ASSERT_EQ(text.status, 0) << text.err;
  ASSERT_EQ(run(json).status, 0);
  const auto rows = records_of(read_text(folder / "out.jsonl"));
  const auto lines = lines_of(text.out);
  ASSERT_EQ(rows.size() + 1, lines.size());
  const std::size_t energy = column_of(lines[0], "energy");
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(rows[i].at("energy").get<double>(), numbers_of(lines[i + 1])[energy]) << i;
}

TEST_F(SceneCommandsTest, RedundantJointsAreNamed) {
  const ProgramResult result =
      run({"simulate", scene("bricard"), "--h", "0.01", "--t-end", "0.2", "--every", "20"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.err, "1 of the constraints of \"P5\"")) << result.err;
  EXPECT_FALSE(contains(result.err, "stopped")) << result.err;
}

TEST_F(SceneCommandsTest, ASceneThatCannotBeAssembledNamesTheJointAndItsGap) {
  folder.write("apart.json",
               R"({"name": "apart", "bodies": [{"name": "rod", "mass": 1, "inertia": [1, 1, 1]}],
    "joints": [{"name": "left", "type": "spherical", "bodies": ["ground", "rod"], "points": [[0, 0, 0], [1, 0, 0]]},
               {"name": "right", "type": "spherical", "bodies": ["ground", "rod"], "points": [[5, 0, 0], [-1, 0, 0]]}]})");
  const ProgramResult result = run({"simulate", "apart.json"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "apart.json") && contains(result.err, "cannot be assembled") &&
              contains(result.err, "gap of"))
      << result.err;
}

TEST_F(SceneCommandsTest, WrongOptionsAreRefusedBeforeAnythingRuns) {
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  for (const Case& c : std::vector<Case>{
           {{"simulate", "nowhere.json"}, "nowhere.json"},
           {{"simulate", scene("heavy_top"), "--integrator", "bliedf"}, "did you mean \"bliedf2nd\""},
           {{"simulate", scene("heavy_top"), "--option", "k=9"}, "an integer from 1 to 6"},
           {{"simulate", scene("heavy_top"), "--option", "l=2"}, "allowed: KEY=VALUE"},
           {{"simulate", scene("heavy_top"), "--h", "-1"},
            "--h: \"-1\" is not allowed; allowed: a positive number"},
           {{"simulate", scene("bushing_body"), "--integrator", "cvode_bdf"},
            "cvode_bdf runs in studies alone (liebench run). What fits here: \"bliedf2nd\""},
           {{"simulate", scene("heavy_top"), "--h", "1e-12"}, "at most"},
       }) {
    const ProgramResult result = run(c.arguments);
    EXPECT_EQ(result.status, 2) << c.message;
    EXPECT_TRUE(contains(result.err, c.message)) << c.message << "\n" << result.err;
    EXPECT_EQ(result.out, "") << c.message;
  }
}

TEST_F(SceneCommandsTest, EffectsSayWhatTheyCostAndChange) {
  const ProgramResult result = run({"effects", scene("double_pendulum"), "--h", "0.01", "--t-end", "0.2",
                                    "--format", "csv", "--picture", "effects.svg"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_GE(lines.size(), 3u);
  EXPECT_TRUE(contains(lines[1], "nothing"));
  EXPECT_TRUE(contains(result.out, "uniform_gravity"));
  EXPECT_TRUE(contains(read_text(folder / "effects.svg"), "uniform_gravity"));
}

TEST_F(SceneCommandsTest, AnEffectThatIsSwitchedOffLeavesNoTrace) {
  // The same bytes and the same counts as of the scene that does not name it.
  const std::string start =
      R"({"name": "swing", "bodies": [{"name": "bob", "mass": 2, "inertia": [0.1, 0.2, 0.3],
    "position": [1, 0, 0], "angular_velocity": [0.1, 0.2, 0.3]}],
    "joints": [{"name": "pin", "type": "spherical", "bodies": ["ground", "bob"], "point": [0, 0, 0]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]})";
  folder.write("without.json", start + "]}");
  folder.write("off.json", start + R"(, {"type": "drag", "bodies": ["bob"], "linear": 3, "enabled": false},
    {"type": "spring_damper", "bodies": ["ground", "bob"], "points": [[0, 0, 2], [0, 0, 0]], "stiffness": 10,
     "damping": 1, "rest_length": 1, "enabled": false}]})");
  folder.write("on.json", start + R"(, {"type": "drag", "bodies": ["bob"], "linear": 3}]})");
  const auto trajectory = [&](const std::string& file) {
    const ProgramResult result = run({"simulate", file, "--h", "0.01", "--t-end", "0.3"});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  EXPECT_EQ(trajectory("off.json"), trajectory("without.json"));
  EXPECT_NE(trajectory("on.json"), trajectory("without.json"));
  const auto cost = [&](const std::string& file) {
    Json study = small_study();
    study["problems"] = Json::array({{{"scene", file}}});
    study["t_end"] = 0.1;
    write_study(study);
    const ProgramResult result = run({"run", "study.json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return records_of(result.out).front().at("cost");
  };
  EXPECT_EQ(cost("off.json"), cost("without.json"));
}

TEST_F(SceneCommandsTest, AStudyOfASceneConverges) {
  Json study;
  study["name"] = "scene";
  study["problems"] = Json::array({{{"scene", scene("kovalevskaya_top")}}});
  study["integrators"] = Json::array({{{"name", "bliedf2nd"}, {"k", 3}}, {{"name", "generalized_alpha"}}});
  study["step_sizes"] = {0.01, 0.005, 0.0025};
  study["t_end"] = 0.5;
  write_study(study);
  const ProgramResult result = run({"run", "study.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto records = records_of(result.out);
  ASSERT_EQ(records.size(), 6u);
  for (const std::size_t first : {0u, 3u}) {
    EXPECT_EQ(records[first].at("problem"), "kovalevskaya_top");
    EXPECT_LE(records[first].at("reference").at("error_estimate").get<double>(), 1e-12);
    const auto error = [&](std::size_t i) {
      return records[first + i].at("errors").at("q").at("end_relative").get<double>();
    };
    const double order = first == 0 ? 3.0 : 2.0;
    EXPECT_NEAR(std::log2(error(1) / error(2)), order, 0.4) << records[first].at("integrator");
  }
}

// The double pendulum of Kane & Levinson: its motion is known for a second or two, and no end says anything after that.
TEST_F(SceneCommandsTest, AChaoticSceneIsComparedByInvariantsAndByTheTimeToWhichItAgrees) {
#ifdef LIEBENCH_SANITIZED
  GTEST_SKIP() << "too long under sanitizers: a reference of 20,000 steps in 106 bits";
#endif
  Json study;
  study["name"] = "chaos";
  study["problems"] = Json::array({{{"scene", scene("double_pendulum")}}});
  study["integrators"] = Json::array({{{"name", "bliedf2nd"}, {"k", 2}, {"form", "stabilized_index2"}}});
  study["step_sizes"] = {0.01, 0.0025};
  study["t_end"] = 4;
  write_study(study);
  const ProgramResult result = run({"run", "study.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto records = records_of(result.out);
  ASSERT_EQ(records.size(), 2u);
  std::vector<double> agreement;
  for (const Json& record : records) {
    EXPECT_EQ(record.at("outcome"), "ok");
    EXPECT_FALSE(record.contains("errors"));
    EXPECT_LT(record.at("drift").at("position_constraint").get<double>(), 1e-12);
    agreement.push_back(record.at("agreement_time").get<double>());
  }
  // Smaller steps agree for longer, but not for ever.
  EXPECT_GT(agreement[0], 0.1);
  EXPECT_GT(agreement[1], agreement[0]);
  EXPECT_LT(agreement[0], 4.0);
  folder.write("chaos.jsonl", result.out);
  const ProgramResult table = run({"table", "chaos.jsonl", "--kind", "invariants"});
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_TRUE(contains(table.out, "agrees to t")) << table.out;
  EXPECT_TRUE(contains(table.out, "position constraint")) << table.out;
  const ProgramResult costs = run({"table", "chaos.jsonl", "--kind", "costs"});
  EXPECT_EQ(costs.status, 0) << costs.err;
}

}  // namespace
}  // namespace liebench
