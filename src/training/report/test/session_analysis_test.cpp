#include "report/session_analysis.h"

#include <gtest/gtest.h>

#include "report/test/example_attempt.h"

namespace trocar::report {
namespace {

using testing::example_attempt;

TEST(SessionAnalysis, FindsPuncturesWithPeakAndDrop) {
  const auto punctures = find_punctures(example_attempt());
  ASSERT_EQ(punctures.size(), 3u);
  EXPECT_EQ(punctures[0].layer, "skin");
  EXPECT_EQ(punctures[2].layer, "liver_capsule");
  EXPECT_NEAR(punctures[1].depth_mm, 12.0, 0.011);  // One tick at 10 mm/s.
  EXPECT_NEAR(punctures[0].layer_force_n, 2.8, 1e-9);
  EXPECT_NEAR(punctures[0].resistance_n, 2.8, 1e-9);
  EXPECT_NEAR(punctures[0].drop_n, 2.7, 1e-9);        // Down to the friction of 0.1 N.
  EXPECT_NEAR(punctures[2].resistance_n, 1.8, 1e-9);  // With a friction of 0.3 N.
  EXPECT_NEAR(punctures[2].drop_n, 1.1, 1e-9);        // Down to friction 0.3 N and cutting 0.4 N.
}

TEST(SessionAnalysis, FindsTheInsertionAndItsDepth) {
  const storage::Session session = example_attempt();
  const auto insertions = find_insertions(session);
  ASSERT_EQ(insertions.size(), 1u);
  EXPECT_EQ(session.samples[insertions[0].deepest].depth_mm, 40.0);
  EXPECT_EQ(insertions[0].last, session.samples.size() - 1);
  EXPECT_NE(session.samples[insertions[0].first].phase, telemetry::InsertionPhase::kOutside);
  EXPECT_EQ(session.samples[insertions[0].first - 1].phase, telemetry::InsertionPhase::kOutside);
}

TEST(SessionAnalysis, CountsASecondInsertionButNoTouch) {
  storage::Session session = example_attempt();
  const auto once = session.samples;
  for (const double depth_factor : {0.02, 1.0}) {  // A touch of 0.8 mm, then the whole way again.
    for (telemetry::TickSample sample : once) {
      sample.depth_mm *= depth_factor;
      session.samples.push_back(sample);
    }
  }
  EXPECT_EQ(find_insertions(session).size(), 2u);
}

TEST(SessionAnalysis, ListsTissuesByDepthOfFirstArrival) {
  storage::Session session = example_attempt();
  // The hand draws back 5 mm and goes on: nothing new is met on the way.
  for (std::size_t i = 3000; i < 3500; ++i) {
    session.samples[i].depth_mm -= 5.0;
    session.samples[i].tissue = 0;
  }
  const auto runs = tissues_along(session, find_insertions(session)[0]);
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_EQ(runs[0].from_mm, 0.0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(runs[i].tissue, i + 1);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(runs[i].from_mm, runs[i - 1].to_mm);
  EXPECT_NEAR(runs[1].from_mm, 8.0, 0.011);
  EXPECT_EQ(runs[3].to_mm, 40.0);
}

TEST(SessionAnalysis, PhasesCoverTheWholeTime) {
  const storage::Session session = example_attempt();
  const auto runs = phase_runs(session);
  EXPECT_EQ(runs.front().from_s, session.samples.front().time_s);
  EXPECT_EQ(runs.back().to_s, session.samples.back().time_s);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].from_s, runs[i - 1].to_s);
    EXPECT_NE(runs[i].phase, runs[i - 1].phase);
  }
}

}  // namespace
}  // namespace trocar::report
