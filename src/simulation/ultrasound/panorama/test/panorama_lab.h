#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "ultrasound/panorama/panorama_engine.h"
#include "ultrasound/test/physics_lab.h"

/// Common parts of the tests of the panorama engine: panoramas with a closed form in front of shipped transducers.
namespace trocar::testing {

using GrayAt = std::function<int(const Vec3& p_U)>;

/// A box of U from `first` to `last`, mm, with gray values of a formula.
inline volume::LabelGrid paint_gray(const Vec3& first, const Vec3& last, double spacing_mm, const GrayAt& gray_at) {
  volume::GridGeometry geometry;
  geometry.spacing_mm = Vec3::Constant(spacing_mm);
  geometry.origin_P = first;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    geometry.size[a] = static_cast<std::int64_t>(std::lround((last[axis] - first[axis]) / spacing_mm)) + 1;
  }
  volume::LabelGrid gray(geometry);
  for (std::size_t n = 0; n < gray.voxels.size(); ++n)
    gray.voxels[n] = static_cast<std::uint8_t>(gray_at(geometry.centre_mm(geometry.index_of(n))));
  return gray;
}

inline std::shared_ptr<const ultrasound::Panorama> make(const volume::LabelGrid& gray_U, const Pose& X_PU = Pose(),
                                                        ultrasound::GrayMap map = ultrasound::GrayMap::kLinear) {
  ultrasound::PanoramaOptions options;
  options.gray_map = map;
  const auto panorama = ultrasound::make_panorama(gray_U, X_PU, options);
  EXPECT_TRUE(panorama) << (panorama ? "" : panorama.error().text());
  return panorama ? *panorama : nullptr;
}

/// The level that a gray value has in a panorama of 60 dB with a linear gray map.
inline double linear_level_db(double gray) {
  return ultrasound::kWhite_db - 60.0 * (1.0 - gray / 255.0);
}

/// A scan without artefacts: small, of one plane and one angle.
inline ultrasound::Acquisition small_scan(const ultrasound::Transducer& transducer, double depth_mm = 50.0) {
  ultrasound::Acquisition acquisition = plain(transducer);
  acquisition.depth_mm = depth_mm;
  acquisition.focus_mm = 30.0;
  acquisition.lines = 64;
  acquisition.samples = 256;
  acquisition.steering_angles = 1;
  acquisition.planes = 1;
  return acquisition;
}

/// Level after the scanner's TGC of one sample, averaged in power over the angles, dB.
inline double level_at(const ultrasound::BasebandFrame& frame, int line, int sample) {
  double power = 0.0;
  const auto count = static_cast<std::size_t>(frame.geometry.lines) * static_cast<std::size_t>(frame.geometry.samples);
  for (int angle = 0; angle < frame.steering_angles; ++angle) {
    const std::size_t at = static_cast<std::size_t>(angle) * count +
                           static_cast<std::size_t>(line) * static_cast<std::size_t>(frame.geometry.samples) +
                           static_cast<std::size_t>(sample);
    power += std::pow(static_cast<double>(frame.re[at]), 2) + std::pow(static_cast<double>(frame.im[at]), 2);
  }
  const double depth_mm = (sample + 0.5) * frame.geometry.sample_mm();
  return 10.0 * std::log10(power / frame.steering_angles + 1e-30) +
         ultrasound::tgc_gain_db({}, depth_mm, frame.geometry.depth_mm, frame.beam.frequency_mhz);
}

/// Place of a sample in T.
inline Vec3 place_of(const ultrasound::BasebandFrame& frame, int line, int sample) {
  const ultrasound::Vec2 p =
      frame.geometry.to_cartesian({static_cast<double>(line), (sample + 0.5) * frame.geometry.sample_mm()});
  return {p.x(), p.y(), 0.0};
}

/// A box of U that contains the scan of the linear transducer at the identity pose, with a margin.
inline const Vec3 kFirst_mm(-45.0, -20.0, -22.0);
inline const Vec3 kLast_mm(45.0, 80.0, 22.0);

}  // namespace trocar::testing
