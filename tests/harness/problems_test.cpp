#include "harness/problems.h"

#include <gtest/gtest.h>

#include <set>

#include "harness/errors.h"

namespace liebench {
namespace {

TEST(Problems, HaveNamesOfTheirOwnAndSayWhatTheyAre) {
  std::set<std::string_view> names;
  for (const ProblemInfo& problem : problems()) {
    EXPECT_TRUE(names.insert(problem.name).second) << problem.name;
    EXPECT_FALSE(problem.summary.empty()) << problem.name;
    ASSERT_FALSE(problem.formulations.empty()) << problem.name;
    for (const FormulationInfo& formulation : problem.formulations)
      EXPECT_FALSE(formulation.summary.empty()) << problem.name << " " << formulation.name;
    for (const ParameterInfo& parameter : problem.parameters) {
      EXPECT_FALSE(parameter.meaning.empty()) << problem.name << " " << parameter.name;
      EXPECT_FALSE(parameter.shape.empty()) << problem.name << " " << parameter.name;
    }
  }
  EXPECT_TRUE(names.contains("heavy_top"));
}

TEST(Problems, TheDefaultsAreWhatAnEmptyObjectMeans) {
  const Json nothing = Json::object();
  for (const ProblemInfo& problem : problems()) {
    const Json complete = problem.complete({nothing, "/p"});
    std::vector<std::string> expected, actual;
    for (const ParameterInfo& info : problem.parameters) {
      expected.emplace_back(info.name);
      EXPECT_EQ(complete[std::string(info.name)], info.fallback) << problem.name << " " << info.name;
    }
    for (const auto& item : complete.items()) actual.push_back(item.key());
    EXPECT_EQ(actual, expected) << problem.name;
  }
}

TEST(Problems, CompletingTwiceIsCompletingOnce) {
  const Json nothing = Json::object();
  for (const ProblemInfo& problem : problems()) {
    const Json once = problem.complete({nothing, "/p"});
    EXPECT_EQ(problem.complete({once, "/p"}).dump(), once.dump()) << problem.name;
  }
}

TEST(HeavyTop, HasTheDataOfTheLiterature) {
  // Bruels & Cardona 2010, section 6: m = 15 kg, J = diag(0.234375, 0.46875, 0.234375) kg m^2, X = (0, 1, 0)
  // m, gamma = (0, 0, -9.81) m/s^2, R(0) = I, Omega(0) = (0, 150, -4.61538) rad/s.
  const Json nothing = Json::object();
  const Json p = heavy_top_info().complete({nothing, "/p"});
  EXPECT_EQ(p["mass"], 15.0);
  EXPECT_EQ(p["inertia"], Json({{0.234375, 0.0, 0.0}, {0.0, 0.46875, 0.0}, {0.0, 0.0, 0.234375}}));
  EXPECT_EQ(p["center_of_mass"], Json({0.0, 1.0, 0.0}));
  EXPECT_EQ(p["gravity"], Json({0.0, 0.0, -9.81}));
  EXPECT_EQ(p["orientation"], Json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(p["angular_velocity"], Json({0.0, 150.0, -4.61538}));
}

TEST(HeavyTop, TakesAnySymmetricPositiveDefiniteInertia) {
  const auto accepts = [](const char* inertia) {
    const Json json = parse_json(std::string("{\"inertia\": ") + inertia + "}", "test");
    try {
      heavy_top_info().complete({json, "/p"});
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  for (const char* good : {"[1, 2, 3]", "[[1,0,0],[0,2,0],[0,0,3]]", "[[2,1,0],[1,2,0],[0,0,1]]",
                           "[[1,0.999999,0],[0.999999,1,0],[0,0,1e-6]]", "[1e-12, 1e-12, 1e-12]"})
    EXPECT_TRUE(accepts(good)) << good;
  for (const char* bad :
       {"[1, 2, 0]", "[1, 2, -3]", "[[1,2,0],[2,1,0],[0,0,1]]", "[[2,1,0],[1.0000001,2,0],[0,0,1]]",
        "[[-1,0,0],[0,-1,0],[0,0,1]]", "[[1,0,0],[0,1,0]]", "[[1,0],[0,1],[0,0]]", "1", "{}"})
    EXPECT_FALSE(accepts(bad)) << bad;
}

}  // namespace
}  // namespace liebench
