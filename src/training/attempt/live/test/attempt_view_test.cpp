#include "attempt/live/attempt_view.h"

#include <gtest/gtest.h>

namespace trocar::attempt {
namespace {

AttemptView view_in(AttemptPhase phase) {
  AttemptView view;
  view.phase = phase;
  view.hint = "go on";
  return view;
}

TEST(AttemptView, ReportsALostServerWhenTheViewIsTooOld) {
  for (const AttemptPhase phase : {AttemptPhase::kReady, AttemptPhase::kInBody}) {
    const AttemptView old = aged(view_in(phase), 0.3);
    EXPECT_EQ(old.phase, AttemptPhase::kServerLost);
    EXPECT_NE(old.banner, "");
    EXPECT_EQ(old.hint, "");
    EXPECT_EQ(aged(view_in(phase), 0.1).phase, phase);
    EXPECT_EQ(aged(view_in(phase), 0.1).banner, "");
  }
}

TEST(AttemptView, NeverAgesWhileNoNeedleMoves) {
  for (const AttemptPhase phase : {AttemptPhase::kStarting, AttemptPhase::kStopped, AttemptPhase::kFinishing,
                                   AttemptPhase::kFinished, AttemptPhase::kFailed}) {
    EXPECT_EQ(aged(view_in(phase), 60.0).phase, phase);
    EXPECT_EQ(aged(view_in(phase), 60.0).banner, "");
  }
}

}  // namespace
}  // namespace trocar::attempt
