#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ultrasound/live/scan_picture.h"

namespace trocar::ultrasound {
namespace {

constexpr double kFrame_s = 1.0 / 60.0;

double nominal_ms(const Acquisition& a, double ms_a_million) {
  return 1e-6 * ms_a_million * (0.8e6 + a.lines * a.samples * (1.0 + a.planes + 0.6 * a.steering_angles));
}

/// A machine on which frames take what their work says, with a hand that asks 60 times a second.
struct Machine {
  ScanSchedule schedule;
  ScanRequest request;
  double now_s = 100.0;
  double ms_a_million = 10.0;
  int frames = 0;
  ScanDetail last = ScanDetail::kFast;
  double last_ms = 0.0;

  void run(double seconds, double speed_mm_per_s) {
    for (const double end_s = now_s + seconds; now_s < end_s;) {
      request.X_PT = Pose::translation(request.X_PT.p() + Vec3(speed_mm_per_s * kFrame_s, 0.0, 0.0));
      request.time_s = now_s;
      const double begun_s = now_s;
      const auto detail = schedule.due(request, now_s);
      now_s += kFrame_s;
      if (!detail) continue;
      last = *detail;
      last_ms = nominal_ms(with_detail(request.acquisition, *detail), ms_a_million);
      schedule.note_frame(request, *detail, begun_s, last_ms);
      now_s = std::max(now_s, begun_s + 1e-3 * last_ms);
      ++frames;
    }
  }
};

TEST(ScanDetail, NeverExceedsFullDetail) {
  Acquisition tiny;
  tiny.lines = 12;
  tiny.samples = 48;
  tiny.planes = tiny.steering_angles = 1;
  for (const ScanDetail detail : {ScanDetail::kFast, ScanDetail::kMiddle, ScanDetail::kFull}) {
    Acquisition reduced = with_detail(tiny, detail);
    EXPECT_LE(reduced.scatterers, tiny.scatterers);
    reduced.scatterers = tiny.scatterers;
    EXPECT_EQ(reduced, tiny);
  }
  const Acquisition usual;
  const Acquisition fast = with_detail(usual, ScanDetail::kFast);
  const Acquisition middle = with_detail(usual, ScanDetail::kMiddle);
  EXPECT_EQ(fast.lines, 128);
  EXPECT_EQ(fast.samples, 512);
  EXPECT_EQ(middle.lines, 192);
  EXPECT_EQ(middle.planes, 3);
  EXPECT_EQ(fast.depth_mm, usual.depth_mm);
}

TEST(ScanSchedule, Keeps20FramesPerSecondWhileTheProbeMoves) {
  // From a machine that renders all at once to one on which only the coarsest detail keeps the pace.
  for (const double ms_a_million : {1.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 36.0}) {
    Machine machine;
    machine.ms_a_million = ms_a_million;
    machine.run(1.0, 40.0);  // learns
    machine.frames = 0;
    machine.run(4.0, 40.0);
    EXPECT_GE(machine.frames, 80) << ms_a_million;
    EXPECT_LE(machine.last_ms, 50.0) << ms_a_million;
  }
}

TEST(ScanSchedule, UsesTheFinestDetailThatMeetsTheRate) {
  Machine quick;
  quick.ms_a_million = 10.0;  // full: 28 ms
  quick.run(2.0, 40.0);
  EXPECT_EQ(quick.last, ScanDetail::kFull);
  Machine usual;
  usual.ms_a_million = 17.0;  // full: 48 ms, middle: 28 ms
  usual.run(2.0, 40.0);
  EXPECT_EQ(usual.last, ScanDetail::kMiddle);
  usual.ms_a_million = 30.0;  // others want the machine
  usual.run(2.0, 40.0);
  EXPECT_EQ(usual.last, ScanDetail::kFast);
  usual.ms_a_million = 17.0;
  usual.run(3.0, 40.0);
  EXPECT_EQ(usual.last, ScanDetail::kMiddle);
}

TEST(ScanSchedule, ShowsFullDetailWhenStill) {
  Machine machine;
  machine.ms_a_million = 35.0;
  machine.run(1.0, 40.0);
  EXPECT_EQ(machine.last, ScanDetail::kFast);
  machine.run(0.2, 0.0);
  EXPECT_EQ(machine.last, ScanDetail::kFast);
  machine.run(0.3, 0.0);
  EXPECT_EQ(machine.last, ScanDetail::kFull);
  machine.run(0.3, 40.0);
  EXPECT_EQ(machine.last, ScanDetail::kFast);
}

TEST(ScanSchedule, RefreshesSlowlyWhileNothingChanges) {
  Machine machine;
  machine.ms_a_million = 5.0;  // full: 17 ms
  machine.run(2.0, 0.0);
  machine.frames = 0;
  machine.run(10.0, 0.0);
  EXPECT_GE(machine.frames, 80);
  EXPECT_LE(machine.frames, 101);
  // Where a frame takes long, half of the time is left to others.
  machine.ms_a_million = 144.0;  // full: 411 ms
  machine.run(2.0, 0.0);
  machine.frames = 0;
  machine.run(10.0, 0.0);
  EXPECT_LE(machine.frames, 13);
  EXPECT_GE(machine.frames, 10);
}

TEST(ScanSchedule, TreatsTremorAsStillAndDriftAsMotion) {
  Machine machine;
  machine.ms_a_million = 35.0;
  machine.run(1.0, 40.0);
  const Pose X_PT = machine.request.X_PT;
  for (int n = 0; n < 40; ++n) {
    machine.request.X_PT = Pose::translation(X_PT.p() + Vec3(0.0, 0.02 * (n % 2), 0.0));
    machine.run(kFrame_s, 0.0);
  }
  EXPECT_EQ(machine.last, ScanDetail::kFull);
  machine.run(1.0, 2.0);  // 2 mm/s leave the tolerance every 25 ms
  EXPECT_EQ(machine.last, ScanDetail::kFast);
}

TEST(ScanSchedule, RendersAtOnceWhenNeedleOrSettingsChange) {
  ScanSchedule schedule;
  ScanRequest request;
  request.needle_shaft_P = {{0, 0, 0}, {0, 40, 0}};
  schedule.note_frame(request, ScanDetail::kFull, 10.0, 5.0);
  EXPECT_FALSE(schedule.due(request, 10.01));
  ScanRequest moved = request;
  moved.needle_shaft_P[1].y() += 0.5;
  EXPECT_TRUE(schedule.due(moved, 10.02));
  schedule.note_frame(moved, ScanDetail::kFull, 10.02, 5.0);
  EXPECT_FALSE(schedule.due(moved, 10.03));
  moved.display.gain_db += 1.0;
  EXPECT_TRUE(schedule.due(moved, 10.04));
  schedule.note_frame(moved, ScanDetail::kFull, 10.04, 5.0);
  moved.doppler.scale_cm_per_s = 12.0;
  EXPECT_FALSE(schedule.due(moved, 10.05)) << "colour is off";
  moved.flow = std::make_shared<const VesselFlow>();
  EXPECT_TRUE(schedule.due(moved, 10.06));
  moved = request;
  moved.needle_shaft_P.clear();
  EXPECT_TRUE(schedule.due(moved, 10.07));
}

TEST(ScanRequest, IsClampedToItsRanges) {
  Transducer transducer;
  ScanRequest request;
  request.acquisition.depth_mm = std::numeric_limits<double>::quiet_NaN();
  request.acquisition.frequency_mhz = 80.0;
  request.acquisition.focus_mm = 900.0;
  request.acquisition.lines = -4;
  request.acquisition.samples = 1 << 20;
  request.acquisition.planes = 4;
  request.acquisition.steering_angles = 0;
  request.needle_diameter_mm = 70.0;
  request.columns = 0;
  request.rows = 100000;
  const ScanRequest held = within_ranges(request, transducer);
  EXPECT_EQ(held.acquisition.depth_mm, transducer.depth_mm);
  EXPECT_EQ(held.acquisition.frequency_mhz, transducer.highest_mhz);
  EXPECT_EQ(held.acquisition.focus_mm, held.acquisition.depth_mm);
  EXPECT_EQ(held.acquisition.lines, 16);
  EXPECT_EQ(held.acquisition.samples, 4096);
  EXPECT_EQ(held.acquisition.planes % 2, 1);
  EXPECT_EQ(held.acquisition.steering_angles, 1);
  EXPECT_EQ(held.needle_diameter_mm, 5.0);
  EXPECT_EQ(held.columns, 16);
  EXPECT_EQ(held.rows, 2048);
}

}  // namespace
}  // namespace trocar::ultrasound
