// Echoes of points against the configured beam, at several depths: place, height, width along, across and beside.

#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr double kFwhmPerSigma = 2.3548;
constexpr double kPoint_db = 40.0;

/// A Gaussian through sampled values, by least squares of their logarithm: those above 0.3 of the highest one.
struct Profile {
  double fwhm = 0.0, height = 0.0, middle = 0.0;
};
struct Value {
  double x, amplitude;
};
Profile fit_gaussian(const std::vector<Value>& curve) {
  double highest = 0.0;
  for (const Value& v : curve) highest = std::max(highest, v.amplitude);
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (const Value& v : curve) {
    if (v.amplitude < 0.3 * highest) continue;
    const Vec3 terms(1.0, v.x, v.x * v.x);
    normal += terms * terms.transpose();
    right += terms * std::log(v.amplitude);
  }
  const Vec3 p = normal.ldlt().solve(right);
  const double middle = -0.5 * p.y() / p.z();
  return {kFwhmPerSigma * std::sqrt(-0.5 / p.z()), std::exp(p.x() + 0.5 * p.y() * middle), middle};
}

/// Points on the axis, far enough apart, in silence.
std::vector<AcousticPoint> points_at(const std::vector<double>& depths_mm) {
  std::vector<AcousticPoint> points;
  for (const double depth_mm : depths_mm) points.push_back({Vec3(0.0, depth_mm, 0.0), kPoint_db});
  return points;
}

ScenePtr points_in_silence(const Transducer& transducer, const std::vector<double>& depths_mm) {
  SceneBox box = box_for(transducer, transducer.depth_mm, 2.0);
  box.half_thickness_mm = 30.0;
  return points_scene(box, TestTissue::kWater, points_at(depths_mm));
}

/// What points look like.
struct Seen {
  std::vector<Value> axial, lateral, elevation;  ///< mm from the point.
};

/// The transducer takes some places within a scanline's distance, then some in elevation.
std::vector<Seen> look_at(BMode& engine, const std::vector<double>& depths_mm) {
  std::vector<Seen> seen(depths_mm.size());
  const auto look = [&](const BasebandFrame& frame, double x_mm, const auto& take) {
    const double reach_mm = 6.0 * frame.beam.axial_sigma_mm;
    for (std::size_t n = 0; n < depths_mm.size(); ++n) {
      const Polar at = frame.geometry.to_polar(Vec2(-x_mm, depths_mm[n]));
      const EchoPatch patch =
          envelope_patch(frame, {0, frame.geometry.lines, at.depth_mm - reach_mm, at.depth_mm + reach_mm});
      take(seen[n], patch, peak_of(patch), at);
    }
  };
  const ScanGeometry& scan = engine.geometry();
  const double line_mm = scan.line_spacing_mm(depths_mm[depths_mm.size() / 2]);
  for (const double place : {0.0, 0.25, 0.5, 0.75}) {
    const double x_mm = line_mm * place;
    const BasebandFrame& frame = engine.render({Pose::translation(Vec3(x_mm, 0.0, 0.0)), {}, 0.0});
    look(frame, x_mm, [&](Seen& point, const EchoPatch& patch, const Peak& peak, const Polar& at) {
      for (int l = 0; l < patch.lines; ++l)
        point.lateral.push_back({(l - at.line) * scan.line_spacing_mm(at.depth_mm), patch.at(l, peak.sample)});
      if (place > 0.0) return;
      for (int s = 0; s < patch.samples; ++s)
        point.axial.push_back({patch.depth_mm + s * patch.sample_mm - at.depth_mm, patch.at(peak.line, s)});
    });
  }
  const double widest_mm = engine.render({}).beam.elevation_sigma_mm(scan.depth_mm);
  for (const double share : {-1.0, -0.5, -0.25, -0.12, -0.06, 0.0, 0.06, 0.12, 0.25, 0.5, 1.0}) {
    const double z_mm = share * widest_mm;
    look(engine.render({at_elevation(z_mm), {}, 0.0}), 0.0,
         [&](Seen& point, const EchoPatch&, const Peak& peak, const Polar&) {
           point.elevation.push_back({z_mm, peak.amplitude});
         });
  }
  return seen;
}

class PointEcho : public ::testing::TestWithParam<const char*> {};

TEST_P(PointEcho, MatchesTheBeamWidthInEveryDirection) {
  const Transducer transducer = shipped(GetParam());
  std::vector<double> depths_mm;
  for (const double share : {0.125, 0.25, 0.5, 0.75, 0.9}) depths_mm.push_back(share * transducer.depth_mm);
  Acquisition acquisition = plain(transducer);
  BMode engine(points_in_silence(transducer, depths_mm), transducer, acquisition);
  const Beam beam = make_beam(transducer, transducer.frequency_mhz, transducer.focus_mm);
  const std::vector<Seen> seen = look_at(engine, depths_mm);
  for (std::size_t n = 0; n < seen.size(); ++n) {
    const double depth_mm = depths_mm[n];
    const Profile axial = fit_gaussian(seen[n].axial), lateral = fit_gaussian(seen[n].lateral),
                  elevation = fit_gaussian(seen[n].elevation);
    const double axial_mm = kFwhmPerSigma * beam.axial_sigma_mm;
    const double lateral_mm = kFwhmPerSigma * beam.lateral_sigma_mm(depth_mm);
    const double elevation_mm = kFwhmPerSigma * beam.elevation_sigma_mm(depth_mm);
    const double height_db = 20.0 * std::log10(lateral.height);
    EXPECT_NEAR(axial.fwhm, axial_mm, 0.1 * axial_mm) << depth_mm;
    EXPECT_NEAR(lateral.fwhm, lateral_mm, 0.1 * lateral_mm) << depth_mm;
    EXPECT_NEAR(elevation.fwhm, elevation_mm, 0.1 * elevation_mm) << depth_mm;
    EXPECT_NEAR(height_db, kPoint_db, 0.7) << depth_mm;
    // An echo is set on its nearest sample.
    EXPECT_NEAR(axial.middle, 0.0, 0.51 * engine.geometry().sample_mm()) << depth_mm;
    EXPECT_NEAR(lateral.middle, 0.0, 0.1 * engine.geometry().line_spacing_mm(depth_mm)) << depth_mm;
    EXPECT_NEAR(elevation.middle, 0.0, 0.03 * elevation_mm) << depth_mm;
  }
}

INSTANTIATE_TEST_SUITE_P(Transducers, PointEcho, ::testing::Values("C5-2", "L14-5", "P4-2", "liver-sweep"),
                         [](const ::testing::TestParamInfo<const char*>& each) {
                           std::string name = each.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Resolution, FollowsFrequencyAndFocus) {
  const Transducer transducer = convex();
  const std::vector<double> depths_mm{60.0};
  Acquisition near_focus = plain(transducer);
  near_focus.focus_mm = 60.0;
  Acquisition far_focus = near_focus;
  far_focus.focus_mm = 140.0;
  Acquisition high = near_focus;
  high.frequency_mhz = 5.0;
  high.lines = 512;  // a beam narrower than two scanlines is not shown as such
  BMode engine(points_in_silence(transducer, depths_mm), transducer, near_focus);
  const Seen at_focus = look_at(engine, depths_mm).front();
  engine.set_acquisition(far_focus);
  EXPECT_GT(fit_gaussian(look_at(engine, depths_mm).front().lateral).fwhm, 1.15 * fit_gaussian(at_focus.lateral).fwhm);
  engine.set_acquisition(high);
  const Seen at_high = look_at(engine, depths_mm).front();
  // Pulse and diffraction go with the wavelength: 3.5 / 5.
  EXPECT_NEAR(fit_gaussian(at_high.axial).fwhm / fit_gaussian(at_focus.axial).fwhm, 0.7, 0.02);
  EXPECT_NEAR(fit_gaussian(at_high.lateral).fwhm / fit_gaussian(at_focus.lateral).fwhm, 0.7, 0.05);
}

TEST(Resolution, SeparatesPointsFartherApartThanThePulse) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 100.0, 2.0);
  const double axial_mm = kFwhmPerSigma * make_beam(transducer, 3.5, 80.0).axial_sigma_mm;
  const auto dips = [&](double apart_mm) {
    BMode engine(points_scene(box, TestTissue::kWater, points_at({60.0, 60.0 + apart_mm})), transducer,
                 plain(transducer));
    const EchoPatch patch = patch_at(engine.render({}), 0.0, 1.0, 57.0, 60.0 + apart_mm + 3.0);
    const int line = peak_of(patch).line;
    const auto at = [&](double y_mm) {
      return patch.at(line, static_cast<int>(std::lround((y_mm - patch.depth_mm) / patch.sample_mm)));
    };
    return at(60.0 + 0.5 * apart_mm) < 0.7 * std::min(at(60.0), at(60.0 + apart_mm));
  };
  EXPECT_TRUE(dips(2.5 * axial_mm));
  EXPECT_FALSE(dips(0.4 * axial_mm));
}

}  // namespace
}  // namespace trocar::ultrasound
