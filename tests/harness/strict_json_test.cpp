#include "harness/strict_json.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "harness/errors.h"
#include "tests/support/run_program.h"

namespace liebench {
namespace {

// What an InputError says; "" where nothing is thrown.
template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string parse_complaint(const std::string& text) {
  return complaint([&] { parse_json(text, "study.json"); });
}

TEST(StrictJson, TheNearestWordIsOneSlipAwayAndIgnoresCase) {
  const std::vector<std::string> words{"bliedf2nd", "generalized_alpha", "faltinsen_bdf"};
  EXPECT_EQ(nearest("bliedf2n", words), "bliedf2nd");
  EXPECT_EQ(nearest("BLieDF2nd", words), "bliedf2nd");
  EXPECT_EQ(nearest("generalised_alpha", words), "generalized_alpha");
  EXPECT_EQ(nearest("faltinsen-bdf", words), "faltinsen_bdf");
}

TEST(StrictJson, AWordThatIsNearNothingGetsNoSuggestion) {
  EXPECT_EQ(nearest("zzzz", {"mass", "inertia"}), "");
  EXPECT_EQ(nearest("", {"k"}), "");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(suggestion("zzzz", {"mass", "inertia"}), "");
  EXPECT_TRUE(has(suggestion("mas", {"mass", "inertia"}), "did you mean \"mass\"?"));
}

TEST(StrictJson, AListOfWordsReadsAsASentence) {
  EXPECT_EQ(quoted_list({"a"}), "\"a\"");
  EXPECT_EQ(quoted_list({"a", "b"}), "\"a\" or \"b\"");
  EXPECT_EQ(quoted_list({"a", "b", "c"}), "\"a\", \"b\" or \"c\"");
}

TEST(StrictJson, ASyntaxErrorNamesFileLineAndColumn) {
  for (const char* text : {"{\n  \"t_end\": NaN\n}", "{\n  \"t_end\": Infinity\n}", "{\n  \"t_end\": +1\n}",
                           "{\n  \"t_end\": .5\n}", "{\n  \"t_end\": 'x'\n}"}) {
    const std::string message = parse_complaint(text);
    EXPECT_TRUE(has(message, "study.json: not valid JSON")) << text << " -> " << message;
    EXPECT_TRUE(has(message, "line 2, column ")) << text << " -> " << message;
  }
}

TEST(StrictJson, ANumberBeyondDoubleIsRefusedByItsText) {
  const std::string message = parse_complaint("{\"t_end\": 1e999}");
  EXPECT_TRUE(has(message, "study.json: ")) << message;
  EXPECT_TRUE(has(message, "1e999")) << message;
}

TEST(StrictJson, WhatJsonForbidsIsRefused) {
  for (const char* text :
       {"", " ", "{", "{\"a\": 1", "[1, 2", "[1, 2,]", "{\"a\": 1,}", "{a: 1}", "{\"a\" 1}", "[1] [2]",
        "{} x", "// comment\n{}", "\"\xff\"", "\"\\x\"", "01", "nul", "\"open"})
    EXPECT_TRUE(has(parse_complaint(text), "study.json: not valid JSON")) << text;
}

TEST(StrictJson, AKeyGivenTwiceIsRefused) {
  // One of the two would be dropped without a word.
  EXPECT_TRUE(has(parse_complaint("{\"mass\": 1, \"mass\": 2}"), "mass"));
  EXPECT_EQ(parse_complaint("{\"a\": {\"mass\": 1}, \"b\": {\"mass\": 2}}"), "");
}

TEST(StrictJson, DeepNestingIsRefusedBeforeItCostsAnything) {
  for (const std::size_t depth : {std::size_t{100}, std::size_t{1000000}}) {
    const std::string arrays(depth, '[');
    EXPECT_TRUE(has(parse_complaint(arrays), "nested deeper than 64 levels")) << depth;
    std::string objects;
    for (std::size_t i = 0; i < depth; ++i) objects += "{\"a\":";
    EXPECT_TRUE(has(parse_complaint(objects), "nested deeper than 64 levels")) << depth;
  }
  EXPECT_EQ(parse_complaint(std::string(60, '[') + "1" + std::string(60, ']')), "");
}

TEST(StrictJson, AFileIsReadWholeOrRefusedByItsName) {
  const TemporaryFolder folder;
  const auto good = folder.write("good.json", "{\"name\": \"x\"}\n");
  EXPECT_EQ(read_json_file(good)["name"], "x");
  EXPECT_TRUE(has(complaint([&] { read_json_file(folder / "absent.json"); }), "absent.json: cannot be read"));
  EXPECT_TRUE(has(complaint([&] { read_json_file(folder.path()); }), "cannot be read"));

  const auto large = folder.write("large.json", "\"");
  std::filesystem::resize_file(large, 17u << 20);
  const std::string message = complaint([&] { read_json_file(large); });
  EXPECT_TRUE(has(message, "large.json: 17825792 bytes")) << message;
  EXPECT_TRUE(has(message, "16777216")) << message;
}

TEST(StrictJson, EveryRefusalNamesPlaceValueAndWhatIsAllowed) {
  const Json json = parse_json(R"({"a/b~c": [1, {"x": -2.5}], "word": "blue", "null": null})", "test");
  const JsonView root(json, "");
  const JsonView x = root["a/b~c"][1]["x"];
  EXPECT_EQ(x.pointer(), "/a~1b~0c/1/x");  // RFC 6901
  EXPECT_EQ(complaint([&] { x.number_in(0, 1); }),
            "/a~1b~0c/1/x: -2.5 is not allowed here; allowed: a number from 0 to 1");
  EXPECT_EQ(complaint([&] { x.integer_in(-9, 9); }),
            "/a~1b~0c/1/x: -2.5 is not allowed here; allowed: an integer from -9 to 9");
  EXPECT_EQ(complaint([&] { x.boolean(); }),
            "/a~1b~0c/1/x: -2.5 is not allowed here; allowed: true or false");
  EXPECT_EQ(complaint([&] { root["null"].number("a number"); }),
            "/null: null is not allowed here; allowed: a number");
  EXPECT_EQ(complaint([&] {
              root["word"].word({"black", "blues"}, "colour");
            }),
            "/word: unknown colour \"blue\"; allowed: \"black\" or \"blues\"; did you mean \"blues\"?");
  EXPECT_EQ(
      complaint([&] {
        root.require_object({"a/b~c", "null", "words"});
      }),
      "/word: unknown key \"word\"; allowed: \"a/b~c\", \"null\" or \"words\"; did you mean \"words\"?");
  EXPECT_EQ(complaint([&] { root.require_key("name"); }), "/name: is missing");
}

TEST(StrictJson, ALongValueIsShownShort) {
  const Json json = std::string(100000, 'x');
  EXPECT_LT(complaint([&] { JsonView(json, "/a").boolean(); }).size(), 200u);
}

TEST(StrictJson, NoTypeStandsForAnother) {
  const Json json = parse_json(R"({"t": "1", "n": 1, "b": true, "l": [], "o": {}})", "test");
  const JsonView root(json, "");
  for (const char* key : {"t", "b", "l", "o"}) {
    EXPECT_NE(complaint([&] { root[key].number("a number"); }), "") << key;
    EXPECT_NE(complaint([&] { root[key].integer_in(0, 9); }), "") << key;
  }
  for (const char* key : {"n", "t", "l", "o"}) EXPECT_NE(complaint([&] { root[key].boolean(); }), "") << key;
  for (const char* key : {"n", "b", "l", "o"}) {
    EXPECT_NE(complaint([&] { root[key].text(); }), "") << key;
    EXPECT_NE(complaint([&] { root[key].word({"1"}, "word"); }), "") << key;
  }
  for (const char* key : {"n", "t", "b", "l"})
    EXPECT_NE(complaint([&] { root[key].require_object({}); }), "") << key;
  for (const char* key : {"n", "t", "b", "l", "o"})  // an empty list is none
    EXPECT_NE(complaint([&] { root[key].require_array(); }), "") << key;
}

TEST(StrictJson, AnIntegerMayBeWrittenWithAPoint) {
  const Json json = parse_json("[2, 2.0, 2e0, 20e-1]", "test");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(JsonView(json, "")[i].integer_in(1, 4), 2);
  const Json large = parse_json("[99999999999999999999, -99999999999999999999, 4294967298]", "test");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NE(complaint([&] { JsonView(large, "")[i].integer_in(1, 4); }), "") << i;
}

}  // namespace
}  // namespace liebench
