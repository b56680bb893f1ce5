#include "tasks/operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/testing/allocation_guard.inc.h"
#include "geometry/pose.h"
#include "tasks/testing/layered_body.h"

namespace trocar::tasks {
namespace {

using testing::bone_below_skin;
using testing::LayeredBody;
using testing::skin_muscle_capsule;

OperatorCase case_of_length(double length_mm, std::uint64_t seed = 1) {
  const Vec3 axis_P = Vec3(0.3, 0.8, -0.5).normalized();
  const Vec3 entry_P(-20.0, -100.0, 40.0);
  return {{entry_P, entry_P + length_mm * axis_P}, true, seed};
}

double deepest_mm(const LayeredBody& body) {
  double deepest = -1e9;
  for (const telemetry::TickSample& sample : body.samples) deepest = std::max(deepest, body.depth_mm(sample));
  return deepest;
}

TEST(Expert, FiresOnceAtTheTargetAtAnyRate) {
  for (const double dt_s : {0.004, 0.001, 0.00025}) {
    const OperatorCase the_case = case_of_length(75.0);
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), dt_s);
    body.run(*make_expert(the_case), 60.0);
    ASSERT_TRUE(body.is_done) << dt_s;
    EXPECT_EQ(body.punctured, 3u);
    ASSERT_EQ(body.fired.size(), 1u);
    EXPECT_LT((body.samples[body.fired[0]].tip_mm - the_case.path_P.b).norm(), 0.8) << dt_s;
    EXPECT_LT(deepest_mm(body), 75.0 + 1.0);
    EXPECT_GT(body.last().time_s, 12.0);
    EXPECT_LT(body.last().time_s, 30.0);
    EXPECT_LT(body.depth_mm(body.last()), -15.0);
  }
}

/// The actions of a whole attempt of the expert.
std::vector<ActionKind> actions_of_expert(const OperatorCase& the_case, LayeredBody& body) {
  std::vector<ActionKind> kinds;
  auto expert = make_expert(the_case);
  struct Watch final : Operator {
    HandCommand next(const OperatorView& view) noexcept override {
      const HandCommand command = watched.next(view);
      if (command.action) kinds.push_back(command.action->kind);
      return command;
    }
    Operator& watched;
    std::vector<ActionKind>& kinds;
    Watch(Operator& o, std::vector<ActionKind>& k) : watched(o), kinds(k) {}
  } watch(*expert, kinds);
  body.run(watch, 60.0);
  return kinds;
}

TEST(Expert, TakesCoresCoaxiallyOrByRepeatedPuncture) {
  for (const bool loads_inside : {true, false}) {
    OperatorCase the_case = case_of_length(75.0);
    the_case.actions.cores = 2;
    the_case.actions.loads_inside = loads_inside;
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    using enum ActionKind;
    EXPECT_EQ(actions_of_expert(the_case, body), (std::vector<ActionKind>{kFire, kLoad, kFire}));
    ASSERT_EQ(body.fired.size(), 2u);
    for (const std::size_t fired : body.fired)
      EXPECT_NEAR(body.depth_mm(body.samples[fired]), 75.0, 0.8) << loads_inside;
    double shallowest_mm = 75.0;
    for (std::size_t n = body.fired[0]; n < body.fired[1]; ++n)
      shallowest_mm = std::min(shallowest_mm, body.depth_mm(body.samples[n]));
    if (loads_inside) {
      EXPECT_GT(shallowest_mm, 73.0);
    } else {
      EXPECT_LT(shallowest_mm, -15.0);
    }
  }
}

/// Asked to hold the breath, the patient does so after a while, for as long as it can; a limit of 0: not at all.
struct Breathing final : Operator {
  HandCommand next(const OperatorView& view) noexcept override {
    OperatorView seen = view;
    const double since_s = asked_s ? view.time_s - *asked_s - kReacts_s : -1.0;
    seen.last.is_breath_held = since_s >= 0.0 && since_s < limit_s;
    was_held = was_held || seen.last.is_breath_held;
    const HandCommand command = watched.next(seen);
    if (!seen.last.is_breath_held && view.last.depth_mm > 0.0) unheld_s += view.dt_s;
    if (!command.action) return command;
    kinds.push_back(command.action->kind);
    if (kinds.back() == ActionKind::kHoldBreath) asked_s = view.time_s;
    if (kinds.back() == ActionKind::kBreathe) asked_s.reset();
    return command;
  }
  Breathing(Operator& o, double limit) : watched(o), limit_s(limit) {}
  static constexpr double kReacts_s = 4.0;
  Operator& watched;
  double limit_s;
  std::optional<double> asked_s;
  bool was_held = false;
  std::vector<ActionKind> kinds;
  double unheld_s = 0.0;  ///< Of the needle in the body.
};

OperatorCase breathing_case(std::uint64_t seed = 1) {
  OperatorCase the_case = case_of_length(60.0, seed);
  the_case.actions.holds_breath = true;
  return the_case;
}

TEST(Expert, InsertsOnlyWhileTheBreathIsHeld) {
  using enum ActionKind;
  const OperatorCase the_case = breathing_case();
  LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
  auto expert = make_expert(the_case);
  Breathing patient(*expert, 20.0);
  body.run(patient, 60.0);
  EXPECT_TRUE(body.is_done);
  EXPECT_EQ(patient.kinds, (std::vector<ActionKind>{kHoldBreath, kFire, kBreathe}));
  EXPECT_EQ(patient.unheld_s, 0.0);
}

TEST(Expert, AsksAgainAndGoesOnWithoutAHeldBreath) {
  for (const double limit_s : {4.0, 0.0}) {
    const OperatorCase the_case = breathing_case();
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    auto expert = make_expert(the_case);
    Breathing patient(*expert, limit_s);
    body.run(patient, 60.0);
    EXPECT_TRUE(body.is_done) << limit_s;
    EXPECT_EQ(body.fired.size(), 1u) << limit_s;
    EXPECT_EQ(std::ranges::count(patient.kinds, ActionKind::kHoldBreath) > 1, limit_s > 0.0);
  }
}

TEST(Novice, SometimesForgetsToAskForTheBreath) {
  constexpr int kNovices = 60;
  int asks = 0, waits = 0;
  for (int seed = 1; seed <= kNovices; ++seed) {
    const OperatorCase the_case = breathing_case(static_cast<std::uint64_t>(seed));
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.004);
    auto novice = make_novice(the_case);
    Breathing patient(*novice, 20.0);
    body.run(patient, 60.0);
    EXPECT_TRUE(body.is_done) << seed;
    const bool has_asked = !patient.kinds.empty() && patient.kinds.front() == ActionKind::kHoldBreath;
    asks += has_asked ? 1 : 0;
    waits += has_asked && patient.was_held && patient.unheld_s < 1.0 ? 1 : 0;
  }
  EXPECT_GT(asks, kNovices / 2);
  EXPECT_LT(asks, kNovices * 9 / 10);
  EXPECT_GT(waits, 0);
  EXPECT_LT(waits, asks);
}

/// An operator that sees `substance` come back from a depth on, nothing before it.
struct Looking final : Operator {
  HandCommand next(const OperatorView& view) noexcept override {
    OperatorView seen = view;
    seen.returned = returned;
    const HandCommand command = watched.next(seen);
    if (!command.action) return command;
    kinds.push_back(command.action->kind);
    if (command.action->kind == ActionKind::kDrawStylet) {
      const double depth_mm = (view.last.tip_mm - path_P.a).dot(path_P.direction());
      returned.emplace().substance = depth_mm > opens_mm ? Substance::kCsf : Substance::kNothing;
    }
    return command;
  }
  Looking(Operator& o, const Segment& path, double opens) : watched(o), path_P(path), opens_mm(opens) {}
  Operator& watched;
  Segment path_P;
  double opens_mm;
  std::optional<Return> returned;
  std::vector<ActionKind> kinds;
};

TEST(Expert, AdvancesWithoutReturnUpToALimit) {
  OperatorCase the_case = case_of_length(60.0);
  the_case.fires_biopsy = false;
  the_case.actions.confirms = ActionKind::kDrawStylet;
  the_case.actions.awaited = Substance::kCsf;
  using enum ActionKind;
  for (const double opens_mm : {50.0, 62.0, 500.0}) {
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    const auto expert = make_expert(the_case);
    Looking looking(*expert, the_case.path_P, opens_mm);
    body.run(looking, 60.0);
    ASSERT_TRUE(body.is_done) << opens_mm;
    const bool is_open_at_once = opens_mm < 60.0;
    EXPECT_EQ(looking.kinds.size(), is_open_at_once ? 1u : 5u) << "each further look: stylet in, on, stylet out";
    EXPECT_LT(deepest_mm(body), is_open_at_once ? 61.0 : 71.5);
    EXPECT_EQ(std::ranges::count(looking.kinds, kReplaceStylet), is_open_at_once ? 0 : 2) << opens_mm;
  }
}

TEST(Expert, NeverOvershootsOnPathsOfAnyLength) {
  for (double length_mm = 42.0; length_mm <= 150.0; length_mm += 12.0) {
    const OperatorCase the_case = case_of_length(length_mm, static_cast<std::uint64_t>(length_mm));
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    body.run(*make_expert(the_case), 60.0);
    ASSERT_EQ(body.fired.size(), 1u) << length_mm;
    EXPECT_LT(deepest_mm(body), length_mm + 1.0);
    EXPECT_NEAR(body.depth_mm(body.samples[body.fired[0]]), length_mm, 0.8);
    EXPECT_LT(body.last().time_s, 30.0);
  }
}

TEST(Expert, PausesAtTheSkinAndBeforeFiring) {
  const OperatorCase the_case = case_of_length(75.0);
  LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
  body.run(*make_expert(the_case), 60.0);
  const auto speed_mm_s = [&](std::size_t from, std::size_t to) {
    return (body.depth_mm(body.samples[to]) - body.depth_mm(body.samples[from])) /
           (body.samples[to].time_s - body.samples[from].time_s);
  };
  const auto touch =
      static_cast<std::size_t>(std::find_if(body.samples.begin(), body.samples.end(),
                                            [](const telemetry::TickSample& sample) {
                                              return (sample.device_f_n - sample.f_weight_n).norm() > 0.15;
                                            }) -
                               body.samples.begin());
  EXPECT_LT(std::abs(speed_mm_s(touch + 250, touch + 450)), 1.0);
  EXPECT_LT(std::abs(speed_mm_s(body.fired[0] - 200, body.fired[0])), 1.0);
}

TEST(Expert, GivesUpWithoutFiringAtBone) {
  const OperatorCase the_case = case_of_length(75.0);
  LayeredBody body(the_case.path_P, bone_below_skin(), 0.001);
  body.run(*make_expert(the_case), 60.0);
  EXPECT_TRUE(body.is_done);
  EXPECT_TRUE(body.fired.empty());
  EXPECT_LT(body.depth_mm(body.last()), -15.0);
}

TEST(Novice, FiresAndEndsWithinAMinuteForEverySeed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const auto& layers : {skin_muscle_capsule(), bone_below_skin()}) {
      const OperatorCase the_case = case_of_length(90.0, seed);
      LayeredBody body(the_case.path_P, layers, 0.001);
      body.run(*make_novice(the_case), 60.0);
      EXPECT_TRUE(body.is_done) << seed;
      EXPECT_EQ(body.fired.size(), 1u) << seed;
      EXPECT_LT(body.depth_mm(body.last()), -10.0) << seed;
    }
}

TEST(Novice, MissesEntryAngleAndTarget) {
  double miss_mm = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const OperatorCase the_case = case_of_length(90.0, seed);
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    body.run(*make_novice(the_case), 60.0);
    const auto skin = std::find_if(body.samples.begin(), body.samples.end(),
                                   [&](const telemetry::TickSample& sample) { return body.depth_mm(sample) > 0.0; });
    ASSERT_NE(skin, body.samples.end());
    const double entry_error_mm = (skin->tip_mm - the_case.path_P.a).norm();
    EXPECT_GT(entry_error_mm, 0.4) << seed;  // a quarter of 3 mm to 8 mm, and the tremor
    EXPECT_LT(entry_error_mm, 9.0) << seed;
    ASSERT_EQ(body.fired.size(), 1u);
    const telemetry::TickSample& fired = body.samples[body.fired[0]];
    const double angle_deg = degrees(angle_between_rad(fired.axis, the_case.path_P.direction()));
    EXPECT_GT(angle_deg, 0.4) << seed;  // a quarter of 2° to 6°
    EXPECT_LT(angle_deg, 6.1) << seed;
    EXPECT_GT((fired.tip_mm - the_case.path_P.b).norm(), 0.8) << seed;  // worse than the expert's worst
    miss_mm += (fired.tip_mm - the_case.path_P.b).norm() / 20.0;
  }
  EXPECT_GT(miss_mm, 4.0);
}

/// A stretch of an attempt on one line of the wanted needle.
struct Leg {
  Vec3 axis_P;
  Vec3 entry_P = Vec3::Zero();  ///< Where the line crosses the plane across the planned path at its entry; mean.
  double begin_mm = 0.0;        ///< Depth of the tip when the line was taken up.
  double deepest_mm = -HUGE_VAL;
};

/// Runs an operator and splits its attempt wherever the wanted needle turns; its tremor does not turn it.
std::vector<Leg> legs_of(Operator& the_operator, const Segment& plan_P, LayeredBody& body) {
  struct Watch final : Operator {
    HandCommand next(const OperatorView& view) noexcept override {
      const HandCommand command = watched.next(view);
      const Vec3 axis_P = command.X_PN.R().col(2);
      const double tip_mm = body.samples.empty() ? -HUGE_VAL : body.depth_mm(body.last());
      if (legs.empty() || axis_P != legs.back().axis_P) {
        legs.push_back({axis_P, Vec3::Zero(), tip_mm});
        commands = 0.0;
      }
      Leg& leg = legs.back();
      const Vec3 tip_P = command.X_PN.p();
      const Vec3 plan_axis_P = plan_P.direction();
      const Vec3 entry_P = tip_P - (tip_P - plan_P.a).dot(plan_axis_P) / axis_P.dot(plan_axis_P) * axis_P;
      leg.entry_P += (entry_P - leg.entry_P) / ++commands;
      leg.deepest_mm = std::max(leg.deepest_mm, tip_mm);
      return command;
    }
    Watch(Operator& o, const Segment& plan, LayeredBody& b) : watched(o), plan_P(plan), body(b) {}
    Operator& watched;
    const Segment plan_P;
    LayeredBody& body;
    std::vector<Leg> legs;
    double commands = 0.0;
  } watch(the_operator, plan_P, body);
  body.run(watch, 60.0);
  return watch.legs;
}

TEST(Novice, CorrectsItsErrorsAfterEachBoneContact) {
  constexpr double kBone_mm = 14.0;
  constexpr double kLeft = 0.7;        // share of the errors that a correction leaves
  constexpr double kChord_rad = 1e-4;  // this share of the way between two ends is not quite that of the angle
  constexpr double kTremor_mm = 0.05;  // the mean of 8 Hz and more over the seconds of a leg
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const OperatorCase the_case = case_of_length(90.0, seed);
    const Segment& plan_P = the_case.path_P;
    LayeredBody body(plan_P, bone_below_skin(), 0.001);
    const std::vector<Leg> legs = legs_of(*make_novice(the_case), plan_P, body);
    ASSERT_EQ(legs.size(), 3u) << seed;
    for (std::size_t n = 1; n < legs.size(); ++n) {
      const Leg &before = legs[n - 1], &now = legs[n];
      EXPECT_LT(now.begin_mm, -10.0) << seed << ": outside of the body before it turns";
      EXPECT_GE(before.deepest_mm, kBone_mm) << seed;
      EXPECT_LT(before.deepest_mm, kBone_mm + 1.0) << seed;
      const double before_rad = angle_between_rad(before.axis_P, plan_P.direction());
      EXPECT_GT(before_rad, 0.01) << seed;
      EXPECT_NEAR(angle_between_rad(now.axis_P, plan_P.direction()), kLeft * before_rad, kChord_rad) << seed;
      EXPECT_LT((now.entry_P - plan_P.a - kLeft * (before.entry_P - plan_P.a)).norm(), kTremor_mm) << seed;
    }
    EXPECT_GE(legs.back().deepest_mm, kBone_mm) << seed << ": in again";
  }
}

TEST(Novice, KeepsItsLineWithoutBone) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const OperatorCase the_case = case_of_length(90.0, seed);
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    const std::vector<Leg> legs = legs_of(*make_novice(the_case), the_case.path_P, body);
    EXPECT_EQ(legs.size(), 1u) << seed;
    ASSERT_EQ(body.fired.size(), 1u) << seed;
    bool was_inside = false;
    for (std::size_t n = 0; n < body.fired[0]; ++n) {
      const double depth_mm = body.depth_mm(body.samples[n]);
      was_inside = was_inside || depth_mm > 5.0;
      if (was_inside) {
        ASSERT_GT(depth_mm, -5.0) << seed << ": pulls back, but does not withdraw";
      }
    }
  }
}

TEST(Novice, IsTheSameForTheSameSeedOnly) {
  const auto run = [](std::uint64_t seed) {
    const OperatorCase the_case = case_of_length(70.0, seed);
    LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
    body.run(*make_novice(the_case), 60.0);
    return body.samples;
  };
  const auto a = run(3);
  const auto b = run(3);
  const auto c = run(4);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].tip_mm, b[i].tip_mm);
  EXPECT_NE(a[1000].tip_mm, c[1000].tip_mm);
}

TEST(ConstantVelocity, MovesTheDeviceItselfInAndOut) {
  const OperatorCase the_case = case_of_length(40.0);
  const double speed_mm_s = 10.0;
  LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
  body.run(*make_constant_velocity(the_case, speed_mm_s), 60.0);
  ASSERT_TRUE(body.is_done);
  EXPECT_NEAR(body.last().time_s, 10.0, 0.002);  // 50 mm in, 50 mm out
  ASSERT_EQ(body.fired.size(), 1u);
  EXPECT_NEAR(body.samples[body.fired[0]].time_s, 5.0, 0.002);
  for (const telemetry::TickSample& sample : body.samples) {
    const double expected_mm = std::max(-10.0, 40.0 - speed_mm_s * std::abs(5.0 - sample.time_s));
    EXPECT_LT((sample.device_mm - (the_case.path_P.a + expected_mm * the_case.path_P.direction())).norm(), 1e-6);
  }
}

TEST(Replay, GivesTheRecordedDevicePosesTickByTick) {
  const OperatorCase the_case = case_of_length(60.0, 7);
  LayeredBody recorded(the_case.path_P, skin_muscle_capsule(), 0.001);
  recorded.run(*make_novice(the_case), 60.0);
  for (telemetry::TickSample& sample : recorded.samples) {
    sample.device_rotation_wxyz = to_wxyz(Eigen::Quaterniond(needle_pose(sample.device_mm, sample.axis).R()));
  }
  LayeredBody replayed(the_case.path_P, skin_muscle_capsule(), 0.001);
  Action shot;
  shot.time_s = recorded.samples.at(recorded.fired.at(0)).time_s;
  shot.kind = ActionKind::kFire;
  replayed.run(*make_replay(recorded.samples, {shot}), 60.0);
  ASSERT_TRUE(replayed.is_done);
  EXPECT_EQ(replayed.fired, recorded.fired);
  ASSERT_GE(replayed.samples.size(), recorded.samples.size());
  for (std::size_t i = 0; i < recorded.samples.size(); ++i) {
    ASSERT_EQ(replayed.samples[i].device_mm, recorded.samples[i].device_mm) << i;
    ASSERT_LT((replayed.samples[i].axis - recorded.samples[i].axis).norm(), 1e-9) << i;
  }
}

TEST(Replay, EndsImmediatelyWithoutPoses) {
  OperatorView view;
  view.X_PN_device = Pose::translation({1.0, 2.0, 3.0});
  const HandCommand command = make_replay({})->next(view);
  EXPECT_TRUE(command.is_done);
  EXPECT_EQ(command.X_PN.p(), view.X_PN_device.p());
}

TEST(Operators, AllocateNothingInATick) {
  const OperatorCase the_case = case_of_length(60.0);
  const std::unique_ptr<Operator> operators[] = {make_expert(the_case), make_novice(the_case),
                                                 make_constant_velocity(the_case, 10.0),
                                                 make_replay(std::vector<telemetry::TickSample>(500))};
  OperatorView view;
  const testing::AllocationGuard guard;
  for (int tick = 0; tick < 1000; ++tick) {
    view.time_s = 0.001 * tick;
    for (const auto& the_operator : operators) view.X_PN_device = the_operator->next(view).X_PN;
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(Operators, KeepCommandsFiniteForAnyView) {
  const OperatorCase the_case = case_of_length(60.0);
  for (const auto& the_operator : {make_expert, make_novice}) {
    const auto one = the_operator(the_case);
    OperatorView view;
    for (int tick = 0; tick < 2000; ++tick) {
      view.time_s = 0.001 * tick;
      view.last.device_f_n = Vec3::Constant(tick % 2 == 0 ? 1e9 : -1e9);
      view.last.tip_mm = Vec3::Constant(tick % 3 == 0 ? 1e9 : 0.0);
      const HandCommand command = one->next(view);
      ASSERT_TRUE(command.X_PN.is_finite() && command.v_P.allFinite());
    }
  }
}

}  // namespace
}  // namespace trocar::tasks
