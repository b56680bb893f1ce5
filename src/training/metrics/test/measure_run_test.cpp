// Every metric with recordings that have nothing to measure, and with values that are none.
#include "metrics/measure_run.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

#include "core/random.h"
#include "metrics/testing/recording.h"
#include "tasks/fit_to_patient.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::metrics {
namespace {

using namespace testing;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

MetricContext full_context() {
  static const anatomy::VirtualPatient patient = make_box_patient();
  static const tasks::Task task = [] {
    tasks::Task made = make_box_task();
    made.bevel = tasks::BevelRule{"skin", "liver", 30.0};
    return made;
  }();
  MetricContext context = with_paths({{"expert", make_box_plan().line_P}});
  context.task = &task;
  context.patient = &patient;
  context.plane = ImagePlane{100.0, 60.0, 1.0};
  context.layer_names = {"skin"};
  return context;
}

/// A moment with every part.
Moment full_moment(double time_s) {
  Moment m;
  m.time_s = time_s;
  m.tip_P = {50.0, 20.0 * time_s, 50.0};
  m.axis_P = Vec3::UnitY();
  m.R_PN = tasks::needle_rotation(m.axis_P, Vec3::UnitX());
  m.events = telemetry::TickEvents{};
  m.resistance_n = 1.0;
  m.X_PT = Pose::translation({50.0, 0.0, 50.0});
  m.contact_n = 1.0;
  m.xray = tasks::XrayUse{};
  return m;
}

/// Every value is finite or has a reason, and only one of both.
void expect_sound(const std::vector<MetricValue>& values) {
  EXPECT_EQ(values.size(), metric_catalogue().size());
  for (const MetricValue& value : values) {
    if (value.value) {
      EXPECT_TRUE(std::isfinite(*value.value)) << value.name;
    }
    EXPECT_NE(value.value.has_value(), !value.missing.empty()) << value.name;
    EXPECT_FALSE(value.unit.empty()) << value.name;
  }
}

TEST(MeasureRun, WithoutMomentsHasNoValues) {
  for (const auto& values : {measure({}, full_context()), measure({})}) {
    expect_sound(values);
    for (const MetricValue& value : values) EXPECT_EQ(value.missing, "the recording has no valid moment") << value.name;
  }
}

TEST(MeasureRun, HandlesOneMoment) {
  const auto values = measure({full_moment(2.0)}, full_context());
  expect_sound(values);
  EXPECT_EQ(value_of(values, "path_length"), 0.0);
  EXPECT_EQ(value_of(values, "elapsed_time"), 0.0);
  EXPECT_NEAR(value_of(values, "target_distance"), 11.0, 1e-9);
  EXPECT_FALSE(find(values, "plane_angle").value);
  EXPECT_FALSE(find(values, "spectral_arc_length").value);
}

TEST(MeasureRun, FullRecordingHasAValueForEveryMetric) {
  Recording recording;
  for (int n = 0; n < 300; ++n) recording.push_back(full_moment(0.01 * n));
  (*recording[150].events)[0] = {telemetry::EventKind::kPuncture, 0};
  recording.back().tip_P.x() += 0.5;  // no motion is so even that it has no jerk
  const auto values = measure(recording, full_context());
  expect_sound(values);
  for (const MetricValue& value : values) EXPECT_TRUE(value.value) << value.name << ": " << value.missing;
}

TEST(MeasureRun, SkipsInvalidMoments) {
  Recording clean, spoilt;
  for (int n = 0; n < 200; ++n) {
    clean.push_back(full_moment(0.01 * n));
    spoilt.push_back(clean.back());
    for (int fault = 0; fault < 5; ++fault) {
      Moment bad = clean.back();
      if (fault == 0) bad.time_s = kNan;
      if (fault == 1) bad.tip_P.y() = kInf;
      if (fault == 2) bad.axis_P = Vec3::Zero();
      if (fault == 3) bad.axis_P.x() = kNan;
      if (fault == 4) bad.time_s -= 0.005;  // backwards
      spoilt.push_back(bad);
    }
  }
  const auto wanted = measure(clean, full_context()), values = measure(spoilt, full_context());
  MeasureRun run(full_context());
  for (const Moment& moment : spoilt) run.step(moment);
  EXPECT_EQ(run.moments(), 200u);
  EXPECT_EQ(run.left_out(), 1000u);
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    EXPECT_EQ(values[n].value, wanted[n].value) << wanted[n].name;
    EXPECT_EQ(values[n].missing, wanted[n].missing) << wanted[n].name;
  }
}

TEST(MeasureRun, InvalidOptionalPartsAreAbsent) {
  Recording recording;
  for (int n = 0; n < 100; ++n) {
    Moment m = full_moment(0.01 * n);
    m.resistance_n = kNan;
    m.contact_n = kInf;
    m.X_PT = Pose::translation({kNan, 0.0, 0.0});
    m.xray->dose_area_gycm2 = kInf;
    recording.push_back(m);
  }
  const auto values = measure(recording, full_context());
  expect_sound(values);
  for (const char* name : {"force_peak", "probe_time", "plane_angle", "dose_area"})
    EXPECT_FALSE(find(values, name).value) << name;
}

TEST(MeasureRun, TreatsConstantTimeAsOneMoment) {
  const auto values = measure(Recording(500, full_moment(1.0)), full_context());
  expect_sound(values);
  EXPECT_EQ(value_of(values, "elapsed_time"), 0.0);
}

TEST(MeasureRun, StaysFiniteForHugeAndTinyNumbers) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    Recording recording;
    double time_s = 0.0;
    for (int n = 0; n < 40; ++n) {
      const auto any = [&] { return random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-300.0, 300.0)); };
      time_s += std::abs(any());
      Moment m = full_moment(time_s);
      m.tip_P = {any(), any(), any()};
      m.axis_P = {any(), any(), any()};
      if (n % 3 == 0) m.depth_mm = any();
      m.resistance_n = any();
      m.contact_n = any();
      m.X_PT = Pose::translation({any(), any(), any()});
      m.is_paused = n % 11 == 0;
      recording.push_back(m);
    }
    expect_sound(measure(recording, full_context()));
    expect_sound(measure(recording));
  }
}

TEST(MeasureRun, HandlesAnExpertPathWithoutLength) {
  MetricContext context = full_context();
  context.expert_paths = {{"point", {Vec3(50, 10, 50), Vec3(50, 10, 50)}}};
  Recording recording;
  for (int n = 0; n < 100; ++n) recording.push_back(full_moment(0.01 * n));
  const auto values = measure(recording, context);
  expect_sound(values);
  EXPECT_EQ(find(values, "path_angle").missing, "the expert path has no length");
}

TEST(MeasureRun, ReportsDuringARecording) {
  MeasureRun run(full_context());
  double last_mm = 0.0;
  for (int n = 0; n < 100; ++n) {
    run.step(full_moment(0.01 * n));
    const auto values = run.report();
    expect_sound(values);
    const double length_mm = value_of(values, "path_length");
    EXPECT_GE(length_mm, last_mm);
    last_mm = length_mm;
  }
}

TEST(Catalogue, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const MetricDescription& description : metric_catalogue()) {
    EXPECT_TRUE(names.insert(description.name).second) << description.name;
    for (const char* text : {description.title, description.unit, description.source})
      EXPECT_FALSE(std::string(text).empty()) << description.name;
  }
  EXPECT_GE(names.size(), 40u);
}

}  // namespace
}  // namespace trocar::metrics
