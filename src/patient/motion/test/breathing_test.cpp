// Traces of breathing: continuous, within their limits, and a function of the time alone.
#include "motion/breathing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/breathing_choice.h"
#include "motion/testing/sliding_motion.h"

namespace trocar::motion {
namespace {

MotionDrive regular() {
  MotionDrive drive;
  drive.period_s = 4.0;
  drive.begins_s = 1.0;
  drive.depth = {1.0, 0.5};
  drive.pause_share = 0.25;
  return drive;
}

MotionDrive irregular(std::uint32_t seed) {
  MotionDrive drive = regular();
  drive.irregularity = 0.4;
  drive.cough_every_s = 15.0;
  drive.seed = seed;
  return drive;
}

TEST(Breathing, BeginsAtEndExpirationAndPausesThere) {
  const MotionDrive drive = regular();
  EXPECT_EQ(state_at(drive, 1.0).drivers[0], 0.0);
  EXPECT_EQ(state_at(drive, 1.0).phase, 0.0);
  // 3 s of movement, of which 40 % breathe in.
  EXPECT_NEAR(state_at(drive, 2.2).drivers[0], 1.0, 1e-12);
  EXPECT_NEAR(state_at(drive, 2.2).phase, 0.5, 1e-12);
  const double sine = std::sin(std::numbers::pi * (0.2 + 0.16 / 2.4));
  EXPECT_NEAR(state_at(drive, 1.6).drivers[0], sine * sine, 1e-12);
  for (const double pause_s : {4.0, 4.5, 4.999, 0.5}) {
    EXPECT_EQ(state_at(drive, pause_s).drivers[0], 0.0) << pause_s;
    EXPECT_EQ(state_at(drive, pause_s).rates_per_s[0], 0.0) << pause_s;
  }
  EXPECT_NEAR(state_at(drive, 2.2 + 4.0 * 25.0).drivers[0], 1.0, 1e-9);
}

TEST(Breathing, ChestReturnsOnAnotherPath) {
  const MotionDrive drive = regular();
  const double in = state_of_phase(drive, 0.25).drivers[1], out = state_of_phase(drive, 0.75).drivers[1];
  EXPECT_NEAR(state_of_phase(drive, 0.25).drivers[0], state_of_phase(drive, 0.75).drivers[0], 1e-12);
  EXPECT_GT(in, out + 0.05);
}

TEST(Breathing, IsContinuousWithTrueRates) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    MotionDrive drive = irregular(seed);
    drive.hold_s = 20.0;
    drive.drift_per_s = -0.01;
    constexpr double kStep_s = 1e-4;
    for (double t = 0.9; t < 60.0; t += 0.0037) {
      const MotionState before = state_at(drive, t - kStep_s), now = state_at(drive, t),
                        behind = state_at(drive, t + kStep_s);
      for (std::size_t d = 0; d < kMostDrivers; ++d) {
        ASSERT_LT(std::abs(now.drivers[d] - before.drivers[d]), 1e-3) << t;
        // Where a cough begins, the acceleration steps; where a hold does, the speed, by the drift.
        ASSERT_NEAR((behind.drivers[d] - before.drivers[d]) / (2.0 * kStep_s), now.rates_per_s[d], 0.02) << t;
      }
    }
  }
}

TEST(Breathing, VariesWithinItsLimits) {
  const MotionDrive drive = irregular(3);
  double deepest = 0.0, shallowest = 9.0, highest = 0.0;
  std::vector<double> begins_s;
  MotionState before = state_at(drive, 1.0);
  for (double t = 1.0; t < 400.0; t += 0.01) {
    const MotionState now = state_at(drive, t);
    highest = std::max(highest, now.drivers[0]);
    if (now.phase >= 0.5 && before.phase < 0.5) {
      deepest = std::max(deepest, now.drivers[0]);
      shallowest = std::min(shallowest, now.drivers[0]);
      begins_s.push_back(t);
    }
    before = now;
  }
  EXPECT_NEAR(static_cast<double>(begins_s.size()), 100.0, 2.0) << "the mean rate is kept";
  EXPECT_GT(deepest, 1.2);
  EXPECT_LT(shallowest, 0.8);
  EXPECT_LE(highest, kMostDrive);
  double shortest = 9.0, longest = 0.0;
  for (std::size_t n = 1; n < begins_s.size(); ++n) {
    shortest = std::min(shortest, begins_s[n] - begins_s[n - 1]);
    longest = std::max(longest, begins_s[n] - begins_s[n - 1]);
  }
  EXPECT_GT(shortest, 2.0);
  EXPECT_GT(longest, shortest + 1.0);
  EXPECT_NE(state_at(irregular(4), 30.0).drivers, state_at(drive, 30.0).drivers);
  EXPECT_EQ(state_at(irregular(3), 30.0).drivers, state_at(drive, 30.0).drivers);
}

TEST(Breathing, HoldsTheBreathAtEndExpirationWhenAsked) {
  MotionDrive drive = regular();
  drive.drift_per_s = -0.004;
  for (double asked_s = 0.0; asked_s < 8.0; asked_s += 0.31) {
    drive.hold_s = asked_s;
    const double from_s = hold_begins_s(drive), to_s = hold_ends_s(drive);
    EXPECT_GE(from_s, asked_s + 0.4);
    EXPECT_LE(from_s, asked_s + 1.0 + 4.0);
    EXPECT_EQ(to_s, from_s + drive.hold_limit_s);
    EXPECT_FALSE(state_at(drive, 1.0 + from_s - 0.01).is_breath_held);
    EXPECT_NEAR(state_at(drive, 1.0 + from_s - 1e-6).drivers[0], 0.0, 1e-6);
    const MotionState held = state_at(drive, 1.0 + from_s + 10.0);
    EXPECT_TRUE(held.is_breath_held);
    EXPECT_NEAR(held.drivers[0], -0.04, 1e-9);
    EXPECT_EQ(held.phase, 0.0);
    const MotionState deeper = state_at(drive, 1.0 + to_s + 1.2);
    EXPECT_FALSE(deeper.is_breath_held);
    EXPECT_NEAR(deeper.drivers[0], 1.3, 1e-9) << "out of breath";
    EXPECT_NEAR(state_at(drive, 1.0 + to_s + 4.0 + 1.2).drivers[0], 1.0, 1e-9);
  }
}

TEST(Breathing, EndsTheHoldWhenReleased) {
  MotionDrive drive = regular();
  drive.hold_s = 2.0;
  const double from_s = hold_begins_s(drive);
  drive.release_s = from_s + 5.0;
  EXPECT_NEAR(hold_ends_s(drive), from_s + 5.3, 1e-12);
  EXPECT_NEAR(state_at(drive, 1.0 + from_s + 5.3 + 1.2).drivers[0], 1.0, 1e-9) << "not out of breath";
  drive.release_s = 2.1;
  EXPECT_LT(hold_begins_s(drive), 0.0) << "taken back before the patient held it";
  EXPECT_FALSE(state_at(drive, 1.0 + from_s + 1.0).is_breath_held);
}

/// Whatever is asked when, the new drive goes on where the old one is.
TEST(Breathing, GoesOnWhenAskedAgain) {
  MotionDrive drive = irregular(2);
  drive.drift_per_s = -0.02;
  drive.hold_limit_s = 6.0;
  for (double t = 1.2; t < 240.0; t += 2.37) {
    const int turn = static_cast<int>(t) % 3;
    const MotionDrive next = turn == 0 ? released(drive, t) : asked_to_hold(drive, t);
    ASSERT_TRUE(check(next));
    for (const double later_s : {0.0, 0.1, 0.35}) {
      const MotionState before = state_at(drive, t + later_s), now = state_at(next, t + later_s);
      if (later_s > 0.25 && turn == 0) continue;
      ASSERT_NEAR(now.drivers[0], before.drivers[0], 1e-9) << t;
      ASSERT_NEAR(now.drivers[1], before.drivers[1], 1e-9) << t;
    }
    drive = next;
  }
  drive = regular();
  EXPECT_EQ(asked_to_hold(drive, 0.5), drive) << "before it begins";
  EXPECT_EQ(released(drive, 9.0), drive) << "nobody holds the breath";
  const MotionDrive asked = asked_to_hold(drive, 5.0);
  EXPECT_EQ(asked_to_hold(asked, 6.0), asked) << "asked already";
  EXPECT_NE(asked_to_hold(asked, 60.0), asked) << "breathes again since";
}

TEST(Breathing, StaysWhereAPhaseHoldsIt) {
  MotionDrive drive = regular();
  drive.is_held = true;
  drive.held_phase = 0.5;
  EXPECT_EQ(state_at(drive, 3.0).drivers[0], 1.0);
  EXPECT_EQ(state_at(drive, 3.0).drivers, state_at(drive, 77.7).drivers);
  EXPECT_EQ(state_at(drive, 3.0).rates_per_s, MotionModel::Scalars{});
}

TEST(Breathing, RefusesImplausibleNumbers) {
  EXPECT_TRUE(check(MotionDrive{}));
  EXPECT_TRUE(check(irregular(1)));
  for (int fault = 0; fault < 13; ++fault) {
    MotionDrive drive;
    if (fault == 0) drive.period_s = 0.0;
    if (fault == 1) drive.depth[1] = std::nan("");
    if (fault == 2) drive.held_phase = 1.5;
    if (fault == 3) drive.pause_share = 0.9;
    if (fault == 4) drive.irregularity = 0.5;
    if (fault == 5) drive.cough_every_s = 1.0;
    if (fault == 6) drive.hold_limit_s = -1.0;
    if (fault == 7) drive.drift_per_s = 1.0;
    if (fault == 8) drive.begins_s = 1e12;
    if (fault == 9) drive.hold_s = std::nan("");
    if (fault == 10) drive.depth[0] = -2.0;
    if (fault == 11) drive.first_depth = 3.0;
    if (fault == 12) drive.drifted = -2.0;
    EXPECT_FALSE(check(drive)) << fault;
  }
}

TEST(MotionClock, RestsWithoutDepthOrModel) {
  EXPECT_TRUE(MotionClock{}.at(5.0).is_rest());
  MotionClock clock;
  clock.drive = regular();
  EXPECT_TRUE(clock.at(2.2).is_rest());
  EXPECT_NEAR(clock.at(2.2).phase(), 0.5, 1e-12) << "a patient without a model breathes all the same";
}

TEST(BreathingChoice, IsWrittenAndRead) {
  for (const char* const text :
       {"none", "quiet", "deep", "14", "7.5,rate=18,irregularity=0.3,cough=40,hold-limit=12,seed=3"}) {
    const auto choice = parse_breathing(text);
    ASSERT_TRUE(choice) << text;
    EXPECT_EQ(parse_breathing(to_text(*choice)), *choice) << text;
  }
  EXPECT_EQ(parse_breathing("7.5,rate=18")->breaths_per_min, 18.0);
  EXPECT_EQ(parse_breathing("quiet")->liver_mm, kQuietLiver_mm);
  for (const char* const text : {"", "loud", "-1", "41", "nan", "10,", "10,rate", "10,rate=", "10,rate=3", "10,pace=4",
                                 "10,seed=-1", "10,irregularity=0.5", "quiet rate=18"})
    EXPECT_FALSE(parse_breathing(text)) << text;
}

TEST(BreathingChoice, DrivesAModelWithinItsRange) {
  MotionParts parts = testing::whole_body({testing::uniform({0.0, 0.0, -20.0})});
  parts.liver_mm = 20.0;
  const auto model = testing::made(std::move(parts));
  const auto drive = drive_of(*parse_breathing("quiet,irregularity=0,seed=9"), *model, 3.0);
  ASSERT_TRUE(drive) << drive.error().text();
  EXPECT_TRUE(check(*drive));
  MotionClock clock{model.get(), *drive};
  double lowest = 0.0;
  for (double t = 3.0; t < 8.0; t += 0.01) lowest = std::min(lowest, clock.at(t).to_now(Vec3::Zero()).z());
  EXPECT_NEAR(lowest, -kQuietLiver_mm, 1e-2);
  EXPECT_LE(drive->drift_per_s, 0.0);
  EXPECT_GE(drive->drift_per_s * 20.0, -kMostDrift_mm_per_s);
  EXPECT_FALSE(drive_of(*parse_breathing("30"), *model)) << "1.5 times 20 mm, less for the irregular ones";
  EXPECT_FALSE(moves(*drive_of(*parse_breathing("none"), *model)));
}

}  // namespace
}  // namespace trocar::motion
