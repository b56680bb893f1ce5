#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "core/random.h"
#include "core/text.h"

namespace trocar {
inline namespace core {
namespace {

TEST(ParseNumber, ReadsTheWholeText) {
  EXPECT_EQ(parse_number<double>("-2.5e-3"), -2.5e-3);
  EXPECT_EQ(parse_number<double>("007"), 7.0);
  EXPECT_EQ(parse_number<int>("-12"), -12);
  EXPECT_EQ(parse_number<std::uint64_t>("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
}

TEST(ParseNumber, RefusesSignsSpacesAndOtherCharacters) {
  for (const char* text : {"", " ", "+1", " 1", "1 ", "1x", "0x10", "1,5", "1e", "--1", "1\n"}) {
    EXPECT_FALSE(parse_number<double>(text)) << text;
    EXPECT_FALSE(parse_number<int>(text)) << text;
  }
  EXPECT_FALSE(parse_number<unsigned>("-1"));
  EXPECT_FALSE(parse_number<int>("1.0"));
  EXPECT_FALSE(parse_number<int>(std::string_view("1\0", 2)));
  EXPECT_FALSE(parse_number<int>(std::string_view()));
}

TEST(ParseNumber, RefusesNonFiniteAndOutOfRangeNumbers) {
  for (const char* text : {"nan", "-nan", "nan(1)", "inf", "-inf", "infinity", "1e400", "-1e400", "1e-400"})
    EXPECT_FALSE(parse_number<double>(text)) << text;
  EXPECT_FALSE(parse_number<int>("2147483648"));
  EXPECT_FALSE(parse_number<std::uint8_t>("256"));
}

TEST(ParseNumber, RoundTripsNumbersBitwise) {
  Random random(5);
  for (int n = 0; n < 1000; ++n) {
    const double number = random.normal() * std::pow(10.0, random.uniform(-300.0, 300.0));
    char text[64];
    const auto written = std::to_chars(std::begin(text), std::end(text), number);
    EXPECT_EQ(parse_number<double>({text, static_cast<std::size_t>(written.ptr - text)}), number);
  }
}

TEST(LeadingNumber, LeavesTheRestOfTheText) {
  const auto number = find_leading_number<double>("1.5,-1024");
  ASSERT_TRUE(number);
  EXPECT_EQ(number->value, 1.5);
  EXPECT_EQ(number->rest, ",-1024");
  EXPECT_EQ(find_leading_number<int>("1.5")->rest, ".5");
  EXPECT_EQ(find_leading_number<int>("12")->rest, "");
}

TEST(LeadingNumber, IsEmptyIfTheTextStartsWithoutANumber) {
  for (const char* text : {"", "_1", " 1", "+1", "nan1", "inf,1", "1e400,1"})
    EXPECT_FALSE(find_leading_number<double>(text)) << text;
}

}  // namespace
}  // namespace core
}  // namespace trocar
