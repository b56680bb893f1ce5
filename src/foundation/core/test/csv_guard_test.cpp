#include <gtest/gtest.h>

#include "core/random.h"
#include "core/text.h"

namespace trocar {
inline namespace core {
namespace {

TEST(CsvGuard, MarksFormulas) {
  for (const char* formula : {"=1+1", "+1", "-1", "@SUM(1)", "\ta", "\ra", "\na", " =1", "\"=1",
                              "\xef\xbc\x9d"
                              "1"})
    EXPECT_EQ(guard_formulas(formula), std::string("'") + formula);
  for (const char* plain : {"", "a", "a=1", "a-1", "1", " ", "ä", "don't", "a, b; c"})
    EXPECT_EQ(guard_formulas(plain), plain);
}

/// A spreadsheet of another country separates by semicolons, and does not see a quotation that begins inside a cell.
TEST(CsvGuard, MarksFormulasInsideAText) {
  EXPECT_EQ(guard_formulas("a;=1+1"), "a;'=1+1");
  EXPECT_EQ(guard_formulas("a,@x"), "a,'@x");
  EXPECT_EQ(guard_formulas("a; \"=1;b"), "a;' \"=1;b");
  EXPECT_EQ(guard_formulas("a\n-1"), "a\n'-1");
}

TEST(CsvGuard, RoundTrips) {
  constexpr std::string_view kPieces[] = {"=", "+",  "-", "@", "\t", "\r", "\n",
                                          "'", "\"", ";", ",", " ",  "a",  "\xef\xbc\x9d"};
  Random random(7);
  for (int round = 0; round < 20'000; ++round) {
    std::string text;
    for (std::uint64_t n = random.next() % 9; n > 0; --n) text += kPieces[random.next() % std::size(kPieces)];
    EXPECT_EQ(without_formula_guards(guard_formulas(text)), text);
  }
}

TEST(CsvGuard, KeepsOtherApostrophes) {
  for (const char* text : {"'", "'a", "don't", "a;'b", "' "}) EXPECT_EQ(without_formula_guards(text), text);
}

}  // namespace
}  // namespace core
}  // namespace trocar
