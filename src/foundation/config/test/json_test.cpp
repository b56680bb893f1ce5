#include "config/json.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "core/random.h"

namespace trocar::config {
namespace {

TEST(Json, KeepsTheOrderOfKeysAndTheBitsOfNumbers) {
  const auto json = parse_json(R"({"z": 0.1, "a": [1, -2.5e-300, true, null, "ä"]})", "x.json");
  ASSERT_TRUE(json);
  EXPECT_EQ(json->begin().key(), "z");
  EXPECT_EQ((*json)["z"].get<double>(), 0.1);
  const auto again = parse_json(json_text(*json), "again");
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, *json);
}

TEST(Json, ErrorNamesFileLineAndColumn) {
  struct Case {
    const char *text, *place, *what;
  };
  for (const Case& c : std::vector<Case>{
           {R"({"a": 1,, })", "line 1, column 9", "not valid JSON"},
           {"{\n  \"a\": 1,\n  \"b\": 1.0x\n}", "line 3, column 11", "not valid JSON"},
           {"{\"a\": NaN}", "line 1, column 7", "not valid JSON"},
           {"{\"a\": Infinity}", "line 1, column 7", "not valid JSON"},
           {"{\"a\": 0,5}", "line 1, column 9", "not valid JSON"},
           {"{\"a\": 1}}", "line 1, column 9", "not valid JSON"},
           {"{\"a\": 1} {\"a\": 2}", "line 1, column 10", "not valid JSON"},
           {"{'a': 1}", "line 1, column 2", "not valid JSON"},
           {"{\"a\": .5}", "line 1, column 7", "not valid JSON"},
           {"{\"a\": 1, \"a\": 2}", "line 1, column 10", "the key \"a\" occurs twice"},
           {"{\"a\": 1,\n \"\\u0061\": 2}", "line 2, column 2", "the key \"a\" occurs twice"},
           {"{\"x\": {\"k\": \"k\"}, \"y\": [{\"k\": 1}, {\"k\": 2, \"l\": \":\", \"k\": 3}]}", "line 1, column 54",
            "the key \"k\" occurs twice"},
       }) {
    const auto json = parse_json(c.text, "paths.mrk.json");
    ASSERT_FALSE(json) << c.text;
    EXPECT_EQ(json.error().what, c.what) << c.text;
    EXPECT_EQ(json.error().where, std::string("paths.mrk.json, ") + c.place) << c.text;
    EXPECT_EQ(json.error().exit_status, 1);
  }
  EXPECT_TRUE(parse_json(R"({"a": {"a": [{"a": 1}, {"a": 1}]}, "b": "\"a\": 1, \"a\": 2"})", "nested"));
}

TEST(Json, RefusesDeepNestingButNotBracketsInStrings) {
  EXPECT_FALSE(parse_json(std::string(100000, '['), "deep"));
  EXPECT_FALSE(parse_json(std::string(65, '[') + std::string(65, ']'), "deep"));
  EXPECT_TRUE(parse_json(std::string(64, '[') + std::string(64, ']'), "deep"));
  EXPECT_TRUE(parse_json("\"\\\"" + std::string(1000, '[') + "\"", "string"));
}

TEST(Json, LimitsValuesWithoutCountingCommasInStrings) {
  const TemporaryFolder folder;
  const auto loads = [&](std::size_t commas, const std::string& first) {
    std::string text = "[" + first;
    for (std::size_t n = 0; n < commas; ++n) text += ",0";
    std::ofstream(folder / "values.json") << text << "]";
    return load_json(folder / "values.json").has_value();
  };
  EXPECT_TRUE(loads(kMostJsonFileValues, "0"));
  EXPECT_FALSE(loads(kMostJsonFileValues + 1, "0"));
  EXPECT_TRUE(loads(kMostJsonFileValues, "\"" + std::string(1000, ',') + "\\\"," + "\""));
}

TEST(Json, RefusesNumbersThatOverflow) {
  EXPECT_FALSE(parse_json("[1e999]", "x"));
}

TEST(Json, NeverThrowsOnDamagedText) {
  const std::string good =
      R"({"markups": [{"type": "Line", "points": [[1.5, -2, 3e4], [0, 1, 2]], "name": "\u00e4"}]})";
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_FALSE(parse_json(good.substr(0, n), "cut")) << n;
  Random random(7);
  for (int round = 0; round < 20000; ++round) {
    std::string bad = good;
    for (int change = 0; change < 3; ++change)
      bad[static_cast<std::size_t>(random.next() % bad.size())] = static_cast<char>(random.next() & 0xff);
    const auto json = parse_json(bad, "fuzz");
    if (!json) {
      EXPECT_NE(json.error().where.find("fuzz"), std::string::npos);
    }
  }
}

TEST(Json, ReplacesInvalidUtf8WithoutThrowing) {
  const Json json = {{"file", std::string("a\xff.nii")}};
  EXPECT_TRUE(parse_json(json_text(json), "own"));
}

TEST(Json, MissingFileIsAnErrorWithItsPath) {
  const auto json = load_json("/nonexistent/file.json");
  ASSERT_FALSE(json);
  EXPECT_NE(json.error().text().find("/nonexistent/file.json"), std::string::npos);
}

}  // namespace
}  // namespace trocar::config
