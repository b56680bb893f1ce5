#include "haptics/contact/contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/files/folders.h"
#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "haptics/contact/test/flat_skin.h"
#include "haptics/option_texts.h"
#include "haptics/test/tick_period.h"
#include "haptics/tick.h"
#include "lab/haptics/closed_loop.h"
#include "stylus/virtual_stylus.h"

namespace trocar::testing {
namespace {

/// Moves the device's tool there from where it is, straight and evenly, and holds it until all is at rest.
class Hand {
 public:
  explicit Hand(std::shared_ptr<const haptics::HapticScene> scene, double dt_s = kDt_s)
      : scene_(std::move(scene)), dt_s_(dt_s) {}

  haptics::ContactStep go(const Vec3& p_PT, double tilt_rad = 0.0, double seconds = 0.5, double hold_s = 0.5) {
    const auto steps = static_cast<int>(std::lround(seconds / dt_s_));
    const auto rests = static_cast<int>(std::lround(hold_s / dt_s_));
    const Vec3 from = at_;
    const double tilt_from = tilt_;
    haptics::ContactStep step;
    for (int i = 1; i <= steps + rests; ++i) {
      const double t = std::min(1.0, static_cast<double>(i) / steps);
      at_ = from + t * (p_PT - from);
      tilt_ = tilt_from + t * (tilt_rad - tilt_from);
      step = haptics::step_contact(state, *scene_, face_down(at_, tilt_), dt_s_);
      worst_jump_n = std::max(worst_jump_n, (step.wrench_P.force_n - force_).norm());
      force_ = step.wrench_P.force_n;
      hit_bound = hit_bound || step.is_bound;
    }
    return step;
  }
  const haptics::HapticScene& scene() const { return *scene_; }
  haptics::ContactState state;
  double worst_jump_n = 0.0;
  bool hit_bound = false;

 private:
  std::shared_ptr<const haptics::HapticScene> scene_;
  double dt_s_;
  Vec3 at_{0.0, 0.0, -2.0};
  double tilt_ = 0.0;
  Vec3 force_ = Vec3::Zero();
};

TEST(Contact, FingerForceIsStiffnessTimesDentVolume) {
  // The dent is shallow against the column: the linear law shows.
  haptics::HapticOptions options;
  options.coupling.stiffness_n_per_mm = 3.5;
  Hand hand(make_face_scene(haptics::Tool::kFinger, all_fat, options));
  const haptics::ContactStep step = hand.go({0, 0, 2.5});
  const double k = haptics::tissue_column(hand.scene(), Vec3::Zero(), Vec3::UnitZ()).stiffness_n_per_mm3;
  const double depth = step.depth_mm + 0.2;  // the first ring lies 0.2 mm above the tip
  const double dent_mm3 = std::numbers::pi * depth * depth * (3.0 * 8.0 - depth) / 3.0;
  EXPECT_NEAR(step.wrench_P.force_n.z(), -k * dent_mm3, 0.12 * k * dent_mm3);  // rings 5 %, the rest stiffening
  EXPECT_LT(step.wrench_P.force_n.head<2>().norm(), 0.02 * std::abs(step.wrench_P.force_n.z()));
}

TEST(Contact, ProbeForceIsTheSumOverItsColumns) {
  Hand hand(make_face_scene(haptics::Tool::kTransducer, all_fat));
  const haptics::ContactStep step = hand.go({0, 0, 10.0});
  const haptics::TissueColumn column = haptics::tissue_column(hand.scene(), Vec3::Zero(), Vec3::UnitZ());
  const haptics::ContactFace& face = hand.scene().face;
  double expected = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) {
    const double depth = (hand.state.X_PT * face.point_T[i]).z();
    expected += face.area_mm2[i] * face.normal_T[i].y() * respond(column, depth).pressure;
  }
  EXPECT_NEAR(-step.wrench_P.force_n.z(), expected, 1e-5);
  EXPECT_NEAR(step.normal_n, expected, 1e-5);
  // Coupling and skin are springs in series: the device is k_c away from the shown tool.
  EXPECT_NEAR(10.0 - hand.state.X_PT.p().z(), expected / 1.0, 1e-5);
  EXPECT_LT(step.wrench_P.torque_nmm.norm(), 1e-6);
}

TEST(Contact, SteadyForceDoesNotDependOnTheTickRate) {
  const auto rib = [](const Vec3& p) { return p.z() > 12.0 && std::abs(p.x() - 8.0) < 6.0 ? kBone : kFat; };
  for (const haptics::Tool tool : {haptics::Tool::kTransducer, haptics::Tool::kFinger}) {
    const auto at = [&](double rate_hz) {
      Hand hand(make_face_scene(tool, rib), 1.0 / rate_hz);
      hand.go({1.0, 0.0, 7.0}, 0.1, 0.3, 0.0);
      return hand.go({2.0, 1.0, 7.0}, 0.1, 0.3, 0.4).wrench_P;
    };
    const Wrench at_1 = at(1000.0);
    for (const double rate : {2000.0, 4000.0}) {
      const Wrench other = at(rate);
      EXPECT_LT((other.force_n - at_1.force_n).norm(), 0.005 * at_1.force_n.norm());
      EXPECT_LT((other.torque_nmm - at_1.torque_nmm).norm(), 0.005 * at_1.torque_nmm.norm());
    }
  }
}

TEST(Contact, RendersARibUnderFatAndAHardTumour) {
  const auto rib = [](const Vec3& p) { return (p - Vec3(0, p.y(), 14.0)).norm() < 5.0 ? kBone : kFat; };
  const auto tumour = [](const Vec3& p) { return (p - Vec3(0, 0, 20.0)).norm() < 10.0 ? kLiver : kFat; };
  for (const auto& label_at : {std::function<std::uint8_t(const Vec3&)>(rib), {tumour}}) {
    Hand on(make_face_scene(haptics::Tool::kFinger, label_at));
    Hand beside(make_face_scene(haptics::Tool::kFinger, label_at));
    beside.go({25.0, 0, -2.0});
    const double hard = on.go({0, 0, 5.0}).wrench_P.force_n.norm();
    const double soft = beside.go({25.0, 0, 5.0}).wrench_P.force_n.norm();
    constexpr double kNoticeable = 0.07;  // Pang, Tan, Durlach: force JND
    EXPECT_GT(hard, (1.0 + 3.0 * kNoticeable) * soft);
  }
}

TEST(Contact, RightsATiltedTool) {
  for (const double tilt : {0.17, -0.17}) {
    Hand hand(make_face_scene(haptics::Tool::kTransducer, all_fat));
    const haptics::ContactStep step = hand.go({0, 0, 5.0}, tilt);
    // face_down turns by -tilt about y of P; a torque the other way rights it.
    EXPECT_GT(step.wrench_P.torque_nmm.y() * tilt, 0.0);
    EXPECT_GT(std::abs(step.wrench_P.torque_nmm.y()), 2.0);
  }
}

TEST(Contact, TorqueMatchesThePointForces) {
  // Half of the face over a plate of bone: the force acts there.
  const auto plate = [](const Vec3& p) { return p.x() > 0.0 && p.z() > 6.0 ? kBone : kFat; };
  Hand hand(make_face_scene(haptics::Tool::kTransducer, plate));
  const Wrench wrench = hand.go({0, 0, 8.0}, 0.0, 0.5, 2.0).wrench_P;
  const double lever_mm = wrench.torque_nmm.y() / -wrench.force_n.z();  // M = x f: M_y = -x f_z
  EXPECT_GT(lever_mm, 2.0);
  EXPECT_LT(lever_mm, 30.0);
  EXPECT_LT(std::abs(wrench.torque_nmm.x()), 0.05 * wrench.torque_nmm.y());
}

TEST(Contact, ShownToolNeverPassesThroughBone) {
  const auto thin = [](const Vec3& p) { return p.z() < 10.0 ? kFat : kBone; };
  for (const haptics::Tool tool : {haptics::Tool::kTransducer, haptics::Tool::kFinger}) {
    Hand hand(make_face_scene(tool, thin));
    const haptics::ContactStep step = hand.go({0, 0, 40.0}, 0.0, 1.0);
    EXPECT_LT(hand.state.X_PT.p().z(), 10.0);
    EXPECT_GT(hand.state.X_PT.p().z(), 5.0);
    EXPECT_NEAR(-step.wrench_P.force_n.z(), 40.0 - hand.state.X_PT.p().z(), 1e-4);  // k_c of 1 N/mm
    EXPECT_FALSE(hand.hit_bound);
  }
}

TEST(Contact, StaysInTheFrictionConeAndSlidesAtItsEdge) {
  for (const haptics::Tool tool : {haptics::Tool::kTransducer, haptics::Tool::kFinger}) {
    Hand hand(make_face_scene(tool, all_fat));
    hand.go({-10.0, 0, -2.0});
    hand.go({-10.0, 0, 5.0});
    const double mu = hand.scene().face.friction_mu;
    const Wrench little = hand.go({-9.98, 0, 5.0}).wrench_P;  // sticks
    EXPECT_LT(little.force_n.x(), 0.0);
    EXPECT_LT(std::abs(little.force_n.x()), 0.9 * mu * std::abs(little.force_n.z()));
    const haptics::ContactStep sliding = hand.go({10.0, 0, 5.0}, 0.0, 1.0, 0.0);
    EXPECT_NEAR(sliding.wrench_P.force_n.x(), sliding.wrench_P.force_n.z() * mu,
                0.02 * mu * std::abs(sliding.wrench_P.force_n.z()));
    const haptics::ContactStep held = hand.go({10.0, 0, 5.0}, 0.0, 0.1, 2.0);
    EXPECT_LE(held.friction_n, mu * held.normal_n + 1e-9);
    EXPECT_LT(held.wrench_P.force_n.x(), -0.5 * mu * held.normal_n);  // the stretched skin goes on pulling
  }
}

TEST(Contact, HasNoForceAwayFromTheSkin) {
  Hand hand(make_face_scene(haptics::Tool::kTransducer, all_fat));
  EXPECT_EQ(hand.go({0, 0, -1.5}).wrench_P.force_n.norm(), 0.0);
  EXPECT_EQ(hand.go({0, 0, -1.5}).points_in_contact, 0);
  hand.go({0, 0, 8.0});
  const haptics::ContactStep away = hand.go({0, 0, -5.0}, 0.0, 0.2);
  EXPECT_LT(away.wrench_P.force_n.norm(), 1e-9);
  EXPECT_LT((hand.state.X_PT.p() - Vec3(0, 0, -5.0)).norm(), 1e-6);
}

TEST(Contact, StartInsideGivesNoForceStep) {
  const auto scene = make_face_scene(haptics::Tool::kFinger, [](const Vec3& p) { return p.z() < 10.0 ? kFat : kBone; });
  Hand usual(scene);
  const double full = usual.go({0, 0, 8.0}).wrench_P.force_n.norm();
  haptics::ContactState state;
  double before = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const haptics::ContactStep step = haptics::step_contact(state, *scene, face_down({0, 0, 8.0}), kDt_s);
    EXPECT_EQ(step.started_inside, i == 0);
    const double now = step.wrench_P.force_n.norm();
    EXPECT_LT(std::abs(now - before), 0.03 * full);
    if (i == 0) {
      EXPECT_LT(now, 1e-9);
    }
    before = now;
  }
  EXPECT_NEAR(before, full, 1e-3 * full);
}

TEST(Contact, TouchCausesNoForceStep) {
  Hand hand(make_face_scene(haptics::Tool::kTransducer, all_fat));
  const double full = hand.go({0, 0, 10.0}, 0.0, 0.12).wrench_P.force_n.norm();  // 100 mm/s
  EXPECT_LT(hand.worst_jump_n, 0.1 * full);
}

// The tick.

TEST(ContactTick, NeverAllocatesAndStaysFiniteForAnyInput) {
  const auto rib = [](const Vec3& p) { return p.z() > 6.0 && std::abs(p.x()) < 8.0 ? kBone : kFat; };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const haptics::Tool tool : {haptics::Tool::kTransducer, haptics::Tool::kFinger}) {
    const auto scene = make_face_scene(tool, rib);
    Random random(5);
    haptics::HapticState state;
    std::size_t allocations = 0;
    int rejected = 0;
    Vec3 at(0, 0, 0);
    for (int i = 0; i < 6000; ++i) {
      at += Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      if (at.norm() > 40.0) at *= 0.1;
      Vec3 tip = at;
      haptics::HapticInput input;
      switch (random.next() % 14) {
        case 0:
          tip.x() = kNan;
          break;
        case 1:
          tip.z() = kInfinity;
          break;
        case 2:
          tip *= 1e200;
          break;
        case 3:
          input.dt_s = random.next() % 2 == 0 ? 0.0 : kNan;
          break;
        case 4:
          input.dt_s = 1e-9;
          break;
        case 5:
          tip = Vec3(0, 0, 1e4);
          break;
        case 6:
          tip = Vec3(random.uniform(-60, 60), 0, random.uniform(-20, 60));
          break;
        default:
          break;
      }
      input.tool = telemetry::to_tool_pose(face_down(tip, random.uniform(-3, 3)));
      const AllocationGuard guard;
      const haptics::HapticOutput output = haptics::tick(state, input, *scene);
      allocations += guard.count();
      ASSERT_TRUE(output.total_W.force_n.allFinite() && output.total_W.torque_nmm.allFinite());
      ASSERT_TRUE(output.sample.tip_mm.allFinite() && output.sample.f_total_n.allFinite());
      ASSERT_LE(output.total_W.force_n.norm(), 37.5 + 1e-9);
      ASSERT_LE(output.total_W.torque_nmm.norm(), 515.0 + 1e-9);
      rejected += output.sample.events[0].kind == telemetry::EventKind::kLimit ? 1 : 0;
    }
    EXPECT_EQ(allocations, 0u);
    EXPECT_GT(rejected, 1000);
  }
}

TEST(ContactTick, RecordsTheToolAndComposesTheTotal) {
  const auto scene = make_face_scene(haptics::Tool::kTransducer, all_fat);
  haptics::HapticState state;
  telemetry::TickSample sample;
  Wrench contact;
  haptics::ContactState own;
  for (int i = 0; i < 1000; ++i) {
    const Pose X_PT = face_down({0, 0, std::min(8.0, -2.0 + 0.02 * i)}, 0.1);
    sample = haptics::tick(state, {0.001 * i, kDt_s, telemetry::to_tool_pose(X_PT), true, {}}, *scene).sample;
    contact = haptics::step_contact(own, *scene, X_PT, kDt_s).wrench_P;
  }
  EXPECT_LT((sample.f_constraint_n - contact.force_n).norm(), 1e-9);
  EXPECT_LT((sample.f_total_n - sample.f_constraint_n - sample.f_weight_n).norm(), 1e-12);
  EXPECT_LT((sample.axis - state.contact.X_PT.R().col(1)).norm(), 1e-12);
  EXPECT_EQ(sample.phase, telemetry::InsertionPhase::kLoading);
  EXPECT_NEAR(sample.device_mm.z(), 8.0, 1e-9);
  EXPECT_LT(sample.tip_mm.z(), 8.0);
  // The grip is reach_mm behind the face: the torque about it has the force's lever.
  const Vec3 grip = sample.device_mm - face_down({0, 0, 0}, 0.1).R().col(1) * scene->face.reach_mm;
  const Vec3 lift = Vec3(0, -0.5, 0);
  const Vec3 weight_torque = (-20.0 * face_down({0, 0, 0}, 0.1).R().col(1)).cross(lift);
  const Vec3 expected = contact.torque_nmm + (sample.device_mm - grip).cross(contact.force_n) + weight_torque;
  EXPECT_LT((sample.tau_nmm - expected).norm(), 1e-6);
}

TEST(ContactTick, RefusesASceneWithoutTissue) {
  auto patient = flat_patient(all_fat);
  patient->labels = {};
  patient->ct = {};
  haptics::HapticOptions options;
  options.tool = haptics::Tool::kFinger;
  EXPECT_FALSE(haptics::make_haptic_scene(patient, soft_tissues(), {}, {}, options).has_value());
}

// Closed loop: a bare mass rests on the skin by its weight, its position quantised, the force one tick late.

struct Load {
  double mass_kg;
  haptics::Tool tool;
};
class RestingOnSkin : public ::testing::TestWithParam<Load> {};

TEST_P(RestingOnSkin, ComesToRestAndStays) {
  constexpr double kCount_mm = 0.03;  // one encoder count of a 860 dpi device
  const auto muscle = [](const Vec3&) { return kMuscle; };
  const auto thin = [](const Vec3& p) { return p.z() < 4.0 ? kFat : kBone; };
  const auto rib = [](const Vec3& p) { return p.z() > 4.0 && std::abs(p.x() - 6.0) < 5.0 ? kBone : kFat; };
  for (const auto& label_at : {std::function<std::uint8_t(const Vec3&)>(all_fat), {muscle}, {thin}, {rib}}) {
    haptics::HapticOptions options;
    options.has_weight_compensation = false;
    const auto scene = make_face_scene(GetParam().tool, label_at, options);
    const double weight_n = 9.81 * GetParam().mass_kg;
    haptics::HapticState state;
    stylus::VirtualDeviceState device{face_down({0, 0, -1}, 0.05), Vec3::Zero()};
    stylus::HandHold hand;
    hand.R_PN = device.X_PN.R();
    Vec3 force_P = Vec3::Zero();
    Vec3 low = Vec3::Constant(1e9);
    Vec3 high = -low;
    for (int i = 0; i < 5000; ++i) {
      stylus::step_device(device, {GetParam().mass_kg, weight_n}, hand, force_P, Vec3::UnitZ(), kDt_s);
      const Vec3 seen = (device.X_PN.p() / kCount_mm).array().round() * kCount_mm;
      force_P = haptics::tick(state, {kDt_s * i, kDt_s, telemetry::to_tool_pose({hand.R_PN, seen}), true, {}}, *scene)
                    .total_W.force_n;
      if (i < 4000) continue;
      low = low.cwiseMin(device.X_PN.p());
      high = high.cwiseMax(device.X_PN.p());
    }
    // No cycle beyond a few counts; sideways the gel only slows it.
    EXPECT_LT(high.z() - low.z(), 4 * kCount_mm);
    EXPECT_NEAR(force_P.z(), -weight_n, 0.3);
    EXPECT_LT((high - low).head<2>().norm(), 1.0);
  }
}
INSTANTIATE_TEST_SUITE_P(BareMasses, RestingOnSkin,
                         ::testing::Values(Load{0.045, haptics::Tool::kTransducer},
                                           Load{0.15, haptics::Tool::kTransducer}, Load{0.045, haptics::Tool::kFinger},
                                           Load{0.15, haptics::Tool::kFinger}));

/// In six degrees of freedom: the hand presses and tilts the tool, a stylus of 50 kg mm^2 turns under it.
TEST(ContactInClosedLoop, ComesToRestOverBone) {
  const auto preset = stylus::load_device_preset(data_dir() / "devices.toml", "sigma7");
  ASSERT_TRUE(preset.has_value());
  const auto thin = [](const Vec3& p) { return p.z() < 4.0 ? kFat : kBone; };
  const auto rib = [](const Vec3& p) { return p.z() > 4.0 && std::abs(p.x() - 6.0) < 5.0 ? kBone : kFat; };
  for (const auto& label_at : {std::function<std::uint8_t(const Vec3&)>(all_fat), {thin}, {rib}}) {
    for (const haptics::Tool tool : {haptics::Tool::kTransducer, haptics::Tool::kFinger}) {
      haptics::HapticOptions options;
      haptics::apply_device_preset(*preset, options);
      const auto scene = make_face_scene(tool, label_at, options);
      haptics::ClosedLoop loop(scene, *preset, haptics::Holder::kHand);
      stylus::StylusHold hold = stylus::make_hand();
      loop.stylus().X_PS = hold.X_PS = face_down({0, 0, -1}, 0.1) * scene->X_SN.inverse();
      for (int i = 0; i < 4000; ++i) {
        hold.X_PS = face_down({0, 0, std::min(9.0, -1.0 + 0.02 * i)}, 0.1) * scene->X_SN.inverse();
        if (i == 3000) loop.restart_observer();
        loop.run(hold);
      }
      EXPECT_LT(loop.stylus().v_P.norm(), 5.0);  // an encoder count a few times a second
      EXPECT_LT(loop.stylus().w_P.norm(), 0.05);
      EXPECT_LT(loop.observer().growth_mj(), 0.05);
    }
  }
}

}  // namespace
}  // namespace trocar::testing
