#include <gtest/gtest.h>

#include <string_view>

#include "core/text.h"

namespace trocar::ascii {
namespace {

constexpr std::string_view kLower = "abcdefghijklmnopqrstuvwxyz", kUpper = "ABCDEFGHIJKLMNOPQRSTUVWXYZ",
                           kDigits = "0123456789", kSpaces = " \t\n\v\f\r";

bool is_in(std::string_view set, char c) {
  return set.find(c) != std::string_view::npos;
}

TEST(Ascii, ClassifiesEveryByte) {
  for (int byte = 0; byte < 256; ++byte) {
    const char c = static_cast<char>(byte);
    EXPECT_EQ(is_lower(c), is_in(kLower, c)) << byte;
    EXPECT_EQ(is_upper(c), is_in(kUpper, c)) << byte;
    EXPECT_EQ(is_digit(c), is_in(kDigits, c)) << byte;
    EXPECT_EQ(is_space(c), is_in(kSpaces, c)) << byte;
    EXPECT_EQ(is_letter(c), is_in(kLower, c) || is_in(kUpper, c)) << byte;
    EXPECT_EQ(is_letter_or_digit(c), is_letter(c) || is_in(kDigits, c)) << byte;
  }
}

TEST(Ascii, ChangesCaseOfLettersOnly) {
  for (int byte = 0; byte < 256; ++byte) {
    const char c = static_cast<char>(byte);
    EXPECT_EQ(to_lower(c), is_in(kUpper, c) ? kLower[kUpper.find(c)] : c) << byte;
    EXPECT_EQ(to_upper(c), is_in(kLower, c) ? kUpper[kLower.find(c)] : c) << byte;
  }
}

TEST(Ascii, LowersTextAndKeepsOtherAlphabets) {
  EXPECT_EQ(lower_case("LIVER I-9 Ä"), "liver i-9 Ä");
  EXPECT_EQ(lower_case(""), "");
}

}  // namespace
}  // namespace trocar::ascii
