// Ultrasound and X-ray.
#include <gtest/gtest.h>

#include <numbers>

#include "metrics/testing/recording.h"

namespace trocar::metrics {
namespace {

using namespace testing;
using std::numbers::pi;

/// The plane z = 0 of P: x of T along x of P, y of T along y of P; the array's centre at the origin.
const Pose kInPlane;

MetricContext with_slice(double slice_mm, double width_mm = 100.0) {
  MetricContext context;
  ImagePlane plane;
  plane.depth_mm = 100.0;
  plane.width_mm = width_mm;
  plane.slice_mm = slice_mm;
  context.plane = plane;
  return context;
}

TEST(ImagingMetrics, MeasuresAngleAndOffsetOfATiltedNeedle) {
  // The needle is tilted by 10 degrees out of the plane and its tip is 4 mm beside it.
  const Recording recording = record(2.0, 100.0, [](double t, Moment& m) {
    set_depth(m, 10.0 + 5.0 * t);
    m.axis_P = {0.0, std::cos(10.0 * pi / 180.0), std::sin(10.0 * pi / 180.0)};
    m.tip_P.z() = -4.0;
    m.X_PT = kInPlane;
  });
  const auto values = measure(recording);
  EXPECT_NEAR(value_of(values, "plane_angle"), 10.0, 0.025 + 1e-6);  // half of a bin
  EXPECT_NEAR(value_of(values, "plane_offset"), 4.0, 0.025 + 1e-6);
  EXPECT_NEAR(value_of(values, "plane_angle_end"), 10.0, 1e-9);
  EXPECT_NEAR(value_of(values, "plane_offset_end"), 4.0, 1e-9);
}

TEST(ImagingMetrics, WeightsMediansByTime) {
  // 1.2 s at 2 mm, 0.8 s at 9 mm beside the plane, with many more moments in the second part.
  Recording recording = record(1.2, 50.0, [](double, Moment& m) { set_depth(m, 20.0), m.tip_P.z() = 2.0; });
  Recording second = record(0.8, 1000.0, [](double, Moment& m) { set_depth(m, 20.0), m.tip_P.z() = 9.0; });
  for (Moment& moment : second) moment.time_s += 1.201;
  recording.insert(recording.end(), second.begin(), second.end());
  for (Moment& moment : recording) moment.X_PT = kInPlane;
  EXPECT_NEAR(measure_one("plane_offset", recording), 2.0, 0.03);
}

TEST(ImagingMetrics, MeasuresTheShareOfTheNeedleInTheSlice) {
  // The needle crosses the slice of 2 mm at 5 degrees: the tip is in the middle; 1 mm / sin 5° of the shaft is inside.
  const double angle = 5.0 * pi / 180.0;
  const Recording recording = record(1.0, 200.0, [&](double, Moment& m) {
    m.axis_P = {0.0, std::cos(angle), std::sin(angle)};
    m.tip_P = {0.0, 50.0, 0.0};
    m.depth_mm = 50.0;
    m.X_PT = kInPlane;
  });
  EXPECT_NEAR(measure_one("needle_in_beam", recording, with_slice(2.0)), 100.0 / std::sin(angle) / 50.0, 2.0);
}

TEST(ImagingMetrics, TipIsVisibleInPartOfTheAdvance) {
  // From 0 to 60 mm deep; for the last 15 mm the transducer is 5 mm off; pushes after a pull-back count once.
  const Recording recording = record(4.0, 500.0, [](double t, Moment& m) {
    const double depth_mm = t < 2.0   ? 20.0 * t
                            : t < 3.0 ? 40.0 - 20.0 * std::sin(pi * (t - 2.0))
                                      : 40.0 + 20.0 * (t - 3.0);
    set_depth(m, depth_mm);
    m.X_PT = Pose::translation({0.0, 0.0, depth_mm > 45.0 ? 5.0 : 0.0});
  });
  EXPECT_NEAR(measure_one("tip_visible", recording, with_slice(2.0)), 75.0, 0.1);
  EXPECT_NEAR(measure_one("tip_visible", recording, with_slice(2.0, 0.0)), 75.0, 0.1);  // on the middle line
}

TEST(ImagingMetrics, LimitsAFanByItsAngle) {
  ImagePlane plane;
  plane.radius_mm = 60.0;
  plane.field_of_view_rad = 1.0;
  plane.depth_mm = 100.0;
  const auto at = [](double angle, double depth_mm) {
    return Vec3((60.0 + depth_mm) * std::sin(angle), (60.0 + depth_mm) * std::cos(angle) - 60.0, 0.0);
  };
  EXPECT_TRUE(plane.is_in_field(at(0.49, 50.0)));
  EXPECT_FALSE(plane.is_in_field(at(0.51, 50.0)));
  EXPECT_TRUE(plane.is_in_field(at(-0.3, 99.0)));
  EXPECT_FALSE(plane.is_in_field(at(-0.3, 101.0)));
  EXPECT_FALSE(plane.is_in_field(at(0.0, -1.0)));
}

TEST(ImagingMetrics, SliceNarrowsToTheFocus) {
  ImagePlane plane;
  plane.slice_mm = 2.0;
  plane.elevation_mm = 14.0;
  plane.elevation_focus_mm = 60.0;
  EXPECT_NEAR(plane.slice_at_mm(60.0), 2.0, 1e-12);
  EXPECT_NEAR(plane.slice_at_mm(0.0), std::sqrt(200.0), 1e-12);
  EXPECT_NEAR(plane.slice_at_mm(30.0), std::hypot(2.0, 7.0), 1e-12);
  plane.elevation_focus_mm = 0.0;
  EXPECT_EQ(plane.slice_at_mm(10.0), 2.0);
}

TEST(ImagingMetrics, CountsContactsAndTimeOfTheTransducer) {
  // On the skin from 1 to 3 s and from 5 to 6 s, with a gap of 0.1 s at 2 s; moved by 30 mm in between.
  const Recording recording = record(7.0, 1000.0, [](double t, Moment& m) {
    const bool is_on = (t >= 1.0 && t < 2.0) || (t >= 2.1 && t < 3.0) || (t >= 5.0 && t < 6.0);
    m.X_PT = Pose::translation({t < 4.0 ? 0.0 : 30.0 * std::min(1.0, t - 4.0), 0.0, 0.0});
    m.contact_n = is_on ? 3.0 : 0.0;
  });
  const auto values = measure(recording);
  EXPECT_NEAR(value_of(values, "probe_time"), 2.9, 0.005);
  EXPECT_EQ(value_of(values, "skin_contacts"), 2.0);
  EXPECT_NEAR(value_of(values, "transducer_path"), 30.0, 0.1);
  EXPECT_NEAR(value_of(values, "transducer_path_raw"), 30.0, 1e-9);
}

TEST(ImagingMetrics, ReadsRadiationFromTheLastCounter) {
  const Recording recording = record(2.0, 100.0, [](double t, Moment& m) {
    tasks::XrayUse use;
    use.beam_s = 0.5 * t;
    use.dose_area_gycm2 = 0.3 * t;
    use.air_kerma_mgy = 2.0 * t;
    use.contrast_ml = 4.0 * t;
    m.xray = use;
  });
  const auto values = measure(recording);
  EXPECT_NEAR(value_of(values, "beam_time"), 1.0, 1e-12);
  EXPECT_NEAR(value_of(values, "dose_area"), 0.6, 1e-12);
  EXPECT_NEAR(value_of(values, "air_kerma"), 4.0, 1e-12);
  EXPECT_NEAR(value_of(values, "contrast_volume"), 8.0, 1e-12);
}

TEST(ImagingMetrics, NamesMissingInput) {
  Recording recording = record(1.0, 100.0, [](double t, Moment& m) { set_depth(m, 10.0 * t); });
  EXPECT_EQ(missing_of("plane_angle", recording), "the recording has no transducer");
  EXPECT_EQ(missing_of("beam_time", recording), "no X-ray was used");
  for (Moment& m : recording) m.X_PT = kInPlane;
  EXPECT_EQ(missing_of("tip_visible", recording), "the geometry of the image plane is not known");
  EXPECT_EQ(missing_of("probe_time", recording),
            "the recording has no contact force of the transducer and no patient was given");
}

}  // namespace
}  // namespace trocar::metrics
