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
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      (std::string("record_reader_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

Json good() {
  return power_law_record({.step_size = 0.01}, 2);
}

RecordNeeds everything() {
  return RecordNeeds({"errors", "cost", "time", "drift"}).with_shared_parameters();
}

Json keyed(int key) {
  Json record = good();
  record["key"] = std::to_string(key);
  return record;
}

TEST_F(RecordReader, KeepsAllButWhatNoTableNeeds) {
  Json record = good();
  record["text"] = "a \"quoted\" \u03bb";
  record["nested"] = Json::parse(R"([[], {}, [1, -2, 1.5e-300, true, null], {"provenance": {"method": 1}}])");
  const auto file = write(record.dump());
  const auto with_drift = read_records({file}, BadLines::reject, everything());
  for (const char* key : {"provenance", "requested_step_size"}) record.erase(key);
  record["reference"].erase("method");
  ASSERT_EQ(with_drift.size(), 1u);
  EXPECT_EQ(with_drift[0].dump(), record.dump());
  record.erase("drift");
  EXPECT_EQ(read_records(file).at(0).dump(), record.dump());
}

TEST_F(RecordReader, KeepsOfASectionTheEntriesAskedFor) {
  Json record = good();
  record["time"] = {{"total_ns", 7}, {"ns_per_step", {{"median", 1}, {"samples", {1, 2}}}}};
  const auto file = write(record.dump());
  const Json kept =
      read_records({file}, BadLines::reject, RecordNeeds({"errors/v", "cost/residuals", "time/total_ns"}))
          .at(0);
  EXPECT_EQ(kept["errors"], Json({{"v", record["errors"]["v"]}}));
  EXPECT_EQ(kept["cost"], Json({{"residuals", record["cost"]["residuals"]}}));
  EXPECT_EQ(kept["time"], Json({{"total_ns", 7}}));
  EXPECT_EQ(kept["options"], record["options"]);
  const Json bare = read_records({file}, BadLines::reject, RecordNeeds({})).at(0);
  EXPECT_EQ(bare["errors"], Json::object());
  EXPECT_EQ(bare["cost"], Json::object());
  EXPECT_FALSE(bare.contains("time"));
  EXPECT_FALSE(bare.contains("drift"));
}

TEST_F(RecordReader, ParametersThatTellNothingApartAreLeftOut) {
  Json first = keyed(1), second = keyed(2);
  const Json parameters = first["parameters"];
  const RecordNeeds needs({"errors"});
  const std::string both = first.dump() + "\n" + second.dump() + "\n";
  for (const Json& record : read_records({write(both)}, BadLines::reject, needs))
    EXPECT_EQ(record["parameters"], Json::object());
  second["parameters"]["mass"] = 16.5;
  const auto kept = read_records({write(first.dump() + "\n" + second.dump())}, BadLines::reject, needs);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0]["parameters"], parameters);
  EXPECT_EQ(kept[1]["parameters"], second["parameters"]);
  second["parameters"] = 5;
  EXPECT_THROW(read_records({write(second.dump())}, BadLines::reject, needs), InputError);
}

TEST_F(RecordReader, ChecksAsJsonWhatItDoesNotKeep) {
  std::string line = good().dump();
  const std::size_t place = line.find("\"commit\"");
  ASSERT_NE(place, std::string::npos);
  line.insert(place, ",");
  EXPECT_THROW(read_records(write(line)), InputError);
}

TEST_F(RecordReader, KeepsTheOrderOfManyLinesAndNamesTheFirstBadOne) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += keyed(i).dump() + "\n";
  const auto records = read_records(write(text));
  ASSERT_EQ(records.size(), 3000u);
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(records[std::size_t(i)]["key"], std::to_string(i));
  text += "x\n" + keyed(1).dump() + "\ny\n";
  try {
    read_records(write(text));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place(), file_.string() + ":3001") << error.what();
  }
}

TEST_F(RecordReader, SkipsBadLinesWhenAskedAndNamesThem) {
  const auto file =
      write(keyed(1).dump() + "\nforeign\n" + keyed(2).dump() + "\n" + keyed(3).dump().substr(0, 90));
  ::testing::internal::CaptureStderr();
  const auto records = read_records({file}, BadLines::skip);
  const std::string messages = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(records.size(), 2u);
  EXPECT_NE(messages.find(file.string() + ":2"), std::string::npos) << messages;
  EXPECT_NE(messages.find(file.string() + ":4"), std::string::npos) << messages;
  EXPECT_NE(messages.find("2 bad lines skipped, 2 records used"), std::string::npos) << messages;
}

TEST_F(RecordReader, OfRowsWithOneKeyTheLastCounts) {
  Json timed = keyed(1);
  timed["time"]["total_ns"] = 5.0;
  const auto records =
      read_records(write(keyed(1).dump() + "\n" + keyed(2).dump() + "\n" + timed.dump() + "\n"));
  ASSERT_EQ(records.size(), 2u);
  EXPECT_TRUE(records[0].contains("time"));
  EXPECT_EQ(records[1]["key"], "2");
}

}  // namespace
}  // namespace liebench
