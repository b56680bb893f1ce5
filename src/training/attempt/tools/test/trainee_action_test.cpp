#include "attempt/tools/trainee_action.h"

#include <gtest/gtest.h>

namespace trocar::attempt {
namespace {

TEST(TraineeAction, FollowsFromTaskAndNeedle) {
  tasks::Needle chiba;
  chiba.inner_diameter_mm = 0.5;
  chiba.stylet_diameter_mm = 0.36;
  EXPECT_EQ(actions_of({}, chiba), (std::vector{TraineeAction::kStylet, TraineeAction::kAspirate}));
  chiba.stylet_diameter_mm = 0.0;
  EXPECT_EQ(actions_of({}, chiba), std::vector{TraineeAction::kAspirate});
  chiba.is_biopsy = true;
  EXPECT_EQ(actions_of({}, chiba), std::vector{TraineeAction::kLoad});
}

TEST(TraineeAction, SecondOneReversesOrAdvancesTheWire) {
  ActionState state;
  EXPECT_EQ(request_of(TraineeAction::kStylet, state).kind, tasks::ActionKind::kDrawStylet);
  EXPECT_EQ(request_of(TraineeAction::kBreath, state).kind, tasks::ActionKind::kHoldBreath);
  EXPECT_EQ(request_of(TraineeAction::kAnaesthetic, state).amount, 5.0);
  EXPECT_EQ(request_of(TraineeAction::kWire, state).amount, 50.0);
  state = {.is_stylet_drawn = true, .is_breath_held = true, .wire_mm = 50.0, .can_act = true};
  EXPECT_EQ(request_of(TraineeAction::kStylet, state).kind, tasks::ActionKind::kReplaceStylet);
  EXPECT_EQ(request_of(TraineeAction::kBreath, state).kind, tasks::ActionKind::kBreathe);
  EXPECT_EQ(request_of(TraineeAction::kWire, state).amount, 100.0);
}

TEST(TraineeAction, StyletInTheNeedleBlocksSyringeAndWire) {
  tasks::Needle chiba;
  chiba.stylet_diameter_mm = 0.363;
  ActionState state{.can_act = true};
  EXPECT_EQ(why_not(TraineeAction::kAspirate, state, chiba), Obstacle::kStyletInside);
  EXPECT_EQ(why_not(TraineeAction::kWire, state, chiba), Obstacle::kStyletInside);
  EXPECT_EQ(why_not(TraineeAction::kStylet, state, chiba), Obstacle::kNone);
  state.is_stylet_drawn = true;
  EXPECT_EQ(why_not(TraineeAction::kAspirate, state, chiba), Obstacle::kNone);
  EXPECT_EQ(why_not(TraineeAction::kAnaesthetic, {}, chiba), Obstacle::kNotRunning);
}

TEST(TraineeAction, GunLoadsOutsideOrThroughACoaxialNeedle) {
  tasks::Needle gun;
  gun.is_biopsy = true;
  const auto obstacle = [&](bool is_loaded, bool is_outside) {
    return why_not(TraineeAction::kLoad, {.can_act = true, .is_gun_loaded = is_loaded, .is_outside = is_outside}, gun);
  };
  EXPECT_EQ(obstacle(true, true), Obstacle::kGunLoaded);
  EXPECT_EQ(obstacle(false, true), Obstacle::kNone);
  EXPECT_EQ(obstacle(false, false), Obstacle::kNeedleInside);
  gun.is_coaxial = true;
  EXPECT_EQ(obstacle(false, false), Obstacle::kNone);
}

}  // namespace
}  // namespace trocar::attempt
