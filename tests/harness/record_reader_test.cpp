#include "harness/record_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "harness/errors.h"
#include "tests/harness/sample_records.h"

namespace liebench {
namespace {

class RecordReader : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return file_;
  }
  std::vector<RecordRow> read(const std::string& text) const { return read_records({write(text)}); }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      (std::string("record_reader_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

Json good() {
  return power_law_record({.step_size = 0.01}, 2);
}

Json keyed(int key) {
  Json record = good();
  record["key"] = std::to_string(key);
  record["steps"] = key;
  return record;
}

TEST_F(RecordReader, KeepsEveryNumberThatIsNamed) {
  Json record = good();
  double value = 0.1;
  for (const std::string_view path : number_paths)
    record[Json::json_pointer("/" + std::string(path))] = value += 1.0 / 3.0;
  const RecordRow row = read(record.dump()).at(0);
  for (std::size_t i = 0; i < number_paths.size(); ++i)
    EXPECT_EQ(row[RecordNumber(i)], record[Json::json_pointer("/" + std::string(number_paths[i]))])
        << number_paths[i];
}

TEST_F(RecordReader, ANumberThatTheRecordLacksIsAbsent) {
  Json record = good();
  record["errors"].erase("lambda");
  record["drift"]["energy"] = nullptr;
  const RecordRow row = read(record.dump()).at(0);
  EXPECT_FALSE(row[record_number("errors/lambda/end_relative")]);
  EXPECT_FALSE(row[record_number("drift/energy")]);
  EXPECT_FALSE(row[record_number("time/total_ns")]);
  EXPECT_TRUE(row[record_number("errors/q/end_relative")]);
  EXPECT_FALSE(row.failure);
}

TEST_F(RecordReader, KeepsTheIdentityAsItStands) {
  Json record = good();
  record["options"]["text"] = "a \"quoted\" \u03bb \\ / \n";
  record["options"]["nested"] =
      Json::parse(R"([[], {}, [1, -2, 1.5e-300, true, null], {"key": {"options": 1}}])");
  const RecordRow row = read(record.dump()).at(0);
  EXPECT_EQ(row.curve->options->dump(), record["options"].dump());
  EXPECT_EQ(row.curve->parameters->dump(), record["parameters"].dump());
  EXPECT_EQ(row.curve->problem, record["problem"]);
  EXPECT_EQ(row.curve->formulation, record["formulation"]);
  EXPECT_EQ(row.curve->integrator, record["integrator"]);
  EXPECT_EQ(row.curve->start, record["start"]);
  EXPECT_EQ(row.curve->precision, record["precision"]);
  EXPECT_EQ(row.curve->t_0, record["t_0"]);
  EXPECT_EQ(row.curve->length_key, "t_end");
  EXPECT_EQ(row.curve->length, record["t_end"]);
  record["local_steps"] = 4;
  const RecordRow local = read(record.dump()).at(0);
  EXPECT_EQ(local.curve->length_key, "local_steps");
  EXPECT_EQ(local.curve->length, 4);
}

TEST_F(RecordReader, KeepsHowARunFailed) {
  const RecordRow row = read(sample_record({}, sample_failure()).dump()).at(0);
  EXPECT_FALSE(row.ended_well());
  ASSERT_TRUE(row.failure);
  EXPECT_EQ(row.failure->time, 0.25);
  EXPECT_EQ(row.failure->step, 250);
  EXPECT_EQ(row.failure->residual, 3.5);
  EXPECT_EQ(row.failure->message, "it does not converge");
}

TEST_F(RecordReader, RowsOfOneTextShareTheirIdentityWhateverStandsBetweenThem) {
  Json heavier = keyed(2);
  heavier["parameters"]["mass"] = 16.5;
  const auto rows = read(keyed(1).dump() + "\n" + heavier.dump() + "\n" + keyed(3).dump());
  EXPECT_EQ(rows[0].curve, rows[2].curve);
  EXPECT_NE(rows[0].curve, rows[1].curve);
  EXPECT_EQ(rows[0].curve->options->dump(), rows[1].curve->options->dump());
}

TEST_F(RecordReader, TakesAnyOrderOfKeysSpacesAndEscapes) {
  Json turned;
  const Json record = good();
  for (auto item = record.rbegin(); item != record.rend(); ++item) turned[item.key()] = item.value();
  std::string text = turned.dump(1);
  std::erase(text, '\n');
  const std::size_t place = text.find("\"formulation\"");
  ASSERT_NE(place, std::string::npos);
  text.replace(place, 13, "\"\\u0066ormulation\"\t");
  const RecordRow plain = read(record.dump()).at(0), row = read("\t" + text + " \r\n").at(0);
  EXPECT_EQ(*row.curve, *plain.curve);
  EXPECT_EQ(row.outcome, plain.outcome);
  EXPECT_EQ(row.step_size(), plain.step_size());
}

TEST_F(RecordReader, ChecksAsJsonWhatItDoesNotKeep) {
  const std::string line = good().dump();
  const std::size_t place = line.find("\"commit\"");
  ASSERT_NE(place, std::string::npos);
  for (const std::string& wrong :
       {std::string(","), std::string("\"n\":1e999,"), std::string("\"n\":01,"), std::string("\"n\":.5,"),
        std::string("\"n\":NaN,"), std::string("\"t\":\"\x1b\","), std::string("\"t\":\"\xff\","),
        std::string("\"t\":\"\\ud800\","), std::string("\"t\":\"\\x\","), std::string("\"t\":\"\0\",", 8),
        std::string("\"t\":tru,"), std::string("\"t\":[1,],"), std::string("\"t\":{1:2},")}) {
    std::string bad = line;
    bad.insert(place, wrong);
    EXPECT_THROW(read(bad), InputError) << wrong;
  }
  for (const std::string right :
       {"\"n\":1e-999,", "\"n\":-0.5E+003,", "\"t\":\"\u03bb \\ud83d\\ude00\",", "\"t\":[1],"}) {
    std::string same = line;
    same.insert(place, right);
    EXPECT_EQ(read(same).size(), 1u) << right;
  }
  EXPECT_THROW(read(line + "x"), InputError);
  EXPECT_THROW(read(line + line), InputError);
}

TEST_F(RecordReader, ARecordWithoutWhatTablesRelyOnIsRefused) {
  for (const char* path : {"schema", "key", "study", "problem", "formulation", "parameters", "integrator",
                           "options", "start", "precision", "step_size", "steps", "t_0", "t_end", "outcome",
                           "reference", "reference/error_estimate", "errors", "cost"}) {
    Json record = good();
    record[Json::json_pointer("/" + std::string(path))] = Json::array({1});
    EXPECT_THROW(read(record.dump()), InputError) << path;
  }
  for (const char* path : {"failure", "failure/time", "failure/message"}) {
    Json record = sample_record({}, sample_failure());
    record[Json::json_pointer("/" + std::string(path))] = nullptr;
    EXPECT_THROW(read(record.dump()), InputError) << path;
  }
}

// Of more than one part of a file: a part is a megabyte.
std::string many_lines() {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += keyed(i).dump() + "\n";
  return text;
}

TEST_F(RecordReader, KeepsTheOrderOfManyLinesAndNamesTheFirstBadOne) {
  std::string text = many_lines();
  ASSERT_GT(text.size(), 3U << 20U);
  const auto records = read(text);
  ASSERT_EQ(records.size(), 3000u);
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(records[std::size_t(i)].steps(), i);
  text += "x\n" + keyed(1).dump() + "\ny\n";
  try {
    read(text);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place(), file_.string() + ":3001") << error.what();
  }
}

TEST_F(RecordReader, DoesNotDependOnTheNumberOfThreads) {
  Json last = keyed(7);
  last["parameters"]["mass"] = 16.5;
  const auto file = write(many_lines() + last.dump() + "\n");
  const auto one = read_records({file}, BadLines::reject, 1);
  EXPECT_EQ(*one[7].curve->parameters, last["parameters"]);
  for (const unsigned threads : {2U, 3U, 8U}) {
    const auto several = read_records({file}, BadLines::reject, threads);
    ASSERT_EQ(several.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(several[i].steps(), one[i].steps());
      ASSERT_EQ(*several[i].curve, *one[i].curve);
    }
  }
}

TEST_F(RecordReader, SkipsBadLinesWhenAskedAndNamesThem) {
  const auto file =
      write(keyed(1).dump() + "\nforeign\n" + keyed(2).dump() + "\n\n" + keyed(3).dump().substr(0, 90));
  ::testing::internal::CaptureStderr();
  const auto records = read_records({file}, BadLines::skip);
  const std::string messages = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(records.size(), 2u);
  EXPECT_NE(messages.find(file.string() + ":2"), std::string::npos) << messages;
  EXPECT_NE(messages.find(file.string() + ":5"), std::string::npos) << messages;
  EXPECT_NE(messages.find("2 bad lines skipped, 2 records used"), std::string::npos) << messages;
}

TEST_F(RecordReader, OfRowsWithOneKeyTheLastCounts) {
  Json timed = keyed(1);
  timed["time"]["total_ns"] = 5.0;
  const auto records = read(keyed(1).dump() + "\n" + keyed(2).dump() + "\n" + timed.dump() + "\n");
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0][record_number("time/total_ns")], 5.0);
  EXPECT_EQ(records[1].steps(), 2);
}

TEST_F(RecordReader, KeepsKeyAndSamplesOfTimes) {
  Json record = good();
  record["time"]["ns_per_step"] = {{"samples", {1, 2.5, "x", {3}}}, {"median", 2}};
  const RecordRow row = read(record.dump()).at(0);
  EXPECT_EQ(row.key, record["key"]);
  EXPECT_EQ(row.time_samples, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(row[record_number("time/ns_per_step/median")], 2.0);
}

TEST(RecordRows, AreThoseOfAFileAndAreChecked) {
  const auto rows = record_rows({keyed(1), keyed(1)});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].steps(), 1);
  Json hollow = good();
  hollow.erase("cost");
  EXPECT_THROW(record_rows({good(), hollow}), InputError);
}

}  // namespace
}  // namespace liebench
