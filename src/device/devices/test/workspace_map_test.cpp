#include "devices/workspace_map.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "devices/haptic_device.h"
#include "devices/test/random_vec.h"

namespace trocar::devices {
namespace {

using testing::random_vec;

Pose random_pose(Random& random) {
  return {rotation_from_vector(random_vec(random, 1.5)), random_vec(random, 100.0)};
}
double distance(const Pose& a, const Pose& b) {
  return (a.p() - b.p()).norm() + rotation_vector(a.R() * b.R().transpose()).norm();
}

WorkspaceParams turned_and_scaled() {
  WorkspaceParams params;
  params.X_WD = Pose(rotation_from_vector({0.1, -0.4, 1.2}), {300.0, -50.0, 900.0});
  params.motion_scale = 2.5;
  params.force_scale = 0.3;
  params.clutch = kButtonSecond;
  return params;
}

TEST(WorkspaceMap, EqualsTheCalibrationAtUnitScale) {
  WorkspaceParams params;
  params.X_WD = Pose(rotation_from_vector({0.3, 0.2, 0.1}), {1.0, 2.0, 3.0});
  WorkspaceState state;
  Random random(1);
  const Pose X_DS = random_pose(random);
  EXPECT_LT(distance(map_to_room(state, params, X_DS, ~0u), params.X_WD * X_DS), 1e-12);  // no button is the clutch
}

TEST(WorkspaceMap, ScalesMotionAboutTheDeviceOriginButNotAngles) {
  const WorkspaceParams params = turned_and_scaled();
  WorkspaceState state;
  const Pose middle = map_to_room(state, params, Pose(), 0);
  EXPECT_LT((middle.p() - params.X_WD.p()).norm(), 1e-12);
  const Mat3 R_DS = rotation_from_vector({0.0, 0.7, 0.0});
  const Pose away = map_to_room(state, params, Pose(R_DS, {10.0, 0.0, 0.0}), 0);
  EXPECT_NEAR((away.p() - middle.p()).norm(), 25.0, 1e-9);
  EXPECT_LT((away.R() - params.X_WD.R() * R_DS).norm(), 1e-12);
}

TEST(WorkspaceMap, InverseUndoesTheMap) {
  const WorkspaceParams params = turned_and_scaled();
  Random random(2);
  WorkspaceState state;
  for (int i = 0; i < 500; ++i) {
    const Pose X_DS = random_pose(random);
    const Pose X_WS = map_to_room(state, params, X_DS, 0);
    ASSERT_LT(distance(map_from_room(state, params, X_WS), X_DS), 1e-9);
    if (i % 5 == 0) map_to_room(state, params, X_DS, kButtonSecond);  // and after any clutching
  }
  const WorkspaceState fresh;
  const Pose X_WS = random_pose(random);
  WorkspaceState started;
  EXPECT_LT(distance(map_to_room(started, params, map_from_room(fresh, params, X_WS), 0), X_WS), 1e-9);
}

TEST(Clutch, HoldsTheToolAndReleasesItWithoutAJump) {
  const WorkspaceParams params = turned_and_scaled();
  Random random(3);
  WorkspaceState state;
  Pose X_DS;
  Pose X_WS = map_to_room(state, params, X_DS, 0);
  for (int round = 0; round < 200; ++round) {
    const Pose before = X_WS;
    X_WS = map_to_room(state, params, X_DS, kButtonSecond | kButtonMain);
    ASSERT_LT(distance(X_WS, before), 1e-9) << "pressed";
    X_DS = random_pose(random);
    ASSERT_LT(distance(map_to_room(state, params, X_DS, kButtonSecond), X_WS), 1e-9) << "held";
    X_DS = random_pose(random);
    ASSERT_LT(distance(map_to_room(state, params, X_DS, kButtonMain), X_WS), 1e-9) << "released";
    X_DS = random_pose(random);
    X_WS = map_to_room(state, params, X_DS, 0);
  }
  EXPECT_LT((X_WS.R().transpose() * X_WS.R() - Mat3::Identity()).norm(), 1e-10);
}

TEST(Clutch, NeverTurnsTheDirectionsOfMotionAndForce) {
  const WorkspaceParams params = turned_and_scaled();
  WorkspaceState state;
  map_to_room(state, params, Pose(), 0);
  const Wrench push_W{{1.0, 2.0, 3.0}, {10.0, 20.0, 30.0}};
  const Wrench before = map_to_device(state, params, push_W);
  map_to_room(state, params, Pose(), kButtonSecond);
  const Pose X_DS(rotation_from_vector({1.0, -0.5, 0.3}), {20.0, 30.0, -40.0});
  const Pose from = map_to_room(state, params, X_DS, 0);
  const Pose to = map_to_room(state, params, Pose(X_DS.R(), X_DS.p() + Vec3(0.0, 0.0, 2.0)), 0);
  EXPECT_LT((to.p() - from.p() - params.X_WD.R() * Vec3(0.0, 0.0, 5.0)).norm(), 1e-9);
  EXPECT_LT((map_to_device(state, params, push_W).force_n - before.force_n).norm(), 1e-12);
  // A turn of the hand about a line of the room turns the tool about the same one.
  const Mat3 turn = rotation_from_vector({0.0, 0.2, 0.0});
  const Pose turned = map_to_room(state, params, Pose(turn * X_DS.R(), X_DS.p()), 0);
  const Mat3 R_WD = params.X_WD.R();
  EXPECT_LT((turned.R() * from.R().transpose() - R_WD * turn * R_WD.transpose()).norm(), 1e-12);
}

TEST(Clutch, GivesNoForceWhilePressed) {
  const WorkspaceParams params = turned_and_scaled();
  WorkspaceState state;
  map_to_room(state, params, Pose(), 0);
  const Wrench push_W{{1.0, 2.0, 3.0}, {10.0, 20.0, 30.0}};
  const Wrench free = map_to_device(state, params, push_W);
  EXPECT_LT((free.force_n - 0.3 * (params.X_WD.R().transpose() * push_W.force_n)).norm(), 1e-12);
  EXPECT_LT((free.torque_nmm - 0.3 * (params.X_WD.R().transpose() * push_W.torque_nmm)).norm(), 1e-12);
  map_to_room(state, params, Pose(), kButtonSecond);
  EXPECT_EQ(map_to_device(state, params, push_W).force_n.norm(), 0.0);
  EXPECT_EQ(map_to_device(state, params, push_W).torque_nmm.norm(), 0.0);
  map_to_room(state, params, Pose(), 0);
  EXPECT_EQ(map_to_device(state, params, push_W).force_n, free.force_n);
}

TEST(Clutch, SurvivesNonFiniteReadings) {
  const WorkspaceParams params = turned_and_scaled();
  const Pose bad = Pose::translation(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  WorkspaceState state;
  EXPECT_FALSE(map_to_room(state, params, bad, kButtonSecond).is_finite());  // the tick refuses it
  const Pose before = map_to_room(state, params, Pose::translation({1.0, 2.0, 3.0}), kButtonSecond);
  ASSERT_TRUE(before.is_finite());
  EXPECT_FALSE(map_to_room(state, params, bad, 0).is_finite());
  EXPECT_LT(distance(map_to_room(state, params, Pose::translation({9.0, 2.0, 3.0}), 0), before), 1e-9);
}

TEST(WorkspaceMap, NeverAllocates) {
  const WorkspaceParams params = turned_and_scaled();
  WorkspaceState state;
  const testing::AllocationGuard guard;
  Pose X_WS = map_to_room(state, params, Pose(), 0);
  X_WS = map_to_room(state, params, X_WS, kButtonSecond);
  X_WS = map_from_room(state, params, map_to_room(state, params, X_WS, 0));
  const Wrench wrench = map_to_device(state, params, {Vec3::Ones(), Vec3::Ones()});
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(X_WS.is_finite() && wrench.force_n.allFinite());
}

TEST(WorkspaceMap, ReadsItsParametersFromThePreset) {
  stylus::DevicePreset preset;
  preset.force_scale = 0.25;
  preset.motion_scale = 3.0;
  preset.clutch_button = 2;
  preset.X_WD = Pose::translation({1.0, 2.0, 3.0});
  const WorkspaceParams params = workspace_params(preset);
  EXPECT_EQ(params.force_scale, 0.25);
  EXPECT_EQ(params.motion_scale, 3.0);
  EXPECT_EQ(params.clutch, kButtonSecond);
  EXPECT_EQ(params.X_WD.p(), preset.X_WD.p());
  preset.clutch_button = 1;
  EXPECT_EQ(workspace_params(preset).clutch, kButtonMain);
  preset.clutch_button = 0;
  EXPECT_EQ(workspace_params(preset).clutch, 0u);
}

}  // namespace
}  // namespace trocar::devices
