// The shape of the shaft that views draw, in every force model.
#include <gtest/gtest.h>

#include "core/testing/allocation_guard.h"
#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

constexpr double kDeep_mm = 45.0, kAside_mm = 4.0;

/// In to kDeep_mm, then the hand moves aside and rests.
Driver held_aside(const std::shared_ptr<const haptics::HapticScene>& scene) {
  Driver driver(scene);
  driver.move(kDeep_mm, 20.0);
  for (double x = 0.0; x < kAside_mm; x += 0.01) driver.to({x, 0.0, kDeep_mm});
  for (int i = 0; i < 500; ++i) driver.to({kAside_mm, 0.0, kDeep_mm});
  return driver;
}

class NeedleShape : public ::testing::TestWithParam<haptics::ForceModel> {
 protected:
  std::shared_ptr<const haptics::HapticScene> scene_ = make_scene(liver_way(), GetParam());
};

TEST_P(NeedleShape, IsStraightOutsideTheBody) {
  Driver driver(scene_);
  driver.move(-2.0, 20.0);
  EXPECT_EQ(haptics::needle_shape(driver.state().needle, *scene_, true).spans, 0);
}

TEST_P(NeedleShape, StaysInItsChannelWhenTheHandMovesSideways) {
  Driver driver = held_aside(scene_);
  const telemetry::NeedleShape shape = haptics::needle_shape(driver.state().needle, *scene_, true);
  const int nodes = scene_->beam_with_stylet.node_count;
  ASSERT_EQ(shape.spans, nodes);
  const auto x_mm = [&](int node) { return static_cast<double>(shape.beside_mm[static_cast<std::size_t>(node)][0]); };
  const auto y_mm = [&](int node) { return static_cast<double>(shape.beside_mm[static_cast<std::size_t>(node)][1]); };
  // The channel lies kAside_mm beside the grip's axis; N's x is the hand's way or its opposite, as the roll is.
  const Vec3 channel_N = driver.state().needle.X_PN.R().transpose() * Vec3(-kAside_mm, 0.0, 0.0);
  const double tip_off_mm = std::hypot(x_mm(nodes - 1) - channel_N.x(), y_mm(nodes - 1) - channel_N.y());
  EXPECT_LT(tip_off_mm, 0.25 * kAside_mm);
  EXPECT_LT(std::hypot(x_mm(0), y_mm(0)), 0.05 * kAside_mm) << "the grip clamps it";
  for (int node = 1; node < nodes; ++node) EXPECT_GT(std::hypot(x_mm(node), y_mm(node)), 0.0) << "it bends at " << node;
}

TEST_P(NeedleShape, IsTheSameInEveryForceModel) {
  Driver driver = held_aside(scene_);
  const auto combined = make_scene(liver_way(), haptics::ForceModel::kCombined);
  Driver other = held_aside(combined);
  const telemetry::NeedleShape is = haptics::needle_shape(driver.state().needle, *scene_, true);
  const telemetry::NeedleShape same = haptics::needle_shape(other.state().needle, *combined, true);
  ASSERT_GT(is.spans, 0);
  EXPECT_LT(telemetry::largest_difference_mm(is, same), 0.3);  // the tips lag by different depths
}

TEST_P(NeedleShape, IsStraightForARigidNeedle) {
  haptics::HapticOptions rigid = scene_->options;
  rigid.has_bending = false;
  const auto scene = make_scene(liver_way(), rigid);
  Driver driver = held_aside(scene);
  EXPECT_EQ(haptics::needle_shape(driver.state().needle, *scene, true).spans, 0);
}

TEST_P(NeedleShape, NeverAllocates) {
  Driver driver = held_aside(scene_);
  const AllocationGuard guard;
  const telemetry::NeedleShape shape = haptics::needle_shape(driver.state().needle, *scene_, true);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(shape.spans, 0);
}

INSTANTIATE_TEST_SUITE_P(Models, NeedleShape,
                         ::testing::Values(haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy,
                                           haptics::ForceModel::kCombined),
                         [](const auto& model) { return std::string(to_string(model.param)); });

}  // namespace
}  // namespace trocar::testing
