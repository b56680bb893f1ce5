// The path constraint as the hand meets it, through whole ticks: docs/physics.md C3, C4.
#include <gtest/gtest.h>

#include <numbers>

#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

const Vec3 kStraight = Vec3::Zero();

haptics::HapticOptions options_of(haptics::ForceModel model) {
  haptics::HapticOptions options;
  options.force_model = model;
  options.has_weight_compensation = false;
  return options;
}

/// The needle in its path: 60 mm deep along +z through the origin, and back to `depth_mm`.
Driver inserted(const std::shared_ptr<const haptics::HapticScene>& scene, double depth_mm) {
  Driver driver(scene);
  driver.to({0, 0, -10});
  driver.move(60.0, 20.0);
  driver.move(depth_mm, 20.0);
  return driver;
}

/// Pose of the device's needle: tip, and a tilt about the tip.
struct Place {
  Vec3 tip_P = Vec3::Zero();
  Vec3 tilt_rad = Vec3::Zero();

  Vec3 axis_P() const { return Eigen::AngleAxisd(tilt_rad.norm(), tilt_rad.stableNormalized()) * Vec3::UnitZ(); }
};

telemetry::TickSample put(Driver& driver, const Place& place) {
  return driver.to(place.tip_P, place.tilt_rad.norm() > 0.0 ? place.axis_P() : Vec3::UnitZ());
}

/// Moves evenly from one place to the next; every tick goes to `look(sample, place)`.
template <class Look>
void go(Driver& driver, const Place& from, const Place& to, double speed_mm_per_s, const Look& look) {
  constexpr double kLever_mm = 100.0;  // what a radian counts
  const double way_mm = (to.tip_P - from.tip_P).norm() + kLever_mm * (to.tilt_rad - from.tilt_rad).norm();
  const int ticks = std::max(1, static_cast<int>(way_mm / speed_mm_per_s * 1000.0));
  for (int i = 1; i <= ticks; ++i) {
    const double share = static_cast<double>(i) / ticks;
    const Place place{from.tip_P + share * (to.tip_P - from.tip_P),
                      from.tilt_rad + share * (to.tilt_rad - from.tilt_rad)};
    look(put(driver, place), place);
  }
}

/// Work (mJ = N mm) that a force at the tip, and the device's whole wrench about S, do on the hand: trapezoidal.
class Work {
 public:
  explicit Work(double needle_mm) : needle_mm_(needle_mm) {}

  void add(const telemetry::TickSample& sample, const Place& place) {
    const Vec3 axis_P = sample_axis(place);
    const Vec3 stylus_P = place.tip_P - needle_mm_ * axis_P;
    if (has_last_) {
      constraint_nmm_ += 0.5 * (constraint_n_ + sample.f_constraint_n).dot(place.tip_P - tip_P_);
      const Vec3 turn = axis_P_.cross(axis_P);
      device_nmm_ +=
          0.5 * ((device_n_ + sample.device_f_n).dot(stylus_P - stylus_P_) + (torque_nmm_ + sample.tau_nmm).dot(turn));
    }
    has_last_ = true;
    tip_P_ = place.tip_P;
    stylus_P_ = stylus_P;
    axis_P_ = axis_P;
    constraint_n_ = sample.f_constraint_n;
    device_n_ = sample.device_f_n;
    torque_nmm_ = sample.tau_nmm;
  }
  double of_constraint_nmm() const { return constraint_nmm_; }
  double of_device_nmm() const { return device_nmm_; }

 private:
  static Vec3 sample_axis(const Place& place) {
    return place.tilt_rad.norm() > 0.0 ? place.axis_P() : Vec3(Vec3::UnitZ());
  }

  double needle_mm_;
  bool has_last_ = false;
  double constraint_nmm_ = 0.0;
  double device_nmm_ = 0.0;
  Vec3 tip_P_ = Vec3::Zero();
  Vec3 stylus_P_ = Vec3::Zero();
  Vec3 axis_P_ = Vec3::Zero();
  Vec3 constraint_n_ = Vec3::Zero();
  Vec3 device_n_ = Vec3::Zero();
  Vec3 torque_nmm_ = Vec3::Zero();
};

/// Work around corners and back to the first of them.
Work around(Driver& driver, std::vector<Place> corners, double speed_mm_per_s, double needle_mm) {
  corners.push_back(corners.front());
  go(driver, corners.front(), corners.front(), 1.0, [](const auto&...) {});
  for (int i = 0; i < 200; ++i) put(driver, corners.front());  // at rest
  Work work(needle_mm);
  work.add(put(driver, corners.front()), corners.front());
  for (std::size_t i = 1; i < corners.size(); ++i)
    go(driver, corners[i - 1], corners[i], speed_mm_per_s,
       [&](const telemetry::TickSample& sample, const Place& place) { work.add(sample, place); });
  for (int i = 0; i < 200; ++i) work.add(put(driver, corners.front()), corners.front());
  return work;
}

const Vec3 kSides[] = {{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}, {-0.7, 0.7, 0}, {6, -8, 0}};

TEST(PathHold, NeverPullsTheNeedleIn) {
  const auto scene = make_scene(liver_way(), options_of(haptics::ForceModel::kInsertion), constrained_tissues());
  for (const Vec3& side : kSides) {
    for (const Vec3& tilt : {Vec3(0, 0, 0), Vec3(0.08, 0, 0), Vec3(-0.05, 0.1, 0)}) {
      Driver driver = inserted(scene, 40.0);
      int seen = 0;
      const auto look = [&](const telemetry::TickSample& sample, const Place& place) {
        ASSERT_LE(sample.f_constraint_n.z(), 1e-12) << place.tip_P.transpose();  // +z leads into the body
        seen += sample.f_constraint_n.norm() > 0.0 ? 1 : 0;
      };
      go(driver, {{0, 0, 40}, kStraight}, {{side.x(), side.y(), 40}, tilt}, 40.0, look);
      go(driver, {{side.x(), side.y(), 40}, tilt}, {{side.x(), side.y(), 0.2}, tilt}, 20.0, look);
      go(driver, {{side.x(), side.y(), 0.2}, tilt}, {{side.x(), side.y(), 12}, tilt}, 20.0, look);
      go(driver, {{side.x(), side.y(), 12}, tilt}, {{0, 0, 5}, kStraight}, 20.0, look);
      EXPECT_GT(seen, 1000);
    }
  }
}

class PathHoldOf : public ::testing::TestWithParam<haptics::ForceModel> {};

TEST_P(PathHoldOf, GeneratesNoEnergyAroundALoop) {
  const auto scene = make_scene(liver_way(), options_of(GetParam()));
  struct Depths {
    double from_mm, to_mm;
  };
  constexpr double kRounding_nmm = 1e-3;  // of the trapezoidal rule
  for (const Depths& depths : {Depths{4, 29.5}, Depths{0.5, 10}, Depths{1, 5}, Depths{12, 40}}) {
    for (const Vec3& side : kSides) {
      const Place a{{0, 0, depths.from_mm}, kStraight};
      const Place b{{side.x(), side.y(), depths.from_mm}, kStraight};
      const Place c{{side.x(), side.y(), depths.to_mm}, kStraight};
      const Place d{{0, 0, depths.to_mm}, kStraight};
      for (const bool is_turned : {false, true}) {
        Driver driver = inserted(scene, depths.from_mm);
        const Work work = around(driver, is_turned ? std::vector{a, d, c, b} : std::vector{a, b, c, d}, 20.0,
                                 scene->needle.length_mm);
        EXPECT_LE(work.of_device_nmm(), kRounding_nmm)
            << depths.from_mm << " to " << depths.to_mm << " mm, " << side.transpose() << ", turned " << is_turned;
        EXPECT_LE(work.of_constraint_nmm(), kRounding_nmm) << depths.from_mm << ", " << side.transpose();
      }
    }
  }
}

TEST_P(PathHoldOf, GeneratesNoEnergyAroundALoopOfTilts) {
  const auto scene = make_scene(liver_way(), options_of(GetParam()));
  constexpr double kRounding_nmm = 5e-3;
  for (const double tilt : {0.05, -0.05, 0.15}) {
    for (const Vec3& side : kSides) {
      // Tilt, move aside, turn back, return: at one depth and between two.
      for (const double deeper_mm : {0.0, 15.0}) {
        const Place a{{0, 0, 12}, kStraight};
        const Place b{{0, 0, 12}, {0, tilt, 0}};
        const Place c{{side.x(), side.y(), 12 + deeper_mm}, {0, tilt, 0}};
        const Place d{{side.x(), side.y(), 12 + deeper_mm}, kStraight};
        for (const bool is_turned : {false, true}) {
          Driver driver = inserted(scene, 12.0);
          const Work work = around(driver, is_turned ? std::vector{a, d, c, b} : std::vector{a, b, c, d}, 20.0,
                                   scene->needle.length_mm);
          EXPECT_LE(work.of_device_nmm(), kRounding_nmm)
              << tilt << " rad, " << side.transpose() << ", deeper " << deeper_mm << ", turned " << is_turned;
        }
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Models, PathHoldOf,
                         ::testing::Values(haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy,
                                           haptics::ForceModel::kCombined),
                         [](const auto& tested) { return to_string(tested.param); });

TEST(PathHold, IsContinuousWhenTheNeedleLeavesTheSkin) {
  const auto scene = make_scene(liver_way(), options_of(haptics::ForceModel::kInsertion), constrained_tissues());
  for (const Vec3& side : kSides) {
    Driver driver = inserted(scene, 30.0);
    Vec3 before = Vec3::Zero();
    double largest_n = 0.0;
    double most_n = 0.0;
    const auto look = [&](const telemetry::TickSample& sample, const Place&) {
      largest_n = std::max(largest_n, (sample.f_constraint_n - before).norm());
      most_n = std::max(most_n, sample.f_constraint_n.norm());
      before = sample.f_constraint_n;
    };
    go(driver, {{0, 0, 30}, kStraight}, {{side.x(), side.y(), 30}, kStraight}, 10.0, look);
    for (int i = 0; i < 200; ++i) look(driver.to({side.x(), side.y(), 30}), Place{});
    largest_n = 0.0;  // of the way out
    go(driver, {{side.x(), side.y(), 30}, kStraight}, {{side.x(), side.y(), -3}, kStraight}, 10.0, look);
    EXPECT_EQ(before.norm(), 0.0);
    EXPECT_GT(most_n, 0.5);
    EXPECT_LT(largest_n, 0.01) << side.transpose();  // a tick, at 10 mm/s
  }
}

TEST(PathHold, IsContinuousWhenTheNeedleReentersItsHole) {
  const auto scene = make_scene(liver_way(), options_of(haptics::ForceModel::kInsertion), constrained_tissues());
  Driver driver = inserted(scene, -5.0);
  Vec3 before = Vec3::Zero();
  double largest_n = 0.0;
  const Vec3 tilt(0.05, 0.0, 0.0);
  go(driver, {{0.8, 0, -5}, tilt}, {{0.8, 0, 25}, tilt}, 10.0, [&](const telemetry::TickSample& sample, const Place&) {
    largest_n = std::max(largest_n, (sample.f_constraint_n - before).norm());
    before = sample.f_constraint_n;
  });
  EXPECT_GT(before.norm(), 0.1);  // it did fall into the hole, whose line is not the needle's
  EXPECT_LT(largest_n, 0.01);
}

TEST(PathHold, ParallelOffsetCausesForceWithoutTorque) {
  const auto scene = make_scene(liver_way(), options_of(haptics::ForceModel::kInsertion), constrained_tissues());
  Driver driver = inserted(scene, 40.0);
  go(driver, {{0, 0, 40}, kStraight}, {{2, 0, 40}, kStraight}, 5.0, [](const auto&...) {});
  telemetry::TickSample sample;
  for (int i = 0; i < 200; ++i) sample = driver.to({2, 0, 40});
  EXPECT_LT((sample.f_constraint_n - Vec3(-2, 0, 0)).norm(), 1e-9);
  EXPECT_LT(sample.tau_nmm.norm(), 1e-9);
}

TEST(PathHold, TiltAboutTheTipCausesForceAndTorque) {
  const auto scene = make_scene(liver_way(), options_of(haptics::ForceModel::kInsertion), constrained_tissues());
  Driver driver = inserted(scene, 40.0);
  const double tilt_rad = 0.01;
  const Place tilted{{0, 0, 40}, {0, tilt_rad, 0}};
  go(driver, {{0, 0, 40}, kStraight}, tilted, 5.0, [](const auto&...) {});
  telemetry::TickSample sample;
  for (int i = 0; i < 500; ++i) sample = put(driver, tilted);
  const double aside_mm = -scene->needle.length_mm * std::sin(tilt_rad);  // of the stylus
  const haptics::PathConstraintParams& hold = scene->options.constraint;
  EXPECT_NEAR(sample.f_constraint_n.x(), -hold.force_n / hold.linear_mm * aside_mm, 1e-9);
  const Vec3 axial_n = sample.device_f_n - sample.f_constraint_n;  // what friction still holds acts at the tip
  const Vec3 lever = scene->needle.length_mm * tilted.axis_P();
  EXPECT_NEAR((sample.tau_nmm - lever.cross(axial_n)).y(), -hold.torque_nmm / hold.linear_rad * tilt_rad, 1e-6);
}

TEST(PathHold, TiltAboutTheStylusCausesOnlyTorque) {
  const auto scene = make_scene(liver_way(), options_of(haptics::ForceModel::kInsertion), constrained_tissues());
  Driver driver = inserted(scene, 40.0);
  const double length = scene->needle.length_mm;
  const Place turned{Vec3(length * std::sin(0.02), 0, 40 - length * (1 - std::cos(0.02))), {0, 0.02, 0}};
  go(driver, {{0, 0, 40}, kStraight}, turned, 5.0, [](const auto&...) {});
  telemetry::TickSample sample;
  for (int i = 0; i < 200; ++i) sample = put(driver, turned);
  EXPECT_NEAR(sample.f_constraint_n.norm(), 0.0, 1e-9);
  EXPECT_LT(sample.tau_nmm.y(), -10.0);
}

TEST(PathHold, HoldsADeviceWithoutTorqueAtTheStylus) {
  stylus::DeviceCapability device;
  device.peak_torque_nmm = 0.0;
  const auto scene = *make_haptic_scene(layered_patient(liver_way()), constrained_tissues(), {}, device,
                                        options_of(haptics::ForceModel::kInsertion));
  Driver driver = inserted(scene, 40.0);
  // A turn about the stylus moves the tip and meets no force; the stylus beside the path is pulled back.
  const double length = scene->needle.length_mm;
  const Place turned{Vec3(length * std::sin(0.02), 0, 40 - length * (1 - std::cos(0.02))), {0, 0.02, 0}};
  go(driver, {{0, 0, 40}, kStraight}, turned, 5.0, [](const auto&...) {});
  telemetry::TickSample sample;
  for (int i = 0; i < 200; ++i) sample = put(driver, turned);
  EXPECT_NEAR(sample.f_constraint_n.norm(), 0.0, 1e-9);
  Driver other = inserted(scene, 40.0);
  go(other, {{0, 0, 40}, kStraight}, {{2, 0, 40}, kStraight}, 5.0, [](const auto&...) {});
  for (int i = 0; i < 200; ++i) sample = put(other, {{2, 0, 40}, kStraight});
  EXPECT_NEAR(sample.f_constraint_n.x(), -2.0, 1e-9);
}

}  // namespace
}  // namespace trocar::testing
