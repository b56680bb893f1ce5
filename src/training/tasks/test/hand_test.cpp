#include <gtest/gtest.h>

#include <numbers>

#include "tasks/operator.h"

namespace trocar::tasks {
namespace {

HandCommand wanted(const Vec3& tip_P, const Vec3& v_P = Vec3::Zero()) {
  HandCommand command;
  command.X_PN = Pose::translation(tip_P);
  command.v_P = v_P;
  return command;
}

TEST(Hand, PullsLikeASpringAndDamper) {
  const HandParams hand{.mass_kg = 0.2, .stiffness_n_per_mm = 0.5, .damping_ns_per_mm = 0.01};
  HandCommand command = wanted({10.0, 0.0, 0.0}, {0.0, 20.0, 0.0});
  const Vec3 tip_P(4.0, 0.0, 0.0), v_P(0.0, 0.0, 30.0);
  const auto force = [&] {
    const HandSpring spring = hand_spring(hand, command);
    return Vec3(spring.stiffness_n_per_mm * (spring.anchor_P - tip_P) +
                spring.damping_ns_per_mm * (spring.anchor_velocity_P - v_P));
  };
  EXPECT_TRUE(force().isApprox(Vec3(3.0, 0.2, -0.3), 1e-12));
  EXPECT_EQ(hand_spring(hand, command).mass_kg, 0.2);
  command.grip = 4.0;  // four times as stiff, with the same damping ratio
  EXPECT_TRUE(force().isApprox(Vec3(12.0, 0.4, -0.6), 1e-12));
}

TEST(Hand, TurnsIndependentlyOfTheStepSize) {
  const HandParams hand;
  const Mat3 wanted_R = Eigen::AngleAxisd(1.0, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const double half_life_s = hand.turning_time_constant_s * std::numbers::ln2;
  for (const int steps : {1, 10, 1000}) {
    Mat3 R = Mat3::Identity();
    for (int i = 0; i < steps; ++i) R = follow_rotation(hand, R, wanted_R, half_life_s / steps);
    EXPECT_NEAR(Eigen::AngleAxisd(R).angle(), 0.5, 1e-9) << steps;
    EXPECT_NEAR(Eigen::AngleAxisd(R.transpose() * wanted_R).angle(), 0.5, 1e-9) << steps;
  }
}

// The worst that a device may be coupled to: its own spring, felt one tick late.
TEST(Hand, ComesToRestAgainstADelayedSpring) {
  const HandParams hand;
  const double mass = (hand.mass_kg + 0.045) * 1e-3;  // N s^2/mm, with the lightest device
  for (const double coupling_n_per_mm : {1.0, 2.0, 3.5})
    for (const double dt_s : {0.001, 0.00025}) {
      const HandSpring spring = hand_spring(hand, wanted({5.0, 0.0, 0.0}));
      Vec3 x = Vec3::Zero();
      Vec3 v = Vec3::Zero();
      Vec3 late_force = Vec3::Zero();
      for (double t = 0.0; t < 2.0; t += dt_s) {
        const Vec3 push = spring.stiffness_n_per_mm * (spring.anchor_P - x) + late_force;
        late_force = -coupling_n_per_mm * x;
        v = (mass * v + dt_s * push) /
            (mass + dt_s * spring.damping_ns_per_mm + dt_s * dt_s * spring.stiffness_n_per_mm);
        x += dt_s * v;
      }
      const double rest_mm = 5.0 * spring.stiffness_n_per_mm / (spring.stiffness_n_per_mm + coupling_n_per_mm);
      EXPECT_NEAR(x.x(), rest_mm, 1e-6) << coupling_n_per_mm << " N/mm, " << dt_s << " s";
    }
}

}  // namespace
}  // namespace trocar::tasks
