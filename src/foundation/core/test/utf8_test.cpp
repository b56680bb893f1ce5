#include <gtest/gtest.h>

#include <string>

#include "core/text.h"

namespace trocar {
inline namespace core {
namespace {

std::string encoded(char32_t c) {
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | ((c >> shift) & 0x3F)); };
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xC0 | (c >> 6)), tail(0)};
  if (c < 0x10000) return {static_cast<char>(0xE0 | (c >> 12)), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | (c >> 18)), tail(12), tail(6), tail(0)};
}

TEST(Utf8, ReadsEveryCodePointButSurrogates) {
  for (char32_t c = 0; c <= 0x10FFFF; ++c) {
    const std::string text = encoded(c) + "rest";
    const auto first = first_character(text);
    ASSERT_EQ(first.has_value(), c < 0xD800 || c > 0xDFFF) << static_cast<std::uint32_t>(c);
    if (!first) continue;
    ASSERT_EQ(first->code_point, c);
    ASSERT_EQ(first->bytes, text.size() - 4);
  }
}

TEST(Utf8, RefusesMalformedText) {
  for (const std::string text :
       {"", "\x80", "\xBF", "\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80",
        "\xF5\x80\x80\x80", "\xFF", "\xC3", "\xC3(", "\xE2\x82", "\xE2\x82(", "\xF0\x9D\x9B", "\xF8\x88\x80\x80\x80"})
    EXPECT_FALSE(first_character(text)) << text;
}

TEST(Utf8, ReplacesMalformedBytesOnly) {
  EXPECT_EQ(valid_utf8("Leber \u00e4 \U0001d6ff"), "Leber \u00e4 \U0001d6ff");
  EXPECT_EQ(valid_utf8("\xE4rztin"), "\uFFFDrztin");
  EXPECT_EQ(valid_utf8("a\xE2\x82"), "a\uFFFD\uFFFD");
  EXPECT_EQ(valid_utf8(""), "");
}

}  // namespace
}  // namespace core
}  // namespace trocar
