#include <gtest/gtest.h>

#include "storage/score_json.h"

namespace trocar::storage::detail {
namespace {

scoring::Outcome example() {
  scoring::Outcome outcome;
  outcome.score = 71.0;
  outcome.expert = 2;
  outcome.pain_events = 3;
  outcome.bleeding = scoring::Bleeding{};
  outcome.bleeding->passes = 4;
  return outcome;
}

TEST(OutcomeJson, RoundTripsCounts) {
  const auto read = outcome_from_json(outcome_to_json(example()), "test");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->expert, 2u);
  EXPECT_EQ(read->pain_events, 3u);
  ASSERT_TRUE(read->bleeding);
  EXPECT_EQ(read->bleeding->passes, 4u);
}

/// Null is not a number: it cannot become a count.
TEST(OutcomeJson, RefusesInvalidCounts) {
  const std::string whole = outcome_to_json(example());
  for (const std::string count : {R"("expert":2)", R"("pain_events":3)", R"("passes":4)"}) {
    const std::size_t at = whole.find(count);
    ASSERT_NE(at, std::string::npos) << whole;
    for (const char* bad : {"null", "-1", "1.5", "1e300", "\"1\"", "true"}) {
      std::string damaged = whole;
      damaged.replace(at + count.size() - 1, 1, bad);
      EXPECT_FALSE(outcome_from_json(damaged, "test")) << count << " " << bad;
    }
  }
}

}  // namespace
}  // namespace trocar::storage::detail
