// Angle between the bevel and the fibres that it has to part.
#include <gtest/gtest.h>

#include "metrics/testing/recording.h"
#include "tasks/fit_to_patient.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::metrics {
namespace {

using namespace testing;

/// The box patient, whose liver stands for the structure along which the fibres run: along z.
MetricContext with_bevel() {
  static const anatomy::VirtualPatient patient = make_box_patient(false);
  static const tasks::Task task = [] {
    tasks::Task made = make_box_task();
    made.bevel = tasks::BevelRule{"dura", "liver", 30.0};
    return made;
  }();
  MetricContext context;
  context.task = &task;
  context.patient = &patient;
  context.layer_names = {"skin", "dura"};
  return context;
}

/// A needle along +y whose bevel is turned by an angle from the patient's side (+x) towards the fibres (z).
Moment turned_puncture(double time_s, double turned_deg, std::uint8_t layer) {
  Moment moment;
  moment.time_s = time_s;
  set_depth(moment, 55.0);
  moment.tip_P = {50.0, 55.0, 50.0};
  const double turned_rad = radians(turned_deg);
  moment.R_PN = tasks::needle_rotation(Vec3::UnitY(), {std::cos(turned_rad), 0.0, std::sin(turned_rad)});
  moment.events = telemetry::TickEvents{};
  (*moment.events)[0] = {telemetry::EventKind::kPuncture, layer};
  return moment;
}

TEST(BevelMetrics, TheWorstPunctureOfTheLayerCounts) {
  const Recording recording{turned_puncture(0.0, 80.0, 0), turned_puncture(1.0, 10.0, 1), turned_puncture(2.0, 25.0, 1),
                            turned_puncture(3.0, 5.0, 1)};
  const auto values = measure(recording, with_bevel());
  EXPECT_NEAR(value_of(values, "bevel_to_fibres"), 25.0, 1e-6) << "the 80 degrees were at the skin";
  EXPECT_EQ(find(values, "bevel_to_fibres").at_s, 2.0);
}

TEST(BevelMetrics, TreatsBothBevelSidesAlike) {
  for (const double turned_deg : {0.0, 180.0, 360.0})
    EXPECT_NEAR(measure_one("bevel_to_fibres", {turned_puncture(0.0, turned_deg, 1)}, with_bevel()), 0.0, 1e-6);
  for (const double turned_deg : {90.0, 270.0})
    EXPECT_NEAR(measure_one("bevel_to_fibres", {turned_puncture(0.0, turned_deg, 1)}, with_bevel()), 90.0, 1e-4);
}

TEST(BevelMetrics, GivesTheReasonForAMissingValue) {
  EXPECT_EQ(missing_of("bevel_to_fibres", {turned_puncture(0.0, 0.0, 0)}, with_bevel()),
            "the layer of the fibres was not punctured");
  Moment without_roll = turned_puncture(0.0, 0.0, 1);
  without_roll.R_PN.reset();
  EXPECT_EQ(missing_of("bevel_to_fibres", {without_roll}, with_bevel()),
            "the recording has no rotation of the needle about its axis");
  MetricContext other = with_bevel();
  const tasks::Task plain = make_box_task();
  other.task = &plain;
  EXPECT_EQ(missing_of("bevel_to_fibres", {turned_puncture(0.0, 0.0, 1)}, other), "the task has no rule for the bevel");
  Moment far = turned_puncture(0.0, 0.0, 1);
  far.tip_P = {50.0, 500.0, 50.0};
  EXPECT_EQ(missing_of("bevel_to_fibres", {far}, with_bevel()), "the patient has no fibres there");
}

}  // namespace
}  // namespace trocar::metrics
