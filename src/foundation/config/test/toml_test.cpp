#include "config/toml.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace trocar::config {
namespace {

constexpr std::string_view kExample = R"(# a tissue file
title = "Ünïcode"
[tissues.liver]
viscosity = {value = 0.02, source = "paper A", range = [0.01, 0.05]}
count = 3
is_soft = true
names = ["liver", 'S1.S2']
[tissues.air]
[[needles]]
gauge = 18
[[needles]]
gauge = 22.5
text = """two
lines"""
)";

TomlTable example() {
  return *parse_toml(kExample, "tissues.toml");
}

template <class T>
std::string error_of(const Result<T>& result) {
  return result ? std::string("no error") : result.error().text();
}

TEST(Toml, GettersReturnTheFilesValues) {
  const TomlTable liver = *example().table("tissues")->table("liver");
  EXPECT_EQ(example().string("title"), "Ünïcode");
  EXPECT_EQ(liver.table("viscosity")->number("value", {0, 1}), 0.02);
  EXPECT_EQ(liver.table("viscosity")->numbers("range", {0, 1}), (std::vector<double>{0.01, 0.05}));
  EXPECT_EQ(liver.integer("count", {0, 10}), 3);
  EXPECT_EQ(liver.number("count", {0, 10}), 3.0) << "an integer is a number";
  EXPECT_EQ(liver.boolean_or("is_soft", false), true);
  EXPECT_EQ(liver.boolean_or("is_hard", true), true);
  EXPECT_EQ(liver.strings("names"), (std::vector<std::string>{"liver", "S1.S2"}));
  EXPECT_EQ(liver.strings("nothing"), std::vector<std::string>{});
  EXPECT_EQ(liver.number_or("mu", {0, 1}, 0.58), 0.58);
  EXPECT_EQ(liver.string_or("note", "none"), "none");
  const auto needles = example().tables("needles");
  ASSERT_TRUE(needles);
  ASSERT_EQ(needles->size(), 2u);
  EXPECT_EQ((*needles)[1].number("gauge", {1, 40}), 22.5);
  EXPECT_EQ((*needles)[1].string("text"), "two\nlines");
  EXPECT_TRUE(example().tables("absent")->empty());
}

TEST(Toml, KeysComeInTheOrderOfTheFile) {
  EXPECT_EQ(parse_toml("z = 1\nb = {y = 1, x = 2}\na = 3\n[k]\n[c]\n", "f")->keys(),
            (std::vector<std::string>{"z", "b", "a", "k", "c"}));
  EXPECT_EQ(parse_toml("b = {y = 1, x = 2}", "f")->table("b")->keys(), (std::vector<std::string>{"y", "x"}));
}

TEST(Toml, TableOutlivesItsDocument) {
  TomlTable liver;
  {
    const TomlTable document = example();
    liver = *document.table("tissues")->table("liver");
  }
  EXPECT_EQ(liver.integer("count", {0, 10}), 3);
  EXPECT_EQ(liver.where(), "tissues.toml: tissues.liver");
}

TEST(Toml, AnEmptyTableHasNoKeys) {
  EXPECT_TRUE(TomlTable().keys().empty());
  EXPECT_FALSE(TomlTable().has("x"));
}

TEST(Toml, ErrorsNameFileLineKeyAndRange) {
  const TomlTable liver = *example().table("tissues")->table("liver");
  EXPECT_EQ(error_of(liver.number("count", {0.5, 2})),
            "must be a number from 0.5 to 2, it is 3 — tissues.toml, line 5: tissues.liver.count — correct the value");
  EXPECT_EQ(error_of(liver.string("count")),
            "must be a text in quotes — tissues.toml, line 5: tissues.liver.count — correct the value");
  EXPECT_EQ(error_of(liver.number("mu", {0, 2})),
            "missing: a number from 0 to 2 — tissues.toml: tissues.liver.mu — add the key");
  EXPECT_NE(error_of(liver.strings("count")).find("a list of texts"), std::string::npos);
  EXPECT_NE(error_of(liver.table("count")).find("a table"), std::string::npos);
  EXPECT_NE(error_of(liver.tables("names")).find("a list of tables"), std::string::npos);
  EXPECT_NE(error_of(liver.numbers("names", {0, 1})).find("a list, each a number"), std::string::npos);
  EXPECT_NE(error_of(liver.integer("viscosity", {0, 1})).find("a whole number"), std::string::npos);
  EXPECT_NE(error_of(liver.boolean_or("count", true)).find("true or false"), std::string::npos);
  EXPECT_EQ(error_of((*example().tables("needles"))[1].number("gauge", {1, 20})),
            "must be a number from 1 to 20, it is 22.5 — tissues.toml, line 12: needles[1].gauge — correct the value");
}

TEST(Toml, RowsRequireEqualLength) {
  const TomlTable table =
      *parse_toml("a = [[1, 2.5], [-3, 4]]\nb = []\nc = [[1, 2], [3]]\nd = [1, 2]\ne = [[1, nan]]\n", "f");
  const Range range{-3, 4};
  EXPECT_EQ(table.rows("a", 2, range), (std::vector<std::vector<double>>{{1, 2.5}, {-3, 4}}));
  EXPECT_TRUE(table.rows("b", 2, range)->empty());
  EXPECT_EQ(
      error_of(table.rows("c", 2, range)),
      "must be a list of lists of 2, each a number from -3 to 4; row 2 is not — f, line 3: c — correct the value");
  EXPECT_FALSE(table.rows("a", 3, range));
  EXPECT_FALSE(table.rows("a", 2, {-2, 4}));
  for (const char* key : {"d", "e", "absent"}) EXPECT_FALSE(table.rows(key, 2, range)) << key;
}

TEST(Toml, SyntaxErrorNamesLineAndColumn) {
  const auto table = parse_toml("a = 1\nb = = 2\n", "tasks.toml");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().where, "tasks.toml, line 2, column 5");
}

TEST(Toml, UnknownKeyIsRefusedAndTheNearestSuggested) {
  const TomlTable table = *parse_toml("stifness_n_per_mm = 1\n", "f.toml");
  EXPECT_EQ(table.check_keys({"viscosity", "stiffness_n_per_mm"}).error().text(),
            "unknown key — f.toml, line 1: stifness_n_per_mm — did you mean \"stiffness_n_per_mm\"?");
  EXPECT_EQ(table.check_keys({"x", "y"}).error().advice, "known are: x, y");
  EXPECT_TRUE(table.check_keys({"stifness_n_per_mm", "other"}));
}

TEST(Toml, NonFiniteNumbersAreRefused) {
  const TomlTable table = *parse_toml("a = nan\nb = inf\nc = -inf\nd = [1.0, nan]\n", "f");
  const Range everything{-1e308 * 10, 1e308 * 10};
  for (const char* key : {"a", "b", "c"}) EXPECT_FALSE(table.number(key, everything)) << key;
  EXPECT_FALSE(table.numbers("d", everything));
}

TEST(Toml, RefusesHostileBytesBeforeParsing) {
  for (const std::string_view bad :
       {std::string_view("[ \0B\0=", 6), std::string_view("a = \"\x01\""), std::string_view("a = 1\x7f"),
        std::string_view("a = \"\xff\""), std::string_view("a = \"\xc0\xaf\""),
        std::string_view("a = \"\xed\xa0\x80\""), std::string_view("a = \"\xf4\x90\x80\x80\""),
        std::string_view("a = \"\xe2\x82")}) {
    const auto table = parse_toml(bad, "bad.toml");
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().where, "bad.toml, line 1");
  }
  EXPECT_FALSE(parse_toml(std::string((std::size_t{1} << 20) + 1, '#'), "big"));
}

// Found by fuzzing toml++ 3.3 under sanitizers: assertions, and code that it marks unreachable but reaches.
TEST(Toml, RefusesTextThatCrashesToml33) {
  for (const char* bad : {"[ =", "ä = 1", "a = ä", "a =\xc2\xa0 1", "a = \"\"\"x \\\n ä\"\"\"", "a = \"\"\"\\ä\"\"\"",
                          "a = \"\\q\"", "a = 1\"ä\"", "a = 1.\"ä\"", "a = [\n1.\"ä\"]"})
    EXPECT_FALSE(parse_toml(bad, "bad")) << bad;
  EXPECT_TRUE(parse_toml("a = \"ä\" # ä\n\"ä\" = '\\ä'\nb = \"\"\"\\n\\\\ ä\n\"\"\"", "good"));
  EXPECT_TRUE(parse_toml("a.\"ä\".b = 1\n[c.\"ä\"]\nd = [\n\"ä\",\n'ö']\n[[e.'ä']]\n", "quoted keys"));
}

TEST(Toml, NestingIsBounded) {
  std::string dotted = "a";
  for (int n = 0; n < 200000; ++n) dotted += ".a";
  EXPECT_FALSE(parse_toml(dotted + " = 1", "dots"));
  EXPECT_FALSE(parse_toml("[" + dotted + "]", "header"));
  EXPECT_FALSE(parse_toml("x = [\"\"\"y\"\"\"\", {" + dotted + " = 1}]", "after a string that ends in a quote"));
  EXPECT_FALSE(parse_toml("x = " + std::string(100000, '['), "arrays"));
  EXPECT_TRUE(parse_toml("x = \"" + dotted + "\" # " + dotted, "dots in text"));
}

TEST(Toml, EveryTruncationIsRefusedOrRead) {
  for (std::size_t n = 0; n <= kExample.size(); ++n) {
    const auto table = parse_toml(kExample.substr(0, n), "cut");
    if (table) {
      EXPECT_LE(table->keys().size(), 3u);
    }
  }
}

// Bytes of TOML's own alphabet reach deeper into the parser than uniform ones.
TEST(Toml, SurvivesRandomBytes) {
  constexpr std::string_view kAlphabet = "[]{}=.,\"'#\n\r\t _-+:0123456789abefiltnrsuxTZ\\\xc3\xa4";
  Random random(11);
  for (int round = 0; round < 20000; ++round) {
    std::string text(static_cast<std::size_t>(random.next() % 60), ' ');
    for (char& c : text)
      c = round % 2 ? static_cast<char>(random.next() & 0xff) : kAlphabet[random.next() % kAlphabet.size()];
    const auto table = parse_toml(text, "fuzz");
    if (!table) {
      EXPECT_NE(table.error().where.find("fuzz"), std::string::npos);
    }
  }
}

TEST(Toml, SurvivesDamagedFiles) {
  Random random(12);
  for (int round = 0; round < 5000; ++round) {
    std::string text(kExample);
    for (int change = 0; change < 3; ++change)
      text[static_cast<std::size_t>(random.next() % text.size())] = static_cast<char>(random.next() % 128);
    const auto table = parse_toml(text, "fuzz");
    if (table) {
      EXPECT_TRUE(table->check_keys({}).has_value() == table->keys().empty());
    }
  }
}

}  // namespace
}  // namespace trocar::config
