#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "harness/errors.h"
#include "tests/harness/sample_scenes.h"

namespace liebench {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// What is wrong, and what the message says: the place, and what would be right. The schema refuses what it can know.

struct BadScene {
  Json scene;
  std::vector<std::string> says;
  bool schema_knows = true;
};

void expect_refused(const std::vector<BadScene>& list) {
  for (const BadScene& bad : list) {
    const std::string error = scene_error(bad.scene);
    for (const std::string& part : bad.says) EXPECT_THAT(error, HasSubstr(part));
    EXPECT_EQ(scene_schema().violations(bad.scene.dump()).empty(), !bad.schema_knows) << error;
  }
}

TEST(SceneReaderErrors, RefusesBodiesThatCannotBe) {
  const std::string positive = "a positive number from 1e-30 to 1e+30";
  expect_refused({
      {changed_scene("/bodies/1/name", "\"crank\""),
       {"/bodies/1/name", "a name that no other body has"},
       false},
      {changed_scene("/bodies/0/name", "\"ground\""),
       {"/bodies/0/name", "other than that of the ground"},
       false},
      {changed_scene("/bodies/0/name", "\"\""), {"/bodies/0/name", "a name of 1 to 64"}},
      {changed_scene("/bodies/0/name", "\"a,b\""), {"/bodies/0/name", "a name of 1 to 64"}},
      {changed_scene("/bodies/0/name", ""), {"/bodies/0/name: is missing"}},
      {changed_scene("/bodies", "[]"), {"/bodies", "at least one element"}},
      {changed_scene("/bodies/0/mass", "0"), {"/bodies/0/mass: 0 is not allowed", positive}},
      {changed_scene("/bodies/0/mass", "-2"), {"/bodies/0/mass: -2 is not allowed", positive}},
      {changed_scene("/bodies/0/mass", "1e300"), {"/bodies/0/mass", positive}},
      {changed_scene("/bodies/0/mass", "\"2 kg\""), {"/bodies/0/mass", positive}},
      {changed_scene("/bodies/0/mass", ""), {"/bodies/0/mass: is missing"}},
      {changed_scene("/bodies/0/inertia", "[1, 1, 3]"), {"/bodies/0/inertia", "none exceeds the sum"}, false},
      {changed_scene("/bodies/0/inertia", "[1, -1, 1]"), {"/bodies/0/inertia", "positive definite"}},
      {changed_scene("/bodies/0/inertia", "[0, 1, 1]"), {"/bodies/0/inertia", "3 positive principal"}},
      {changed_scene("/bodies/0/inertia", "[[1,2,0],[2,1,0],[0,0,1]]"),
       {"/bodies/0/inertia", "definite"},
       false},
      {changed_scene("/bodies/0/inertia", "[[1,0.1,0],[0.2,1,0],[0,0,1]]"),
       {"/bodies/0/inertia", "symmetric"},
       false},
      {changed_scene("/bodies/0/inertia", "[1, 1]"), {"/bodies/0/inertia", "3 principal moments"}},
      {changed_scene("/bodies/0/inertia", ""), {"/bodies/0", "\"inertia\" or \"shape\""}},
      {changed_scene("/bodies/0/shape", R"({"type": "sphere", "radius": 1})"),
       {"/bodies/0/shape", "not both"}},
      {changed_scene("/bodies/1/mass", "1"), {"/bodies/1", "either \"mass\" or the \"density\""}},
      {changed_scene("/bodies/1/shape/density", ""), {"/bodies/1", "either \"mass\" or the \"density\""}},
      {changed_scene("/bodies/1/shape/type", "\"rods\""),
       {"unknown shape \"rods\"", "did you mean \"rod\"?"}},
      {changed_scene("/bodies/1/shape/width", "0"), {"/bodies/1/shape/width", positive}},
      {changed_scene("/bodies/1/shape/size", "1"), {"/bodies/1/shape/size: unknown key"}},
      {changed_scene("/bodies/0/orientation", "[0, 0, 0, 0]"), {"/bodies/0/orientation", "not all zero"}},
      {changed_scene("/bodies/0/orientation", "[1, 0, 0]"), {"/bodies/0/orientation", "4 numbers"}},
      {changed_scene("/bodies/1/orientation", "[1, 0, 0, 0]"), {"/bodies/1/rotation", "not both"}},
      {changed_scene("/bodies/1/rotation/axis", "[0, 0, 0]"), {"/bodies/1/rotation/axis", "not all zero"}},
      {changed_scene("/bodies/1/rotation/angle", ""), {"/bodies/1/rotation/angle: is missing"}},
      {changed_scene("/bodies/0/position", "[1, 0]"), {"/bodies/0/position", "a list of 3 numbers"}},
      {changed_scene("/bodies/0/velocity/0", "1"), {"/bodies/0/velocity", "a list of 3 numbers"}},
      {changed_scene("/bodies/0/formulation", "\"SO(3)\""), {"unknown formulation", "did you mean \"SO3\"?"}},
      {changed_scene("/bodies/0/formulation", "\"SO3\""), {"/bodies/0/fixed_point: is missing"}},
      {changed_scene("/bodies/0/fixed_point", "[0, 0, 0]"), {"/bodies/0/fixed_point", "leave it out"}},
      {changed_scene("/bodies/2/inertia", "[1, 1, 1]"), {"/bodies/2/inertia", "a point mass"}},
      {changed_scene("/bodies/0/gyroscopic", "1"), {"/bodies/0/gyroscopic", "true or false"}},
      {changed_scene("/bodies/0/massa", "1"), {"/bodies/0/massa: unknown key", "did you mean \"mass\"?"}},
      {changed_scene("/bodies/0", "3"), {"/bodies/0", "an object with the keys"}},
  });
}

TEST(SceneReaderErrors, RefusesAFixedPointBodyWithAVelocity) {
  Json json = changed_scene("/bodies/0/formulation", "\"SO3\"");
  json["bodies"][0]["fixed_point"] = {0, 0, 0};
  json["bodies"][0]["velocity"] = {0, 0, 0};
  expect_refused({{json, {"/bodies/0/velocity", "follows from"}}});
}

TEST(SceneReaderErrors, RefusesJointsThatCannotBe) {
  expect_refused({
      {changed_scene("/joints/0/bodies", "[\"ground\", \"crnak\"]"),
       {"/joints/0/bodies/1: unknown body \"crnak\"", "\"rod\"", "or \"ground\"", "did you mean \"crank\"?"},
       false},
      {changed_scene("/joints/0/bodies", "[\"crank\", \"crank\"]"), {"/joints/0/bodies", "not the same"}},
      {changed_scene("/joints/0/bodies", "[\"ground\", \"ground\"]"), {"/joints/0/bodies", "not the same"}},
      {changed_scene("/joints/0/bodies", "[\"crank\"]"), {"/joints/0/bodies", "a list of two bodies"}},
      {changed_scene("/joints/0/bodies", "[1, 2]"), {"/joints/0/bodies/0", "a text"}},
      {changed_scene("/joints/0/type", "\"revolut\""), {"unknown joint", "did you mean \"revolute\"?"}},
      {changed_scene("/joints/0/type", ""), {"/joints/0/type: is missing"}},
      {changed_scene("/joints/0/axis", "[0, 0, 0]"), {"/joints/0/axis", "not all zero"}},
      {changed_scene("/joints/0/axis", ""), {"/joints/0", "\"axis\" or \"axes\""}},
      {changed_scene("/joints/0/axes", "[[1,0,0],[1,0,0]]"), {"/joints/0/axes", "not both"}},
      {changed_scene("/joints/0/points", "[[1,0,0],[1,0,0]]"), {"/joints/0/points", "not both"}},
      {changed_scene("/joints/0/point", ""), {"/joints/0", "\"point\" or \"points\""}},
      {changed_scene("/joints/0/normal", "[0,0,1]"), {"/joints/0/normal: unknown key"}},
      {changed_scene("/joints/1/name", "\"hinge\""), {"/joints/1/name", "no other joint has"}, false},
      {changed_scene("/joints/0/motion", "{}"), {"/joints/0/motion", "\"polynomial\", \"sines\" or both"}},
      {changed_scene("/joints/0/motion", R"({"polynomial": []})"),
       {"/joints/0/motion/polynomial", "1 to 20"}},
      {changed_scene("/joints/0/motion", R"({"sines": [{"amplitude": 1}]})"),
       {"/joints/0/motion/sines/0/angular_frequency: is missing"}},
      {changed_scene("/joints", "{}"), {"/joints", "a list"}},
      {with_joint(R"({"type": "distance", "bodies": ["ground", "bead"], "points": [[3, 0, 0], [0, 0, 0]]})"),
       {"/joints/2/points", "two points apart"},
       false},
      {with_joint(R"({"type": "distance", "bodies": ["ground", "bead"], "point": [3, 0, 0]})"),
       {"/joints/2/point: unknown key"}},
      {with_joint(R"({"type": "universal", "bodies": ["ground", "rod"], "point": [3, 0, 0]})"),
       {"/joints/2/axes: is missing"}},
      {with_joint(R"({"type": "planar", "bodies": ["ground", "rod"], "point": [3, 0, 0]})"),
       {"/joints/2/normal: is missing"}},
      {with_joint(R"({"type": "fixed", "bodies": ["ground", "bead"]})"),
       {"/joints/2/bodies", "point mass"},
       false},
      {with_joint(R"({"type": "spherical", "bodies": ["ground", "bead"], "point": [0, 0, 0], "motion": {}})"),
       {"/joints/2/motion: unknown key"}},
  });
}

TEST(SceneReaderErrors, RefusesEffectsThatCannotBe) {
  const auto force = [](const std::string& more) {
    return with_effect(R"({"type": "applied_force", "body": "rod", "force": [1, 0, 0], )" + more + "}");
  };
  expect_refused({
      {with_effect(R"({"type": "uniform_gravty"})"), {"unknown effect", "did you mean \"uniform_gravity\"?"}},
      {with_effect("{}"), {"/effects/2/type: is missing"}},
      {with_effect("7"), {"/effects/2", "an object with the key \"type\""}},
      {changed_scene("/effects/0/acceleration", ""), {"/effects/0/acceleration: is missing"}},
      {changed_scene("/effects/0/bodies", "[]"), {"/effects/0/bodies", "at least one"}},
      {changed_scene("/effects/0/bodies", "[\"ground\"]"), {"/effects/0/bodies/0: unknown body"}, false},
      {changed_scene("/effects/0/bodies", "[\"rod\", \"rod\"]"), {"/effects/0/bodies/1", "each body once"}},
      {changed_scene("/effects/0/enabled", "0"), {"/effects/0/enabled", "true or false"}},
      {changed_scene("/effects/0/gravity", "0"), {"/effects/0/gravity: unknown key"}},
      {changed_scene("/effects/1/stiffness", "-1"), {"/effects/1/stiffness", "from 0"}},
      {changed_scene("/effects/1/points/0", "[3, 0, 0]"), {"/effects/1/points", "two points apart"}, false},
      {with_effect(R"({"type": "point_gravity", "gravitational_parameter": 1, "center": [1, 0, 0]})"),
       {"/effects/2", "\"crank\" is there"},
       false},
      {with_effect(R"({"type": "torsional_spring", "joint": "hnige", "stiffness": 1})"),
       {"/effects/2/joint: unknown joint \"hnige\"", "did you mean \"hinge\"?"},
       false},
      {with_effect(R"({"type": "torsional_spring", "joint": "guide", "stiffness": 1})"),
       {"/effects/2/joint", "a revolute joint"},
       false},
      {with_effect(R"({"type": "bushing", "bodies": ["ground", "rod"], "point": [0,0,0], "stiffness": 1})"),
       {"/effects/2/stiffness", "3 numbers"}},
      {with_effect(
           R"({"type": "bushing", "bodies": ["ground", "bead"], "point": [0,0,0], "stiffness": [1,1,1]})"),
       {"/effects/2/bodies", "point mass"},
       false},
      {with_effect(R"({"type": "drag", "linear": -1})"), {"/effects/2/linear", "from 0"}},
      {with_effect(R"({"type": "applied_force", "body": "rod"})"), {"/effects/2", "\"torque\" or both"}},
      {with_effect(R"({"type": "applied_force", "body": "bead", "torque": [0, 0, 1]})"),
       {"/effects/2/torque", "point mass"},
       false},
      {force(R"("frame": "world")"), {"/effects/2/frame: unknown frame \"world\""}},
      {force(R"("factor": "2*t")"), {"/effects/2/factor", "{\"expression\": \"...\"}"}},
      {force(R"("factor": {})"), {"/effects/2/factor", "\"table\" or \"expression\""}},
      {force(R"("factor": {"table": [[0, 1], [0, 2]]})"),
       {"/effects/2/factor/table/1/0", "a time after"},
       false},
      {force(R"("factor": {"table": [[0, 1, 2]]})"), {"/effects/2/factor/table/0", "a pair"}},
      {force(R"("factor": {"expression": "sin(2*t"})"),
       {"/effects/2/factor/expression", "the time t"},
       false},
      {force(R"("factor": {"expression": "2*x"})"), {"/effects/2/factor/expression", "x"}, false},
      {force(R"("factor": {"expression": "1/t"})"), {"/effects/2/factor/expression", "finite"}, false},
      {force(R"("factor": {"expression": ""})"), {"/effects/2/factor/expression", "1 to 1000 characters"}},
      {with_effect(R"({"type": "motor", "joint": "hinge", "kp": 1})"), {"/effects/2/target: is missing"}},
      {with_effect(
           R"({"type": "motor", "joint": "hinge", "kp": 1, "target": {"polynomial": [1]}, "limit": 0})"),
       {"/effects/2/limit", "a positive number"}},
      {with_effect(R"({"type": "joint_friction", "joint": "hinge", "force": 1, "slip_velocity": 1})"),
       {"/effects/2/force", "takes \"torque\""},
       false},
      {with_effect(R"({"type": "joint_friction", "joint": "hinge", "torque": 1})"),
       {"/effects/2/slip_velocity: is missing"}},
      {with_effect(
           R"({"type": "contact", "body": "rod", "radius": 1, "stiffness": 1, "plane": {"normal": [0,0,0]}})"),
       {"/effects/2/plane/normal", "not all zero"}},
      {with_effect(
           R"({"type": "contact", "body": "rod", "radius": 1, "stiffness": 1, "plane": {"normal": [0,0,1]},
                       "exponent": 2})"),
       {"/effects/2/exponent", "1 or 1.5"}},
      {with_effect(
           R"({"type": "contact", "body": "rod", "radius": 1, "stiffness": 1, "plane": {"normal": [0,0,1]},
                       "friction": 0.5})"),
       {"/effects/2/slip_velocity: is missing"}},
      {with_effect(R"({"type": "gyroscopic", "bodies": ["bead"], "enabled": false})"),
       {"/effects/2/bodies", "point mass"},
       false},
  });
}

TEST(SceneReaderErrors, RefusesTwoEffectsOfOneName) {
  Json json = changed_scene("/effects/0/name", "\"pull\"");
  json["effects"][1]["name"] = "pull";
  expect_refused({{json, {"/effects/1/name", "no other effect has"}, false}});
}

TEST(SceneReaderErrors, RefusesWhatIsNoScene) {
  expect_refused({
      {scene_json("[]"), {"/: []", "an object with the keys \"name\""}},
      {scene_json("null"), {"/: null"}},
      {changed_scene("/name", ""), {"/name: is missing"}},
      {changed_scene("/bodies", ""), {"/bodies: is missing"}},
      {changed_scene("/bodies", "{}"), {"/bodies"}},
      {changed_scene("/gravity", "[0, 0, -9.81]"), {"/gravity: unknown key"}},
      {changed_scene("/joint", "[]"), {"/joint: unknown key", "did you mean \"joints\"?"}},
      {changed_scene("/duration", "0"), {"/duration", "a positive number"}},
      {changed_scene("/chaotic", "\"yes\""), {"/chaotic", "true or false"}},
      {changed_scene("/summary", "1"), {"/summary", "a text"}},
  });
}

TEST(SceneReaderErrors, PutsThePlaceOfTheSceneBeforeEveryPointer) {
  try {
    read_scene(changed_scene("/bodies/0/mass", "0"), "/problems/0/scene");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place(), "/problems/0/scene/bodies/0/mass");
  }
}

TEST(SceneReaderErrors, ShowsAFewOfManyNames) {
  Json json = scene_json(R"({"name": "many", "bodies": [],
    "joints": [{"type": "spherical", "bodies": ["ground", "body 7777777"], "point": [0, 0, 0]}]})");
  for (int i = 0; i < 1000; ++i)
    json["bodies"].push_back({{"name", "body " + std::to_string(i)}, {"mass", 1}, {"inertia", {1, 1, 1}}});
  const std::string error = scene_error(json);
  EXPECT_THAT(error, AllOf(HasSubstr("and 989 more"), HasSubstr("did you mean")));
  EXPECT_LT(error.size(), 400u);
}

TEST(SceneReaderErrors, LongTextsAreNeitherSearchedNorShown) {
  const std::string text = '"' + std::string(5'000'000, 'x') + '"';
  for (const char* place :
       {"/bodies/0/name", "/bodies/0/formulation", "/joints/0/bodies/0", "/effects/0/type"})
    EXPECT_LT(scene_error(changed_scene(place, text)).size(), 600u) << place;
  Json json = scene_json(base_scene);
  json[std::string(5'000'000, 'x')] = 1;
  EXPECT_LT(scene_error(json).size(), 600u);
}

// Files.

class SceneFile : public testing::Test {
 protected:
  SceneFile()
      : file_(std::filesystem::temp_directory_path() / ("scene_" + std::to_string(::getpid()) + ".json")) {}
  ~SceneFile() override { std::filesystem::remove(file_); }
  std::string error_of(const std::string& text) {
    std::ofstream(file_) << text;
    return error();
  }
  std::string error() const {
    try {
      read_scene_file(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  std::filesystem::path file_;
};

TEST_F(SceneFile, IsNamedWithThePlace) {
  EXPECT_THAT(error_of(changed_scene("/bodies/0/mass", "0").dump()),
              HasSubstr(file_.string() + "#/bodies/0/mass: 0 is not allowed here"));
  EXPECT_EQ(error_of(base_scene), "accepted");
}

TEST_F(SceneFile, ThatIsNotJsonIsRefusedWithLineAndColumn) {
  EXPECT_THAT(error_of("bodies: 3"), HasSubstr("not valid JSON: parse error at line 1, column 1"));
  EXPECT_THAT(error_of(""), HasSubstr("not valid JSON"));
  EXPECT_THAT(error_of(std::string("\x7f"
                                   "ELF\0\0",
                                   6)),
              HasSubstr("not valid JSON"));
}

TEST_F(SceneFile, WithNumbersThatAreNotFiniteIsRefused) {
  std::string text = base_scene;
  const std::size_t mass = text.find("\"mass\": 2") + 8;
  for (const char* number : {"NaN", "Infinity", "-inf", "1e999"})
    EXPECT_THAT(error_of(std::string(text).replace(mass, 1, number)), HasSubstr("not valid JSON")) << number;
}

TEST_F(SceneFile, WithAKeyTwiceIsRefused) {
  EXPECT_THAT(error_of(R"({"name": "a", "name": "b"})"), HasSubstr("stands twice"));
}

TEST_F(SceneFile, TooDeepIsRefused) {
  for (const char* open : {"[", "{\"bodies\":"}) {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += open;
    EXPECT_THAT(error_of(text), HasSubstr("nested deeper than 64 levels"));
  }
}

TEST_F(SceneFile, TooLargeIsRefusedBeforeItIsRead) {
  std::ofstream(file_) << base_scene;
  // A hole: no disk is filled.
  std::filesystem::resize_file(file_, 100'000'000);
  EXPECT_THAT(error(), HasSubstr("100000000 bytes; at most 67108864 are allowed"));
}

TEST_F(SceneFile, ThatIsNotThereIsRefused) {
  EXPECT_THAT(error(), HasSubstr("cannot be read"));
}

TEST(SceneReaderErrors, ADeviceThatNeverEndsIsRefused) {
  EXPECT_THROW(read_json_file("/dev/zero", 1 << 20), InputError);
}

}  // namespace
}  // namespace liebench
