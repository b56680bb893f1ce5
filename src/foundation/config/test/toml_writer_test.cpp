#include "config/toml_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "config/toml.h"
#include "core/random.h"

namespace trocar::config {
namespace {

using Entries = std::vector<TomlValue::Entry>;

TomlTable parsed(const std::string& text) {
  auto table = parse_toml(text, "written");
  EXPECT_TRUE(table) << table.error().text() << "\n" << text;
  return table ? *table : TomlTable();
}

TEST(TomlWriter, WritesKeysAndTablesInCallOrder) {
  TomlWriter writer;
  writer.comment("A test.");
  writer.set("second", 2);
  writer.set("first", true);
  writer.begin_table({"tissues", "liver"});
  writer.set("k", Entries{{"value", 0.5}, {"source", "paper A"}});
  writer.begin_table({"tissues", "fat"});
  writer.set("list", std::vector<double>{1.5, 2.0});
  writer.begin_row("rows");
  writer.set("id", 1);
  writer.begin_row("rows");
  writer.set("names", std::vector<std::string>{});
  EXPECT_EQ(writer.text(),
            "# A test.\nsecond = 2\nfirst = true\n\n[tissues.liver]\nk = {value = 0.5, source = \"paper A\"}\n\n"
            "[tissues.fat]\nlist = [1.5, 2.0]\n\n[[rows]]\nid = 1\n\n[[rows]]\nnames = []\n");
  const TomlTable table = parsed(writer.text());
  EXPECT_EQ(table.table("tissues")->keys(), (std::vector<std::string>{"liver", "fat"}));
  EXPECT_EQ(table.tables("rows")->size(), 2u);
}

TEST(TomlWriter, StartsADocumentOfTablesWithoutABlankLine) {
  TomlWriter writer;
  writer.begin_table({"path"});
  EXPECT_EQ(writer.text(), "[path]\n");
}

TEST(TomlWriter, RoundTripsNumbersBitwise) {
  Random random(8);
  constexpr double kHuge = std::numeric_limits<double>::max();
  std::vector<double> numbers{0.0, -0.0, 1.0, 1e15, 1e16, 1e22, 1e-7, kHuge, -0.25, std::numeric_limits<double>::min()};
  for (int n = 0; n < 1000; ++n) numbers.push_back(random.normal() * std::pow(10.0, random.uniform(-300.0, 300.0)));
  TomlWriter writer;
  writer.set("numbers", numbers);
  const auto read = parsed(writer.text()).numbers("numbers", {-kHuge, kHuge});
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->size(), numbers.size());
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    EXPECT_EQ((*read)[n], numbers[n]);
    EXPECT_EQ(std::signbit((*read)[n]), std::signbit(numbers[n])) << numbers[n];
  }
}

TEST(TomlWriter, WritesIntegersAndBooleans) {
  TomlWriter writer;
  writer.set("least", std::int64_t{-9'000'000'000'000'000});
  writer.set("byte", std::uint8_t{255});
  writer.set("no", false);
  EXPECT_EQ(writer.text(), "least = -9000000000000000\nbyte = 255\nno = false\n");
}

TEST(TomlWriter, RoundTripsEveryText) {
  std::string controls = "from ";
  for (char c = 1; c < 0x20; ++c) controls += c;
  controls += '\0';
  controls += '\x7f';
  const std::vector<std::string> texts{"",
                                       "plain",
                                       "it's \"quoted\" \\ back\\",
                                       "two\r\nlines\ttab",
                                       "Leber \u00e4 \u2192 \U0001d6ff \u2028",
                                       "true",
                                       controls,
                                       "\"\"\"",
                                       "\'\'\'"};
  for (const std::string& text : texts) {
    TomlWriter writer;
    writer.set("text", text);
    writer.set("list", std::vector<std::string>{text, text});
    const TomlTable table = parsed(writer.text());
    EXPECT_EQ(table.string("text").value_or("?"), text) << writer.text();
    EXPECT_EQ(table.strings("list").value_or(std::vector<std::string>()), (std::vector<std::string>{text, text}));
  }
}

TEST(TomlWriter, RoundTripsEveryKey) {
  for (const char* name : {"liver", "rib 9", "a.b", "\u00e4", "it's", "\"q\"", "1", "", "a\tb"}) {
    TomlWriter writer;
    writer.set(name, Entries{{name, 1.0}});
    writer.begin_table({"all tissues", name});
    const TomlTable table = parsed(writer.text());
    ASSERT_TRUE(table.table(name)) << writer.text();
    EXPECT_EQ(table.table(name)->keys(), (std::vector<std::string>{name}));
    EXPECT_EQ(table.table("all tissues")->keys(), (std::vector<std::string>{name}));
  }
}

TEST(TomlWriter, ReplacesMalformedText) {
  TomlWriter writer;
  writer.set("name", "\xE4rztin");
  EXPECT_EQ(parsed(writer.text()).string("name").value_or("?"), "\uFFFDrztin");
}

TEST(TomlWriter, BreaksLongListsIntoLines) {
  TomlWriter writer;
  writer.set("list", std::vector<std::string>(30, "a text"));
  EXPECT_TRUE(writer.text().starts_with("list = [\n  \"a text\",\n  \"a text\",\n")) << writer.text();
  EXPECT_EQ(parsed(writer.text()).strings("list").value().size(), 30u);
}

TEST(TomlWriter, WritesTheShortestDigitsThatReadBack) {
  const auto text = [](double value) { return TomlValue(value).text(); };
  EXPECT_EQ(text(0.46), "0.46");
  EXPECT_EQ(text(0.1), "0.1");
  EXPECT_EQ(text(2.0), "2.0");
  EXPECT_EQ(text(-0.0), "-0.0");
  EXPECT_EQ(text(1e300), "1e+300");
  EXPECT_EQ(text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

}  // namespace
}  // namespace trocar::config
