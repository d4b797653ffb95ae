#include "harness/record.h"
#include "harness/record_reader.h"

#include "harness/embedded.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "harness/errors.h"
#include "tests/harness/json_schema.h"
#include "tests/harness/sample_records.h"
#include "tests/support/run_program.h"

namespace liebench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const JsonSchema& schema() {
  static const JsonSchema parsed(embedded_file("record.schema.json"));
  return parsed;
}

Json good_record() {
  return sample_record({}, sample_result(1e-4, 2e-4, 3e-4));
}
Json failed_record() {
  return sample_record({}, sample_failure());
}

// Of a scene.
Json scene_record() {
  RunResult result = sample_result(1e-4, 2e-4, 3e-4);
  result.solver = LinearSolver::klu;
  return sample_record({}, result);
}
Json local_record() {
  return sample_record({.local = true}, sample_result(1e-4, 2e-4, 3e-4));
}

// Every enumerator, found by its name: an enumerator added to integrators/outcome.h is here without being
// told.
std::set<std::string> all_outcomes() {
  std::set<std::string> names;
  for (int i = 0; name(Outcome(i)) != "unknown"; ++i) names.emplace(name(Outcome(i)));
  return names;
}

// Calls visit(pointer, value) for the value and everything in it.
template <class Visit>
void walk(const Json& value, const std::string& pointer, const Visit& visit) {
  visit(pointer, value);
  if (value.is_object())
    for (const auto& item : value.items()) walk(item.value(), pointer + "/" + item.key(), visit);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) walk(value[i], pointer + "/" + std::to_string(i), visit);
}

TEST(Record, OfEveryKindOfRunIsValidByTheSchema) {
  EXPECT_EQ(schema().violations(good_record().dump()), "");
  EXPECT_EQ(schema().violations(failed_record().dump()), "");
  EXPECT_EQ(schema().violations(scene_record().dump()), "");
  EXPECT_EQ(
      schema().violations(sample_record({.formulation = "SO3"}, sample_result(1e-4, 2e-4, 0, false)).dump()),
      "");
  EXPECT_EQ(schema().violations(local_record().dump()), "");
  EXPECT_EQ(schema().violations(sample_record({}, sample_result(0, 0, 0)).dump()), "");
}

TEST(Record, TheSchemaAndTheProgramKnowTheSameOutcomes) {
  std::set<std::string> in_schema;
  const Json text = parse_json(embedded_file("record.schema.json"), "record.schema.json");
  for (const Json& word : text["properties"]["outcome"]["enum"]) in_schema.insert(word.get<std::string>());
  EXPECT_EQ(in_schema, all_outcomes());
}

TEST(Record, OfEveryOutcomeIsValidByTheSchema) {
  for (int i = 0; name(Outcome(i)) != "unknown"; ++i) {
    if (Outcome(i) == Outcome::ok) continue;
    RunResult result = sample_failure();
    result.outcome = Outcome(i);
    EXPECT_EQ(schema().violations(sample_record({}, result).dump()), "") << name(Outcome(i));
  }
}

TEST(Record, TheSchemaForbidsAnyFurtherKey) {
  for (const Json& record : {good_record(), failed_record(), local_record()})
    walk(record, "", [&](const std::string& pointer, const Json& value) {
      // What these hold depends on problem, integrator and build.
      if (!value.is_object() || pointer == "/parameters" || pointer == "/options" ||
          pointer == "/provenance/libraries")
        return;
      Json more = record;
      more[Json::json_pointer(pointer + "/surplus")] = 1;
      EXPECT_NE(schema().violations(more.dump()), "") << pointer << "/surplus";
    });
}

TEST(Record, TheSchemaMissesEveryKeyThatIsTakenAway) {
  const std::set<std::string> optional{"/local_steps",
                                       "/requested_step_size",
                                       "/errors/lambda",
                                       "/drift/position_constraint",
                                       "/drift/velocity_constraint",
                                       "/drift/angular_momentum",
                                       "/failure/residual",
                                       "/solver"};
  for (const Json& record : {good_record(), failed_record(), local_record(), scene_record()})
    walk(record, "", [&](const std::string& pointer, const Json&) {
      if (pointer.empty() || pointer.starts_with("/parameters/") || pointer.starts_with("/options/") ||
          pointer.starts_with("/provenance/libraries/"))
        return;
      const Json::json_pointer place(pointer);
      Json less = record;
      less[place.parent_pointer()].erase(place.back());
      EXPECT_EQ(schema().violations(less.dump()).empty(), optional.contains(pointer))
          << "without " << pointer;
    });
}

TEST(Record, TheSchemaForbidsNullInPlaceOfAnything) {
  for (const Json& record : {good_record(), failed_record(), local_record(), scene_record()})
    walk(record, "", [&](const std::string& pointer, const Json&) {
      if (pointer.starts_with("/parameters/") || pointer.starts_with("/options/")) return;
      Json changed = record;
      changed[Json::json_pointer(pointer)] = nullptr;
      EXPECT_NE(schema().violations(changed.dump()), "") << pointer << " = null";
    });
}

TEST(Record, TheSchemaForbidsContradictions) {
  Json both = good_record();
  both["failure"] = failed_record()["failure"];
  EXPECT_NE(schema().violations(both.dump()), "") << "ok with failure";
  Json errors = failed_record();
  errors["errors"] = good_record()["errors"];
  EXPECT_NE(schema().violations(errors.dump()), "") << "failed with errors";
  const std::vector<std::pair<const char*, Json>> values{{"/schema", 2},
                                                         {"/key", "xyz"},
                                                         {"/key", std::string(31, 'a')},
                                                         {"/step_size", 0},
                                                         {"/step_size", -1e-3},
                                                         {"/steps", 0},
                                                         {"/steps", 1.5},
                                                         {"/outcome", "fine"},
                                                         {"/precision", "half"},
                                                         {"/solver", "qr"},
                                                         {"/errors/q/end_relative", -1.0},
                                                         {"/errors/q/end_relative", "1e-4"},
                                                         {"/cost/solves", -1},
                                                         {"/provenance/date", "31.1.2024"},
                                                         {"/provenance/dirty", 0}};
  for (const auto& [pointer, value] : values) {
    Json record = good_record();
    record[Json::json_pointer(pointer)] = value;
    EXPECT_NE(schema().violations(record.dump()), "") << pointer << " = " << value;
  }
}

TEST(Record, HasItsKeysInTheOrderOfItsDescription) {
  std::vector<std::string> keys;
  const Json record = good_record();
  for (const auto& item : record.items()) keys.push_back(item.key());
  EXPECT_EQ(keys, (std::vector<std::string>{
                      "schema",     "key",     "study",     "problem",   "formulation", "parameters",
                      "integrator", "options", "start",     "precision", "step_size",   "requested_step_size",
                      "steps",      "t_0",     "t_end",     "outcome",   "reference",   "errors",
                      "drift",      "cost",    "provenance"}));
}

TEST(Record, SaysBothTheStepSizeAskedForAndTheOneUsed) {
  const Json record = sample_record({.step_size = 0.3, .t_end = 2.0}, sample_result(1, 1, 1));
  EXPECT_EQ(record["requested_step_size"], 0.3);
  EXPECT_EQ(record["steps"], 7);
  EXPECT_DOUBLE_EQ(record["step_size"].get<double>(), 2.0 / 7.0);
}

TEST(Record, WhatDoesNotApplyIsAbsent) {
  const Json free = sample_record({.formulation = "SO3"}, sample_result(1e-4, 2e-4, 0, false));
  EXPECT_FALSE(free["errors"].contains("lambda"));
  EXPECT_FALSE(free["drift"].contains("position_constraint"));
  EXPECT_FALSE(free["drift"].contains("velocity_constraint"));
  EXPECT_FALSE(free.contains("failure"));
  EXPECT_FALSE(free.contains("local_steps"));
  EXPECT_EQ(local_record()["local_steps"], 1);
  const Json failed = failed_record();
  EXPECT_FALSE(failed.contains("errors"));
  EXPECT_FALSE(failed.contains("drift"));
}

TEST(Record, AnOverflownResidualIsLeftOutAndTheFailureKept) {
  for (const double residual : {infinity, nan}) {
    RunResult result = sample_failure();
    result.failure->residual = residual;
    const Json record = sample_record({}, result);
    EXPECT_FALSE(record["failure"].contains("residual"));
    EXPECT_EQ(schema().violations(record.dump()), "");
  }
}

TEST(Record, ANumberThatIsNotFiniteNeverBecomesNull) {
  for (const double bad : {infinity, nan}) {
    EXPECT_ANY_THROW(sample_record({}, sample_result(bad, 1, 1)));
    EXPECT_ANY_THROW(sample_record({}, sample_result(1, bad, 1)));
    EXPECT_ANY_THROW(sample_record({}, sample_result(1, 1, bad)));
    RunResult result = sample_result(1, 1, 1);
    result.drift->energy = bad;
    EXPECT_ANY_THROW(sample_record({}, result));
    EXPECT_ANY_THROW(
        make_record(sample_spec({}), sample_result(1, 1, 1), NoProblem(bad), sample_provenance()))
        << "error estimate of the reference " << bad;
  }
}

TEST(Record, TheTimeOfAFailureCountsFromTheStart) {
  Json study = parse_json(R"({"name": "x", "problems": [{"name": "heavy_top"}], "step_sizes": [0.1],
                              "integrators": [{"name": "bliedf2nd"}], "t_0": 3, "t_end": 5})",
                          "test");
  const Json record =
      make_record(read_study(study).runs.at(0), sample_failure(), NoProblem(), sample_provenance());
  EXPECT_EQ(record["failure"]["time"], 3.25);
}

TEST(Records, AreReadBackInTheirOrder) {
  const TemporaryFolder folder;
  Json other = good_record();
  other["key"] = std::string(32, 'a');
  const std::string text = failed_record().dump() + "\n\n" + other.dump() + "\n";
  const auto records = read_records({folder.write("a.jsonl", text)});
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].outcome, failed_record()["outcome"]);
  EXPECT_EQ(records[1][record_number("errors/q/end_relative")], good_record()["errors"]["q"]["end_relative"]);
}

TEST(Records, OfTwoVersionsOfARowTheLaterCountsInThePlaceOfTheFirst) {
  const TemporaryFolder folder;
  Json timed = good_record(), other = good_record();
  timed["time"] = {{"total_ns", 1.0}};
  other["key"] = std::string(32, 'a');
  const auto records = read_records(
      {folder.write("a.jsonl", good_record().dump() + "\n" + other.dump() + "\n" + timed.dump() + "\n")});
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0][record_number("time/total_ns")], 1.0);
}

TEST(Records, OfAnotherKindAreRefusedWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string good = good_record().dump() + "\n";
  Json newer = good_record();
  newer["schema"] = 2;
  Json hollow = good_record();
  hollow.erase("integrator");
  hollow.erase("step_size");
  for (const std::string& line :
       {std::string("{\"foreign\": true}"), std::string("[1, 2]"), std::string("3"), std::string("not JSON"),
        good.substr(0, good.size() / 2), newer.dump(), hollow.dump(),
        std::string("{\"schema\": 1, \"key\": \"x\"}"), std::string("{\"schema\": 1, \"key\": 3}")}) {
    const auto file = folder.write("a.jsonl", good + line + "\n" + good);
    try {
      read_records({file});
      ADD_FAILURE() << "accepted: " << line.substr(0, 80);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find((file.string() + ":2").c_str()), 0u) << error.what();
    }
  }
}

TEST(Records, OfAFileThatIsNotThereAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_records({folder / "absent.jsonl"}), InputError);
  EXPECT_THROW(read_records({folder.path()}), InputError);
}

}  // namespace
}  // namespace liebench
