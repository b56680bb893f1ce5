// Forces in a patient that moves: physics does not depend on who moves, and a channel goes with its tissue.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/testing/allocation_guard.h"
#include "haptics/contact/test/flat_skin.h"
#include "haptics/test/layered_patient.h"
#include "motion/testing/sliding_motion.h"

namespace trocar::testing {
namespace {

using haptics::ForceModel;
using motion::MotionState;
using motion::testing::bump, motion::testing::flat_border, motion::testing::made, motion::testing::ramp,
    motion::testing::sliding_parts, motion::testing::uniform;

constexpr double kUnit_mm = 80.0;  ///< Displacement of a driver of 1.
constexpr double kDt_s = 0.001;

/// The whole patient, where the driver is 1.
std::shared_ptr<const motion::MotionModel> whole_body(const Vec3& moved_mm) {
  return motion::testing::uniform_model(moved_mm);
}

/// Everything deeper than 20 mm slides along x below a wall at rest.
std::shared_ptr<const motion::MotionModel> sliding_inside() {
  return made(sliding_parts(flat_border(Vec3::UnitZ(), 20.0), {uniform(kUnit_mm * Vec3::UnitX())}));
}

/// The body compressed or stretched in depth, and its deep tissue moved along x: linear from the skin on.
std::shared_ptr<const motion::MotionModel> stretched(const Vec3& displacement_mm) {
  return made(motion::testing::whole_body({ramp(displacement_mm, Vec3::Zero(), Vec3::UnitZ(), 100.0)}));
}

/// Ticks of a tool in a patient whose motion is a function of time.
class MovingLab {
 public:
  using Motion = std::function<MotionState(double time_s)>;

  MovingLab(std::shared_ptr<const haptics::HapticScene> scene, std::shared_ptr<const motion::MotionModel> model,
            Motion motion)
      : scene_(std::move(scene)), model_(std::move(model)), motion_(std::move(motion)) {}

  haptics::HapticOutput to(const Pose& X_PTool) {
    time_s += kDt_s;
    haptics::HapticInput input{time_s, kDt_s, telemetry::to_tool_pose(X_PTool)};
    input.motion = now();
    return haptics::tick(state, input, *scene_);
  }
  telemetry::TickSample needle_to(const Vec3& tip_P) { return to(needle_pose(tip_P, Vec3::UnitZ())).sample; }
  motion::PatientMotion now() const {
    return model_ == nullptr ? motion::PatientMotion() : motion::PatientMotion(model_.get(), motion_(time_s));
  }
  const haptics::HapticScene& scene() const { return *scene_; }

  double time_s = 0.0;
  haptics::HapticState state;

 private:
  std::shared_ptr<const haptics::HapticScene> scene_;
  std::shared_ptr<const motion::MotionModel> model_;
  Motion motion_;
};

MotionState held(const motion::MotionModel::Scalars& drivers) {
  MotionState state;
  state.drivers = drivers;
  return state;
}

constexpr double kFar_s = 10.0;

/// A body that moves at a constant velocity (mm/s), with drifting().
std::shared_ptr<const motion::MotionModel> moving_body(const Vec3& velocity_mm_per_s) {
  return whole_body(kFar_s * velocity_mm_per_s);
}
MotionState drifting(double time_s) {
  MotionState state;
  state.rates_per_s[0] = 1.0 / kFar_s;
  state.drivers[0] = time_s / kFar_s;
  return state;
}

/// In to 45 mm, aside by 2 mm, out again: the tip against the patient's skin, one tick a step.
std::vector<Vec3> way_in_aside_and_out() {
  std::vector<Vec3> way;
  for (double z = -3.0; z < 45.0; z += 0.02) way.emplace_back(0.0, 0.0, z);
  for (double x = 0.0; x < 2.0; x += 0.01) way.emplace_back(x, 0.0, 45.0);
  for (int i = 0; i < 200; ++i) way.emplace_back(2.0, 0.0, 45.0);
  for (double z = 45.0; z > -3.0; z -= 0.03) way.emplace_back(2.0, 0.0, z);
  return way;
}

class MovingPatient : public ::testing::TestWithParam<ForceModel> {
 protected:
  std::shared_ptr<const haptics::HapticScene> scene_ = make_scene(liver_way(), GetParam());
};

/// Held at another place, a patient feels as it does at rest. With the proxy model a change of 1e-13 mm grows to 2e-3 N
/// at a border of the CT, also at rest, and may shift it by a tick.
TEST_P(MovingPatient, ForceIsInvariantToTheHeldPosition) {
  const Vec3 moved(32.0, -56.0, 20.0);
  MovingLab rest(scene_, nullptr, {}), away(scene_, whole_body(moved), [&](double) { return held({1.0}); });
  double worst_n = 0.0, worst_mm = 0.0;
  int other_tissue = 0;
  for (const Vec3& tip : way_in_aside_and_out()) {
    const telemetry::TickSample here = rest.needle_to(tip), there = away.needle_to(tip + moved);
    worst_n =
        std::max({worst_n, (there.device_f_n - here.device_f_n).norm(), (there.tau_nmm - here.tau_nmm).norm() / 200.0});
    worst_mm = std::max(worst_mm, (there.tip_mm - moved - here.tip_mm).norm());
    other_tissue += there.tissue != here.tissue ? 1 : 0;
  }
  EXPECT_LT(worst_n, 0.01);
  EXPECT_LT(worst_mm, 0.01);
  EXPECT_LE(other_tissue, 3);
}

/// A hand that moves with the patient feels what it feels at a patient at rest.
TEST_P(MovingPatient, ForceIsInvariantForAHandMovingAlong) {
  const Vec3 velocity(8.0, -5.0, 3.0);
  MovingLab rest(scene_, nullptr, {}), moving(scene_, moving_body(velocity), [&](double t) { return drifting(t); });
  double worst_n = 0.0, most_n = 0.0;
  for (const Vec3& tip : way_in_aside_and_out()) {
    const Vec3 moved = velocity * (moving.time_s + kDt_s);
    const telemetry::TickSample here = rest.needle_to(tip), there = moving.needle_to(tip + moved);
    worst_n = std::max(worst_n, (there.device_f_n - here.device_f_n).norm());
    most_n = std::max(most_n, (here.device_f_n - here.f_weight_n).norm());
  }
  EXPECT_GT(most_n, 2.0);
  EXPECT_LT(worst_n, 0.02);
}

/// Tissue that comes to a needle feels like a needle that comes to the tissue: the skin rises to a tip that rests.
TEST_P(MovingPatient, PuncturesANeedleAtRest) {
  constexpr double kSpeed_mm_per_s = 10.0;
  MovingLab rest(scene_, nullptr, {});
  MovingLab rising(scene_, moving_body({0.0, 0.0, -kSpeed_mm_per_s}), [&](double t) { return drifting(t); });
  std::vector<telemetry::TickSample> comes, waits;
  for (int tick = 1; tick <= 2500; ++tick) {
    const double z = -2.0 + kSpeed_mm_per_s * kDt_s * tick;
    comes.push_back(rest.needle_to({0.0, 0.0, z}));
    waits.push_back(rising.needle_to({0.0, 0.0, -2.0}));
  }
  EXPECT_EQ(punctures(waits), punctures(comes));
  EXPECT_FALSE(punctures(waits).empty());
  double worst_n = 0.0;
  for (std::size_t i = 0; i < waits.size(); ++i)
    worst_n = std::max(worst_n, (waits[i].device_f_n - comes[i].device_f_n).norm());
  EXPECT_LT(worst_n, 0.02);
  EXPECT_NEAR(waits.back().depth_mm, comes.back().depth_mm, 1e-3);
}

/// The hand feels the same coupling in compressed tissue: the map stiffens nothing.
TEST_P(MovingPatient, IsCoupledInTheRoom) {
  const auto bony = make_scene({{0, kFat}, {12, kMuscle}, {30, kBone}}, GetParam());
  const auto stiffness_n_per_mm = [&](const std::shared_ptr<const motion::MotionModel>& model) {
    MovingLab lab(bony, model, [](double) { return held({1.0}); });
    double before_n = 0.0;
    for (double z = -2.0; z < 60.0; z += 0.01) {
      const telemetry::TickSample sample = lab.needle_to({0.0, 0.0, z});
      const double n = resistance_n(sample);
      if (n > 20.0) return (n - before_n) / 0.01;
      before_n = n;
    }
    return 0.0;
  };
  const double at_rest = stiffness_n_per_mm(nullptr);
  EXPECT_GT(at_rest, 0.5);
  EXPECT_NEAR(stiffness_n_per_mm(stretched({0.0, 0.0, -40.0})), at_rest, 0.02 * at_rest);
}

/// Distances to the skin are those in the room, however much the tissue is compressed or stretched.
TEST(MovingPatientSkin, DistanceIsMeasuredInTheRoom) {
  const auto scene = make_scene(liver_way());
  const auto model = stretched({0.0, 0.0, -50.0});
  for (const double share : {1.5, 1.0, -0.3}) {
    const motion::PatientMotion now(model.get(), held({share}));
    for (const double z : {-4.0, 0.5, 5.0}) {
      const Vec3 p_P(3.0, -2.0, z);
      EXPECT_NEAR(haptics::skin_distance_mm({*scene, now}, p_P), -z, 1e-3) << share;
      EXPECT_LT((haptics::nearest_skin({*scene, now}, p_P) - Vec3(3.0, -2.0, 0.0)).norm(), 1e-3) << share;
    }
  }
}

/// Tissue that is stretched at an even rate e moves past the middle of a shaft of length L by e L / 2 more slowly than
/// past its tip.
TEST(MovingPatientShaft, TakesTheMeanVelocityOfItsTissue) {
  const auto model = stretched({0.0, 0.0, 30.0});
  MovingLab lab(make_scene(liver_way()), model, [](double) { return held({}); });
  for (double z = -3.0; z < 60.0; z += 0.02) lab.needle_to({0.0, 0.0, z});
  MotionState stretching = held({});
  stretching.rates_per_s[0] = 0.5;
  const motion::PatientMotion now(model.get(), stretching);
  constexpr double kRate_per_s = 0.5 * 30.0 / 100.0, kDepth_mm = 50.0;
  const double drift = haptics::tissue_drift_mm_per_s(lab.state.needle.path.channel, {lab.scene(), now}, kDepth_mm);
  EXPECT_NEAR(drift, 0.5 * kRate_per_s * kDepth_mm, 1e-3);
}

/// Liver that slides below the wall takes the tip along; the wall holds the shaft: the needle bends, in the way that
/// the liver went, and the hand is pulled that way.
TEST_P(MovingPatient, BendsANeedleInSlidingTissue) {
  const auto model = sliding_inside();
  constexpr double kSlide_mm = 6.0;
  double share = 0.0;
  MovingLab lab(scene_, model, [&](double) { return held({share * kSlide_mm / kUnit_mm}); });
  for (double z = -3.0; z < 60.0; z += 0.02) lab.needle_to({0.0, 0.0, z});
  telemetry::TickSample sample;
  for (int tick = 1; tick <= 1000; ++tick) {
    share = tick / 1000.0;
    sample = lab.needle_to({0.0, 0.0, 60.0});
  }
  EXPECT_GT((sample.device_f_n - sample.f_weight_n).x(), 0.05) << "the hand is pulled along";
  EXPECT_GT(sample.tip_mm.x(), kSlide_mm - 0.5) << "the tip stays in its tissue";
  EXPECT_LT(sample.tip_mm.x(), 1.25 * kSlide_mm) << "a stiff needle swings a little further";
  const telemetry::NeedleShape shape = haptics::needle_shape(lab.state.needle, {*scene_, lab.now()}, true);
  ASSERT_GT(shape.spans, 4);
  const auto beside_x_mm = [&](int node) {
    const auto& beside = shape.beside_mm[static_cast<std::size_t>(node)];
    const Mat3& R_PN = lab.state.needle.X_PN.R();
    return R_PN(0, 0) * static_cast<double>(beside[0]) + R_PN(0, 1) * static_cast<double>(beside[1]);
  };
  EXPECT_GT(beside_x_mm(shape.spans - 1), 0.4 * kSlide_mm) << "the tip";
  EXPECT_LT(beside_x_mm(0), 0.1 * kSlide_mm) << "the grip";
  // The channel is a line of tissue: back at rest it is where it was cut.
  for (int tick = 1; tick <= 1000; ++tick) {
    share = 1.0 - tick / 1000.0;
    sample = lab.needle_to({0.0, 0.0, 60.0});
  }
  EXPECT_NEAR(sample.tip_mm.x(), 0.0, 1e-3);
}

/// A hand that trembles while the needle passes the border along which the liver slides, comes back and rests in it:
/// the tip goes no other way than the hand and the tissue do.
TEST_P(MovingPatient, PassesSlidingTissueSmoothly) {
  constexpr double kSlide_mm = 10.0, kPeriod_s = 4.0, kDeepest_mm = 60.0, kRests_mm = 20.5, kSpeed_mm_per_s = 20.0;
  MovingLab lab(scene_, sliding_inside(), [&](double t) {
    return held({0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t / kPeriod_s)) * kSlide_mm / kUnit_mm});
  });
  const auto wobble_mm = [](double t, double hz) { return 0.3 * std::sin(2.0 * std::numbers::pi * hz * t); };
  Vec3 tip_before = Vec3::Zero(), hand_before = Vec3::Zero();
  double way_mm = 0.0, hands_mm = 0.0;
  int long_steps = 0;
  for (int tick = 0; tick < 9000; ++tick) {
    const double t = tick * kDt_s, inward_mm = -3.0 + kSpeed_mm_per_s * t;
    const double z = inward_mm < kDeepest_mm ? inward_mm : std::max(2.0 * kDeepest_mm - inward_mm, kRests_mm);
    const Vec3 hand(wobble_mm(t, 9.0), wobble_mm(t, 11.0), z + wobble_mm(t, 8.0));
    const Vec3 tip = lab.needle_to(hand).tip_mm;
    if (tick > 0) {
      way_mm += (tip - tip_before).norm();
      hands_mm += (hand - hand_before).norm();
      long_steps += (tip - tip_before).norm() > 0.5 ? 1 : 0;
    }
    tip_before = tip;
    hand_before = hand;
  }
  EXPECT_LT(long_steps, 20) << "where walls give way";
  EXPECT_LT(way_mm, hands_mm + 2.0 * kSlide_mm * 9.0 / kPeriod_s + 20.0);
}

/// A needle that is pushed on through sheared tissue runs straight in the room, and is curved in the tissue at rest.
TEST_P(MovingPatient, CutsStraightInTheRoom) {
  const auto parts = motion::testing::whole_body({bump({8.0, 0.0, 0.0}, {0.0, 0.0, 40.0}, 20.0)});
  MovingLab lab(scene_, made(parts), [](double) { return held({1.0}); });
  for (double z = -3.0; z < 65.0; z += 0.02) lab.needle_to({0.0, 0.0, z});
  const haptics::Channel& channel = lab.state.needle.path.channel;
  ASSERT_GT(channel.nodes.count, 25);
  const motion::PatientMotion now = lab.now();
  double bent_mm = 0.0;
  for (int node = 0; node < channel.nodes.count; ++node) {
    const Vec3& p_A = channel.nodes.p_A[static_cast<std::size_t>(node)];
    const Vec3 p_P = now.to_now(p_A);
    EXPECT_LT(std::hypot(p_P.x(), p_P.y()), 1e-3) << node;
    bent_mm = std::max(bent_mm, -p_A.x());
  }
  EXPECT_GT(bent_mm, 5.0);
}

TEST_P(MovingPatient, NeverAllocates) {
  const auto model = moving_body({3.0, 0.0, 1.0});
  MovingLab lab(scene_, model, [](double t) { return drifting(t); });
  std::size_t events = 0;
  for (double z = -3.0; z < 50.0; z += 0.05) {
    const AllocationGuard guard;
    lab.needle_to({0.0, 0.0, z});
    events += guard.count();
  }
  EXPECT_EQ(events, 0U);
}

INSTANTIATE_TEST_SUITE_P(EveryModel, MovingPatient,
                         ::testing::Values(ForceModel::kInsertion, ForceModel::kProxy, ForceModel::kCombined),
                         [](const auto& model) { return std::string(to_string(model.param)); });

/// Paper A's path constraint, which knows no bending: its line goes from the skin to the tip.
TEST(MovingPatientConstraint, HoldsTheNeedleToTheLineFromSkinToTip) {
  const auto scene = make_scene(liver_way(), ForceModel::kInsertion, constrained_tissues());
  const auto model = stretched({20.0, 0.0, 0.0});
  double share = 0.0;
  MovingLab lab(scene, model, [&](double) { return held({share}); });
  for (double z = -3.0; z < 60.0; z += 0.02) lab.needle_to({0.0, 0.0, z});
  telemetry::TickSample sample;
  for (int tick = 1; tick <= 1000; ++tick) {
    share = tick / 1000.0;
    sample = lab.needle_to({0.0, 0.0, 60.0});
  }
  // The channel leans by 0.2: a torque about +y turns the needle along it.
  EXPECT_GT(sample.tau_nmm.y(), 20.0);
}

/// A transducer on skin that rises under it presses like one that is pushed onto skin at rest.
TEST(MovingPatientContact, PatientMotionPressesLikeToolMotion) {
  const auto scene = make_face_scene(haptics::Tool::kTransducer, all_fat);
  constexpr double kSpeed_mm_per_s = 10.0;
  MovingLab rest(scene, nullptr, {});
  MovingLab rising(scene, moving_body({0.0, 0.0, -kSpeed_mm_per_s}), [&](double t) { return drifting(t); });
  double worst_n = 0.0, most_n = 0.0;
  for (int tick = 1; tick <= 1200; ++tick) {
    const double z = -4.0 + kSpeed_mm_per_s * kDt_s * tick;
    const telemetry::TickSample comes = rest.to(face_down({0.0, 0.0, z})).sample;
    const telemetry::TickSample waits = rising.to(face_down({0.0, 0.0, -4.0})).sample;
    worst_n = std::max(worst_n, (waits.device_f_n - comes.device_f_n).norm());
    most_n = std::max(most_n, (comes.device_f_n - comes.f_weight_n).norm());
  }
  EXPECT_GT(most_n, 1.0);
  EXPECT_LT(worst_n, 0.02 * most_n);
}

/// Skin that slides under a transducer drags it, up to its friction; a transducer that goes along is not dragged.
TEST(MovingPatientContact, DragsATransducerAtRest) {
  const auto scene = make_face_scene(haptics::Tool::kTransducer, all_fat);
  const auto drag_n = [&](bool goes_along) {
    const Vec3 velocity(10.0, 0.0, 0.0);
    MovingLab lab(scene, moving_body(velocity), [&](double t) { return t < 0.5 ? held({}) : drifting(t - 0.5); });
    telemetry::TickSample sample;
    for (int tick = 1; tick <= 1000; ++tick) {
      const double z = std::min(6.0, -2.0 + 0.02 * tick);
      const double x = goes_along && tick > 500 ? velocity.x() * kDt_s * (tick - 500) : 0.0;
      sample = lab.to(face_down({x, 0.0, z})).sample;
    }
    EXPECT_LT((sample.device_f_n - sample.f_weight_n).z(), -0.5) << "it is pressed on";
    return (sample.device_f_n - sample.f_weight_n).x();
  };
  EXPECT_GT(drag_n(false), 0.03) << "friction of gel, 0.05";
  EXPECT_LT(std::abs(drag_n(true)), 0.2 * drag_n(false));
}

/// What lies below the skin is found where it is now: a rib that slid away from under the tool is not felt.
TEST(MovingPatientContact, RendersBoneAtItsCurrentPosition) {
  const auto rib = [](const Vec3& p) { return std::abs(p.x()) < 8.0 && p.z() > 6.0 ? kBone : kFat; };
  const auto scene = make_face_scene(haptics::Tool::kFinger, rib);
  const auto parts = sliding_parts(flat_border(Vec3::UnitZ(), 4.0), {uniform(30.0 * Vec3::UnitX())});
  const auto pressed_n = [&](double share, double x_mm) {
    MovingLab lab(scene, made(parts), [&](double) { return held({share}); });
    telemetry::TickSample sample;
    for (double z = -1.0; z < 4.0; z += 0.01) sample = lab.to(face_down({x_mm, 0.0, z})).sample;
    return -(sample.device_f_n - sample.f_weight_n).z();
  };
  const double on_rib_n = pressed_n(0.0, 0.0), beside_n = pressed_n(0.0, 30.0);
  EXPECT_GT(on_rib_n, 1.3 * beside_n);
  EXPECT_NEAR(pressed_n(1.0, 0.0), beside_n, 0.05 * beside_n);
  EXPECT_NEAR(pressed_n(1.0, 30.0), on_rib_n, 0.05 * on_rib_n);
}

}  // namespace
}  // namespace trocar::testing
