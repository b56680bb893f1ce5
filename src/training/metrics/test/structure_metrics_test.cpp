// Target, structures and risks in the box patient of the tasks' tests.
#include <gtest/gtest.h>

#include "metrics/testing/recording.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::metrics {
namespace {

using namespace testing;

const anatomy::VirtualPatient& patient() {
  static const anatomy::VirtualPatient box = make_box_patient();
  return box;
}
const tasks::Task& task() {
  static const tasks::Task box = make_box_task();
  return box;
}

MetricContext in_box() {
  MetricContext context;
  context.task = &task();
  context.patient = &patient();
  return context;
}

/// Along +y at (x, z) from 5 mm before the skin at 20 mm/s to a depth; depth is not recorded.
Recording puncture_at(double x, double z, double depth_mm, double rate_hz = 500.0) {
  return record((depth_mm + 5.0) / 20.0, rate_hz, [&](double t, Moment& m) {
    m.tip_P = {x, 20.0 * t - 5.0, z};
    m.axis_P = Vec3::UnitY();
  });
}

TEST(StructureMetrics, DerivesDepthFromThePatient) {
  const auto values = measure(puncture_at(50.0, 50.0, 60.0), in_box());
  EXPECT_NEAR(value_of(values, "depth_max"), 60.0, 0.1);
  EXPECT_NEAR(value_of(values, "path_in_tissue"), 60.0, 0.2);
  EXPECT_EQ(value_of(values, "skin_punctures"), 1.0);
}

TEST(StructureMetrics, PassesFatMuscleLiverAndTheLesion) {
  const auto values = measure(puncture_at(50.0, 50.0, 60.0), in_box());
  EXPECT_EQ(value_of(values, "structures_pierced"), 4.0);
  EXPECT_EQ(find(values, "structures_pierced").note, "fat, muscle, liver, livertumor1");
  EXPECT_EQ(value_of(values, "end_in_target"), 1.0);
  EXPECT_EQ(value_of(values, "risk_structures"), 0.0);
  EXPECT_EQ(value_of(values, "no_go_time"), 0.0);
}

TEST(StructureMetrics, MissesTheTargetBesideTheLesion) {
  EXPECT_EQ(measure_one("end_in_target", puncture_at(75.0, 50.0, 60.0), in_box()), 0.0);
  EXPECT_EQ(measure_one("end_in_target", puncture_at(50.0, 50.0, 40.0), in_box()), 0.0);
}

TEST(StructureMetrics, ABiopsyReachesTheTargetWithItsNotch) {
  MetricContext context = in_box();
  context.needle = make_gun();  // the notch's middle is 9.5 mm beyond the tip, the lesion reaches from 50 to 70 mm
  EXPECT_EQ(measure_one("end_in_target", puncture_at(50.0, 50.0, 42.0), context), 1.0);
  EXPECT_EQ(measure_one("end_in_target", puncture_at(50.0, 50.0, 39.0), context), 0.0);
  EXPECT_EQ(measure_one("end_in_target", puncture_at(50.0, 50.0, 62.0), context), 0.0);
}

TEST(StructureMetrics, SlowRecordingsFindThinStructuresBetweenMoments) {
  // Through the vessel of 5 mm at 20 mm a moment, sideways.
  Recording recording = puncture_at(60.0, 50.0, 40.0);
  Moment jump = recording.back();
  jump.time_s += 0.5;
  jump.tip_P.x() = 10.0;
  recording.push_back(jump);
  const auto values = measure(recording, in_box());
  EXPECT_EQ(value_of(values, "risk_structures"), 1.0);
  EXPECT_EQ(find(values, "risk_structures").note, "portal_vein");
}

TEST(StructureMetrics, CountsContactsAndTimeInTheVessel) {
  // The vessel: x from 20 to 25, deeper than 20 mm. The tip, 30 mm deep, stays in it for 2 s, leaves for 1 s, and is in
  // it again for 0.5 s. (The shaft stands upright, so it is in the vessel with the tip.)
  const Recording recording = record(6.5, 1000.0, [](double t, Moment& m) {
    const bool is_in = (t >= 2.0 && t < 4.0) || (t >= 5.0 && t < 5.5);
    m.tip_P = {is_in ? 22.5 : 30.0, t < 1.0 ? 30.0 * t : 30.0, 50.0};
    m.axis_P = Vec3::UnitY();
  });
  const auto values = measure(recording, in_box());
  EXPECT_EQ(value_of(values, "risk_structures"), 1.0);
  EXPECT_EQ(value_of(values, "no_go_touches"), 2.0);
  EXPECT_NEAR(value_of(values, "no_go_time"), 2.5, 0.005);
  EXPECT_NEAR(*find(values, "no_go_touches").at_s, 2.0, 1e-9);
}

TEST(StructureMetrics, CountsComplicationsButNoGrazes) {
  const auto vessel = measure(puncture_at(22.5, 50.0, 40.0), in_box());
  EXPECT_EQ(value_of(vessel, "complications"), 1.0);
  EXPECT_EQ(find(vessel, "complications").note, "the needle went 20 mm into the portal vein");
  EXPECT_EQ(value_of(measure(puncture_at(20.2, 50.0, 24.0), in_box()), "complications"), 0.0);
  EXPECT_EQ(value_of(measure(puncture_at(50.0, 50.0, 40.0), in_box()), "complications"), 0.0);
}

TEST(StructureMetrics, TipPressingOnBoneTouchesIt) {
  Recording recording = puncture_at(50.0, 75.0, 10.2);  // the rib is behind 10 mm
  for (Moment& moment : recording) moment.pressed_mm = std::max(0.0, moment.tip_P.y() - 9.9);
  const auto values = measure(recording, in_box());
  EXPECT_EQ(value_of(values, "risk_structures"), 1.0);
  EXPECT_EQ(value_of(values, "no_go_touches"), 1.0);
  EXPECT_GT(value_of(values, "no_go_time"), 0.0);
}

TEST(StructureMetrics, ShaftTouchesRisks) {
  // Through the rib (z 70 to 80, behind 10 mm) with the tip far beyond it.
  Recording recording = record(1.0, 100.0, [](double, Moment& m) {
    m.tip_P = {50.0, 60.0, 75.0};
    m.axis_P = Vec3::UnitY();
  });
  const auto values = measure(recording, in_box());
  EXPECT_EQ(find(values, "risk_structures").note, "rib_right_9");
  EXPECT_NEAR(value_of(values, "no_go_time"), 1.0, 1e-9);
}

TEST(StructureMetrics, MeasuresDistantTipsOfOtherSystems) {
  const Recording recording = record(1.0, 100.0, [](double t, Moment& m) { m.tip_P = {1e6 * t, -1e6, 0.0}; });
  const auto values = measure(recording, in_box());
  EXPECT_EQ(value_of(values, "structures_pierced"), 0.0);
}

}  // namespace
}  // namespace trocar::metrics
