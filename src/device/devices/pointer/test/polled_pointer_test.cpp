#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/testing/no_threads.h"
#include "devices/pointer/pointer_device.h"
#include "devices/test/bad_numbers.h"
#include "devices/test/bounded_wait.h"

namespace trocar::devices {
namespace {

using testing::kInfinity;
using testing::kNaN;

constexpr double kRadius_mm = 50.0;

PointerMotion sideways(double mm_per_s) {
  PointerMotion motion;
  motion.v_D.x() = mm_per_s;
  return motion;
}

/// Asks for the same motion until it is told to fall silent.
class SteadySource final : public PointerSource {
 public:
  explicit SteadySource(const std::atomic<bool>& is_silent) : is_silent_(is_silent) {}
  std::string name() const override { return "steady"; }
  Status open() override { return {}; }
  bool poll(PointerMotion& motion) noexcept override {
    testing::wait_until([this] { return !is_silent_; });
    motion = sideways(10.0);
    return true;
  }
  void close() noexcept override {}

 private:
  const std::atomic<bool>& is_silent_;
};

TEST(MovePointer, MatchesTheClosedFormForAStraightMotion) {
  PointerMotion motion;
  motion.v_D = Vec3(1.0, 2.0, 3.0);
  motion.inward_mm_per_s = 10.0;  // down at the start
  const Pose moved = move_pointer(pointer_start(), motion, 0.5, kRadius_mm);
  EXPECT_NEAR((moved.p() - Vec3(0.5, 1.0, -3.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((moved.R() - pointer_start().R()).norm(), 0.0, 1e-12);
}

TEST(MovePointer, TurningRotatesTheBevelOnly) {
  PointerMotion motion;
  motion.turning_rad_per_s = 1.0;
  const Mat3 R_DS = move_pointer(pointer_start(), motion, 0.5, kRadius_mm).R();
  EXPECT_NEAR((R_DS.col(2) - pointer_start().R().col(2)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(angle_between_rad(R_DS.col(1), pointer_start().R().col(1)), 0.5, 1e-12);
}

TEST(MovePointer, StaysInTheWorkspaceForAnyRequest) {
  Random random(7);
  Pose X_DS = pointer_start();
  constexpr int kSteps = 20'000;
  for (int i = 0; i < kSteps; ++i) {
    const auto any = [&] { return random.uniform(-200.0, 200.0); };
    const PointerMotion motion{Vec3(any(), any(), any()), any(), Vec3(any(), any(), any()), any(), 0};
    X_DS = move_pointer(X_DS, motion, 0.02, kRadius_mm);
    ASSERT_LE(X_DS.p().norm(), kRadius_mm * (1 + 1e-12));
    ASSERT_NEAR((X_DS.R() * X_DS.R().transpose() - Mat3::Identity()).norm(), 0.0, 1e-12);
  }
}

TEST(MovePointer, IgnoresNonFiniteInput) {
  const Pose start = pointer_start();
  for (const double bad : {kNaN, kInfinity}) {
    EXPECT_EQ(move_pointer(start, sideways(bad), 0.01, kRadius_mm).p(), start.p());
    EXPECT_EQ(move_pointer(start, sideways(1.0), bad, kRadius_mm).p(), start.p());
  }
  EXPECT_EQ(move_pointer(start, sideways(1.0), -1.0, kRadius_mm).p(), start.p());
  EXPECT_TRUE(move_pointer(start, sideways(1e308), 1e10, kRadius_mm).is_finite());
}

TEST(PolledPointer, MovesAtEveryReadAndStopsIfItsThreadHangs) {
  std::atomic<bool> is_silent{false};
  stylus::DevicePreset preset;
  preset.workspace_radius_mm = kRadius_mm;
  const auto device = PolledPointer::open(preset, std::make_unique<SteadySource>(is_silent));
  ASSERT_TRUE(device.has_value());
  double now_s = 5.0;
  ASSERT_TRUE(testing::wait_until([&] { return (*device)->read(now_s).status == DeviceStatus::kFresh; }));
  is_silent = true;
  ASSERT_TRUE(testing::wait_until([&] {
    // Each reading moves on by its millisecond, without news of the thread.
    now_s += 0.001;
    const double before_mm = (*device)->read(now_s).X_DS.p().x();
    now_s += 0.001;
    EXPECT_NEAR((*device)->read(now_s).X_DS.p().x() - before_mm, 0.01, 1e-9);
    return before_mm > 0.2;
  }));
  now_s += 2 * kPointerSilence_s;
  (*device)->read(now_s);  // may hold the last news
  now_s += 2 * kPointerSilence_s;
  const DeviceReading hung = (*device)->read(now_s);
  EXPECT_EQ(hung.status, DeviceStatus::kRepeated);
  EXPECT_EQ((*device)->read(now_s + 1.0).X_DS.p(), hung.X_DS.p());
  is_silent = false;
  EXPECT_TRUE(testing::wait_until([&] { return (*device)->read(now_s).status == DeviceStatus::kFresh; }));
}

TEST(PolledPointer, ContinuesFromAPlacement) {
  const std::atomic<bool> is_silent{false};
  stylus::DevicePreset preset;
  preset.workspace_radius_mm = kRadius_mm;
  const auto device = PolledPointer::open(preset, std::make_unique<SteadySource>(is_silent));
  ASSERT_TRUE(device.has_value());
  ASSERT_TRUE(testing::wait_until([&] { return (*device)->read(1.0).status == DeviceStatus::kFresh; }));
  DeviceHand hand;
  hand.X_DS = Pose::translation(Vec3(1.0, 2.0, 3.0));
  hand.time_s = 7.0;
  hand.is_placed = true;
  (*device)->hold(hand);
  EXPECT_EQ((*device)->read(1.0).X_DS.p(), hand.X_DS.p());
  const Pose moved = (*device)->read(1.01).X_DS;
  (*device)->hold(hand);  // the same again, as every period
  EXPECT_EQ((*device)->read(1.01).X_DS.p(), moved.p());
  EXPECT_NEAR(moved.p().x(), 1.1, 1e-9);
  hand.time_s = 8.0;
  hand.X_DS = Pose::translation(Vec3(kNaN, 0.0, 0.0));
  (*device)->hold(hand);
  EXPECT_EQ((*device)->read(1.01).X_DS.p(), moved.p());
}

TEST(PolledPointer, FailsToOpenAndReconnectWithoutAThread) {
  const std::atomic<bool> is_silent{false};
  stylus::DevicePreset preset;
  preset.workspace_radius_mm = kRadius_mm;
  const auto device = PolledPointer::open(preset, std::make_unique<SteadySource>(is_silent));
  ASSERT_TRUE(device.has_value());
  {
    const trocar::testing::NoThreads none;
    EXPECT_FALSE(PolledPointer::open(preset, std::make_unique<SteadySource>(is_silent)));
    const Status refused = (*device)->reconnect();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().what.find("does not start"), std::string::npos);
    EXPECT_EQ((*device)->read(1.0).status, DeviceStatus::kDisconnected);
    EXPECT_FALSE((*device)->write(Wrench{}));
  }
  EXPECT_TRUE((*device)->reconnect());
  EXPECT_TRUE(testing::wait_until([&] { return (*device)->read(1.0).status == DeviceStatus::kFresh; }));
}

}  // namespace
}  // namespace trocar::devices
