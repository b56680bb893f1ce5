#include <gtest/gtest.h>

#include <clocale>
#include <cstdio>
#include <sstream>
#include <string>

#include "core/testing/user_locale.h"
#include "core/text.h"

namespace trocar {
namespace {

std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string streamed(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

std::string locale_of_c(int category) {
  return std::setlocale(category, nullptr);
}

TEST(DecimalPoint, ForcesADecimalPointInItsScope) {
  const testing::UserLocale user("de_DE.UTF-8");
  if (!user.is_there()) GTEST_SKIP() << "de_DE.UTF-8 is not on this machine";
  EXPECT_EQ(printed(3.75), "3,75");
  EXPECT_EQ(streamed(1234.5), "1.234,5");
  {
    const DecimalPoint outer;
    const DecimalPoint inner;
    EXPECT_EQ(printed(3.75), "3.75");
    EXPECT_EQ(streamed(1234.5), "1234.5");
  }
  EXPECT_EQ(printed(3.75), "3,75");
  EXPECT_EQ(streamed(1234.5), "1.234,5");
}

// A program may have different locales for C and C++.
TEST(DecimalPoint, TheGlobalLocaleOfCIsNotChanged) {
  const testing::UserLocale user("de_DE.UTF-8");
  if (!user.is_there()) GTEST_SKIP() << "de_DE.UTF-8 is not on this machine";
  std::setlocale(LC_NUMERIC, "C");
  const std::string before = locale_of_c(LC_ALL);
  {
    const DecimalPoint point;
    EXPECT_EQ(locale_of_c(LC_ALL), before);
  }
  EXPECT_EQ(locale_of_c(LC_ALL), before);
  EXPECT_EQ(locale_of_c(LC_CTYPE), "de_DE.UTF-8");
  EXPECT_EQ(std::locale().name(), "de_DE.UTF-8");
}

}  // namespace
}  // namespace trocar
