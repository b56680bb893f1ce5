#include <gtest/gtest.h>

#include "config/toml.h"

namespace trocar::config {
namespace {

Result<SourcedNumber> read(const std::string& entry) {
  return read_sourced_number(*parse_toml("k = " + entry, "t.toml"), "k", {0.0, 10.0});
}

TEST(SourcedNumber, CarriesValueSourceAndRange) {
  const auto number = read(R"({value = 2.8, source = "doi x", range = [2.75, 2.8]})");
  ASSERT_TRUE(number);
  EXPECT_EQ(number->value, 2.8);
  EXPECT_EQ(number->source, "doi x");
  EXPECT_EQ(number->range->low, 2.75);
  EXPECT_FALSE(read(R"({value = 1, source = "paper A, Table 1"})")->range);
}

TEST(SourcedNumber, RefusesIncompleteOrOutOfRangeNumbers) {
  for (const char* bad :
       {"3.0", R"({value = 11, source = "x"})", R"({value = nan, source = "x"})", R"({value = 1})",
        R"({value = 1, source = ""})", R"({value = 1, source = "assumed"})",
        R"({value = 1, source = "assumed", range = [2, 3]})", R"({value = 1, source = "assumed", range = [1]})",
        R"({value = 1, source = "x", note = "y"})"})
    EXPECT_FALSE(read(bad)) << bad;
}

}  // namespace
}  // namespace trocar::config
