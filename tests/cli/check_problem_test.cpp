#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/cli/program_test.h"

// Whether a problem's functions agree, as its author asks.

namespace liebench {
namespace {

class CheckProblemTest : public ProgramTest {
 protected:
  static std::filesystem::path scenes() {
    return std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems" / "scenes";
  }
  Json json_of(std::vector<std::string> arguments, int status) const {
    arguments.insert(arguments.begin(), "check-problem");
    arguments.emplace_back("--json");
    const ProgramResult result = run(std::move(arguments));
    EXPECT_EQ(result.status, status) << result.err;
    return parse_json(result.out, "check-problem");
  }
  static Json law_of(const Json& check, const std::string& name) {
    for (const Json& law : check.at("formulations").front().at("laws"))
      if (law.at("law") == name) return law;
    ADD_FAILURE() << "no law " << name;
    return {};
  }
  // A rod on a pin at the origin, with a velocity of its centre along x that a test chooses.
  void write_pendulum(double velocity) const {
    Json scene = parse_json(
        R"({"name": "pendulum",
            "bodies": [{"name": "rod", "mass": 1, "inertia": [0.01, 0.1, 0.1], "position": [0.5, 0, 0]}],
            "joints": [{"name": "pin", "type": "spherical", "bodies": ["ground", "rod"], "point": [0, 0, 0]}],
            "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]}]})",
        "pendulum");
    scene["bodies"][0]["velocity"] = {velocity, 0.0, 0.0};
    folder.write("pendulum.json", scene.dump());
  }
};

TEST_F(CheckProblemTest, TheListedProblemKeepsItsLawsInEveryFormulation) {
  const Json check = json_of({"heavy_top"}, 0);
  std::vector<std::string> names;
  for (const Json& entry : check.at("formulations")) {
    names.push_back(entry.at("formulation"));
    EXPECT_EQ(entry.at("holds"), true) << names.back();
    EXPECT_EQ(entry.at("differences"), "extended");
    // All laws where there are constraints; without them those that need none, and no blocks of M.
    EXPECT_EQ(entry.at("laws").size(), names.size() <= 2 ? 10u : 21u) << names.back();
  }
  EXPECT_EQ(names, (std::vector<std::string>{"SO3", "S3", "R3xSO3", "R3xS3", "SE3", "S3|xR3", "UDQ"}));
}

TEST_F(CheckProblemTest, EveryShippedSceneKeepsItsLaws) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scenes())) {
    const ProgramResult result = run({"check-problem", entry.path().string()});
    EXPECT_EQ(result.status, 0) << entry.path() << "\n" << result.err;
    EXPECT_FALSE(contains(result.err, "fails")) << result.err;
    ++files;
  }
  EXPECT_EQ(files, 16);
}

TEST_F(CheckProblemTest, EffectsWithoutAPotentialHaveTheirPower) {
  // Drive, motor, friction, drag, a load that depends on time, contact: what no energy accounts for.
  folder.write("driven.json", R"scene({"name": "driven",
    "bodies": [{"name": "crank", "mass": 1, "inertia": [0.1, 0.01, 0.1], "position": [0, 0.5, 0], "angular_velocity": [0, 0, 2],
                "velocity": [-1, 0, 0]},
               {"name": "ball", "mass": 2, "inertia": [0.02, 0.02, 0.02], "position": [3, 0, 0.04], "velocity": [1, 0, 0],
                "formulation": "SE3"},
               {"name": "wheel", "mass": 1, "inertia": [0.1, 0.1, 0.2], "position": [0, 0, 3]}],
    "joints": [{"name": "drive", "type": "revolute", "bodies": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1],
                "motion": {"polynomial": [0, 2]}},
               {"name": "axle", "type": "revolute", "bodies": ["ground", "wheel"], "point": [0, 0, 3], "axis": [0, 0, 1]}],
    "effects": [{"type": "uniform_gravity", "acceleration": [0, 0, -9.81]},
                {"type": "motor", "joint": "axle", "target": {"polynomial": [0.5, 1]}, "kp": 5, "kd": 1, "limit": 2},
                {"type": "joint_friction", "joint": "axle", "torque": 0.1, "slip_velocity": 0.01},
                {"type": "drag", "quadratic": 0.3, "angular_quadratic": 0.2},
                {"type": "applied_force", "body": "ball", "force": [1, 2, 0], "frame": "body", "factor": {"expression": "1+sin(t)"}},
                {"type": "contact", "body": "ball", "radius": 0.05, "plane": {"normal": [0, 0, 1]}, "stiffness": 2e4,
                 "exponent": 1.5, "damping": 2, "friction": 0.5, "slip_velocity": 0.01}]})scene");
  const ProgramResult result = run({"check-problem", "driven.json"});
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(CheckProblemTest, AVelocityThatTheJointsDoNotAllowIsNamedWithBothNumbers) {
  write_pendulum(0.5);
  const ProgramResult result = run({"check-problem", "pendulum.json"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  EXPECT_TRUE(contains(result.err,
                       "pendulum, scene: velocity_constraint fails in pin[0], initial values: 0.5 where 0 is "
                       "expected"))
      << result.err;
  const Json law = law_of(json_of({"pendulum.json"}, 1), "velocity_constraint");
  EXPECT_EQ(law.at("holds"), false);
  EXPECT_EQ(law.at("value"), 0.5);
  EXPECT_EQ(law.at("expected"), 0.0);
  EXPECT_EQ(law.at("row"), "pin[0]");
  EXPECT_EQ(law.at("point"), 0);
  EXPECT_LT(law.at("round_off").get<double>(), 1e-12);

  write_pendulum(0.0);
  EXPECT_EQ(run({"check-problem", "pendulum.json"}).status, 0);
}

TEST_F(CheckProblemTest, OnlyTheFormulationsThatAreNamedAreChecked) {
  const Json check = json_of({"heavy_top", "--formulation", "SE3,S3", "--parameters", R"({"mass": 2})"}, 0);
  ASSERT_EQ(check.at("formulations").size(), 2u);
  EXPECT_EQ(check["formulations"][0]["formulation"], "SE3");
  EXPECT_EQ(check["formulations"][1]["formulation"], "S3");
  EXPECT_EQ(check.at("parameters").at("mass"), 2.0);
  EXPECT_EQ(check.at("parameters").at("gravity"), Json({0, 0, -9.81}));
}

TEST_F(CheckProblemTest, TheTableHasTheSameLaws) {
  const ProgramResult table = run({"check-problem", "heavy_top", "--formulation", "UDQ", "--format", "csv"});
  ASSERT_EQ(table.status, 0) << table.err;
  const Json check = json_of({"heavy_top", "--formulation", "UDQ"}, 0);
  const auto lines = lines_of(table.out);
  const Json& laws = check.at("formulations").front().at("laws");
  ASSERT_EQ(lines.size(), laws.size() + 1);
  for (std::size_t i = 0; i < laws.size(); ++i)
    EXPECT_EQ(lines[i + 1].substr(0, lines[i + 1].find(',')), laws[i].at("law"));
}

TEST_F(CheckProblemTest, WrongInputIsRefused) {
  Json large = parse_json(R"({"name": "large", "bodies": []})", "large");
  for (int i = 0; i < 101; ++i)
    large["bodies"].push_back({{"name", "b" + std::to_string(i)}, {"mass", 1}, {"inertia", {1, 1, 1}}});
  folder.write("large.json", large.dump());
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  for (const Case& c : std::vector<Case>{
           {{"check-problem", "heavy_tp"},
            "unknown problem \"heavy_tp\"; allowed: \"heavy_top\" or \"orbiting_gyrostat\", or a scene"},
           {{"check-problem", "heavy_tp"}, "did you mean \"heavy_top\"?"},
           {{"check-problem", "nowhere.json"}, "nowhere.json"},
           {{"check-problem", "large.json"},
            "large.json: 606 velocities; a scene that is checked has at most 600"},
           {{"check-problem", "heavy_top", "--formulation", "SO4"},
            "--formulation: \"SO4\" is no formulation"},
           {{"check-problem", "heavy_top", "--parameters", R"({"mass": -2})"}, "--parameters /mass: -2"},
           {{"check-problem", "heavy_top", "--parameters", "{"}, "--parameters: not valid JSON"},
           {{"check-problem", "large.json", "--parameters", "{}"},
            "--parameters: is not allowed for a scene"},
       }) {
    const ProgramResult result = run(c.arguments);
    EXPECT_EQ(result.status, 2) << c.message << "\n" << result.err;
    EXPECT_TRUE(contains(result.err, c.message)) << c.message << "\n" << result.err;
    EXPECT_EQ(result.out, "") << c.message;
  }
}

}  // namespace
}  // namespace liebench
