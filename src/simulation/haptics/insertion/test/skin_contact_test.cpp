// The tip on unpierced skin: docs/physics.md V2.
#include <gtest/gtest.h>

#include <cmath>

#include "haptics/insertion/insertion_path.h"
#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

constexpr double kTip = 2.0;  // friction
constexpr double kDt_s = 0.001;

TEST(SkinContact, HoldsItsPointWithinTheConeOfFriction) {
  const auto scene = make_scene(liver_way());
  haptics::SkinContact contact;
  haptics::follow_skin(contact, *scene, {1.9, 0.0, 1.0}, kTip, kDt_s);
  EXPECT_LT(contact.anchor_P.norm(), 1e-9);
  EXPECT_EQ(contact.slides_P.norm(), 0.0);
  EXPECT_NEAR(contact.to_device_mm, std::hypot(1.9, 1.0), 1e-9);
  haptics::follow_skin(contact, *scene, {0.0, 5.0, 1.0}, kTip, kDt_s);  // 2 mm of 1 mm deep: the rest slides
  EXPECT_LT((contact.anchor_P - Vec3(0.0, 3.0, 0.0)).norm(), 1e-6);
  EXPECT_NEAR(contact.slides_P.norm(), 3.0 / (kDt_s + haptics::kVelocitySmoothing_s), 1e-3);
  haptics::follow_skin(contact, *scene, {3.0, 3.0, 0.5}, 0.0, kDt_s);
  EXPECT_LT((contact.anchor_P - Vec3(3.0, 3.0, 0.0)).norm(), 1e-6);
  haptics::follow_skin(contact, *scene, {3.0, 3.0, -0.5}, kTip, kDt_s);
  EXPECT_NEAR(contact.to_device_mm, -0.5, 1e-6);
}

TEST(SkinContact, PiercesByAxialForceOnly) {
  const auto scene = make_scene(liver_way());
  haptics::SkinContact contact;
  haptics::follow_skin(contact, *scene, {1.0, 0.0, 1.0}, kTip, kDt_s);
  EXPECT_NEAR(haptics::piercing_share(contact, *scene, Vec3::UnitZ()), std::sqrt(0.5), 1e-9);
  EXPECT_EQ(haptics::piercing_share(contact, *scene, Vec3(1.0, 0.0, 0.1).normalized()), 0.0);   // flat on the skin
  EXPECT_EQ(haptics::piercing_share(contact, *scene, Vec3(-1.0, 0.0, 0.9).normalized()), 0.0);  // pushed sideways
}

/// Work (mJ) of the device's wrench on a hand that presses obliquely, drags along the skin, lifts and returns.
double cycle_mj(haptics::ForceModel model, double angle_rad, double drag_mm) {
  haptics::HapticOptions options;
  options.force_model = model;
  options.has_weight_compensation = false;
  const auto scene = make_scene(liver_way(), options);
  Driver driver(scene);
  const Vec3 axis(std::sin(angle_rad), 0.0, std::cos(angle_rad));
  const Vec3 over = -3.0 * axis, pressed = 1.8 * axis, aside(-drag_mm, 0.0, 0.0), up(0.0, 0.0, -6.0);
  const Vec3 corners[] = {over, pressed, pressed + aside, pressed + aside + up, over};
  double work_mj = 0.0;
  Vec3 before_P = over, before_n = Vec3::Zero();
  for (std::size_t leg = 1; leg < std::size(corners); ++leg)
    for (int i = 1; i <= 400; ++i) {
      const Vec3 tip_P = corners[leg - 1] + (corners[leg] - corners[leg - 1]) * (i / 400.0);
      const Vec3 force_n = driver.to(tip_P, axis).device_f_n;
      work_mj += 0.5 * (force_n + before_n).dot(tip_P - before_P);
      before_P = tip_P;
      before_n = force_n;
    }
  EXPECT_FALSE(driver.state().needle.path.is_open);
  return work_mj;
}

TEST(SkinContact, GeneratesNoEnergyForADraggedObliqueNeedle) {
  using enum haptics::ForceModel;
  for (const haptics::ForceModel model : {kInsertion, kProxy, kCombined})
    for (const double angle_deg : {0.0, 30.0, 45.0, 60.0})
      for (const double drag_mm : {-20.0, 20.0})
        EXPECT_LT(cycle_mj(model, angle_deg * 0.0174533, drag_mm), -1.0) << to_string(model) << " " << angle_deg;
}

/// Work of a hand that trembles sideways on the skin and lifts at the end.
double tremble_mj(haptics::ForceModel model, double frequency_hz, double width_mm, double deep_mm) {
  haptics::HapticOptions options;
  options.force_model = model;
  options.has_weight_compensation = false;
  Driver driver(make_scene(liver_way(), options));
  double work_mj = 0.0, most_mj = 0.0;
  Vec3 before_P(0.0, 0.0, -2.0), before_n = Vec3::Zero();
  for (int i = 0; i <= 1500; ++i) {
    const double t = 0.001 * i;
    const double down = std::min({1.0, t / 0.2, (1.5 - t) / 0.2});
    const Vec3 tip_P(down * width_mm * std::sin(6.2832 * frequency_hz * t), 0.0, -2.0 + (2.0 + deep_mm) * down);
    const Vec3 force_n = driver.to(tip_P).device_f_n;
    work_mj += 0.5 * (force_n + before_n).dot(tip_P - before_P);
    most_mj = std::max(most_mj, work_mj);
    before_P = tip_P;
    before_n = force_n;
  }
  return most_mj;
}

TEST(SkinContact, GeneratesNoEnergyUnderTremor) {
  using enum haptics::ForceModel;
  for (const haptics::ForceModel model : {kInsertion, kProxy, kCombined})
    for (const double frequency_hz : {10.0, 40.0, 60.0, 100.0})
      for (const double width_mm : {0.2, 1.0})
        for (const double deep_mm : {0.02, 0.1, 0.5})
          EXPECT_LT(tremble_mj(model, frequency_hz, width_mm, deep_mm), 0.1)
              << to_string(model) << ' ' << frequency_hz << " Hz, " << width_mm << ", " << deep_mm << " mm";
}

TEST(SkinContact, TurnAboutTheGripMeetsTheTipForceLever) {
  using enum haptics::ForceModel;
  for (const haptics::ForceModel model : {kInsertion, kProxy, kCombined}) {
    haptics::HapticOptions options;
    options.force_model = model;
    options.has_weight_compensation = false;
    const auto scene = make_scene(liver_way(), options);
    Driver driver(scene);
    for (int i = 0; i <= 500; ++i) driver.to({0.0, 0.0, 0.003 * i});
    telemetry::TickSample sample;
    for (int i = 0; i <= 500; ++i) sample = driver.to({0.002 * i, 0.0, 1.5});
    for (int i = 0; i < 200; ++i) sample = driver.to({1.0, 0.0, 1.5});
    const Vec3 lever(0.0, 0.0, scene->needle.length_mm);
    EXPECT_GT(std::abs(sample.device_f_n.x()), 0.3) << to_string(model);
    EXPECT_LT((sample.tau_nmm - lever.cross(sample.device_f_n)).norm(), 1e-6) << to_string(model);
  }
}

TEST(SkinContact, TreatsATipBesideItsChannelAsInserted) {
  using enum haptics::ForceModel;
  for (const haptics::ForceModel model : {kInsertion, kProxy, kCombined}) {
    Driver driver(make_scene(liver_way(), model));
    driver.move(20.0, 20.0);
    bool has_resumed = false;
    for (int i = 0; i < 2000;
         ++i) {  // tilted and pulled back until the needle is out of its channel, with its tip inside
      const double t = i / 2000.0;
      const Vec3 axis = Vec3(3.0 * t, 0.0, 1.0 - 1.5 * t).normalized();
      const telemetry::TickSample sample = driver.to({40.0 * t, 0.0, 20.0 - 17.0 * t}, axis);
      for (const telemetry::TickEvent& event : sample.events)
        has_resumed = has_resumed || (event.kind == telemetry::EventKind::kLimit &&
                                      event.id == static_cast<std::uint8_t>(telemetry::LimitReason::kResumedInside));
      ASSERT_TRUE(sample.device_f_n.allFinite());
    }
    EXPECT_TRUE(driver.state().needle.path.is_open || has_resumed) << to_string(model);
  }
}

}  // namespace
}  // namespace trocar::testing
