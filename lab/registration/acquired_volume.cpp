#include "lab/registration/acquired_volume.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "geometry/shapes.h"
#include "registration/shadow/beams.h"
#include "volume/resample.h"

namespace trocar::registration {
namespace {

constexpr double kDynamicRange_db = 60.0;
constexpr double kTissue_db = -22.0;  ///< Plain tissue, below white.
constexpr double kNoise_db = -62.0;
constexpr double kShadow_db = -45.0;
constexpr double kSurface_mm = 1.5;  ///< Of a bone, that returns sound.

/// Complex Gaussian noise of unit power with the resolution of the scanner.
struct Speckle {
  volume::FloatGrid real, imaginary;
  std::complex<double> at(std::size_t n) const {
    return std::numbers::sqrt2 / 2.0 * std::complex<double>(real.voxels[n], imaginary.voxels[n]);
  }
};

std::uint8_t to_gray(double level_db, double exponent) {
  const double share = std::clamp(1.0 + level_db / kDynamicRange_db, 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(255.0 * std::pow(share, exponent)));
}

volume::FloatGrid correlated_noise(const volume::GridGeometry& geometry, std::uint64_t seed, const Vec3& sigma_voxels) {
  volume::FloatGrid noise(geometry);
  parallel_for(noise.voxels.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      // Sum of four uniform numbers: near enough to a normal one before the blur.
      double sum = -2.0;
      for (std::uint64_t part = 0; part < 4; ++part) sum += uniform01(seed, 4 * n + part);
      noise.voxels[n] = static_cast<float>(sum * std::sqrt(3.0));
    }
  });
  volume::gaussian_blur(noise, sigma_voxels);
  double power = 0.0;
  for (const float v : noise.voxels) power += static_cast<double>(v) * static_cast<double>(v);
  const auto scale = static_cast<float>(1.0 / std::sqrt(power / static_cast<double>(noise.voxels.size())));
  for (float& v : noise.voxels) v *= scale;
  return noise;
}

Speckle make_speckle(const AcquisitionOptions& options, const Beams& beams, std::uint64_t seed) {
  const Vec3 beam_V = options.geometry.R_PV.transpose() * beams.direction(options.geometry.origin_P);
  Vec3 sigma_voxels;
  for (int a = 0; a < 3; ++a) {
    const double sigma_mm = std::abs(beam_V[a]) > 0.5 ? options.axial_sigma_mm : options.lateral_sigma_mm;
    sigma_voxels[a] = sigma_mm / options.geometry.spacing_mm[a];
  }
  return {correlated_noise(options.geometry, mix64(2 * seed), sigma_voxels),
          correlated_noise(options.geometry, mix64(2 * seed + 1), sigma_voxels)};
}

/// Least distance of two segments: alternating projections on the lines, then on the ends.
double distance_between_mm(const Segment& a, const Segment& b) {
  const Vec3 u = a.b - a.a, v = b.b - b.a, w = a.a - b.a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  const double s = determinant > 1e-9 * uu * vv ? std::clamp((uv * vw - vv * uw) / determinant, 0.0, 1.0) : 0.0;
  const double t = std::clamp((uv * s + vw) / vv, 0.0, 1.0);
  return std::min({distance_mm(a, b.at(t)), distance_mm(b, a.at(s)), distance_mm(b, a.a), distance_mm(b, a.b),
                   distance_mm(a, b.a), distance_mm(a, b.b)});
}

/// True where sound to p_W meets a bone more than its surface before.
bool is_shadowed(const TissueScene& scene, const Vec3& p_W, const Vec3& beam_W) {
  constexpr double kFarAway_mm = 400.0;
  const Segment way{p_W - kFarAway_mm * beam_W, p_W - kSurface_mm * beam_W};
  return std::any_of(scene.bones.begin(), scene.bones.end(),
                     [&](const Rod& rod) { return distance_between_mm(way, rod.axis_W) < rod.radius_mm; });
}

}  // namespace

Result<volume::LabelGrid> acquire_volume(const TissueScene& scene, const AcquisitionOptions& options) {
  TROCAR_TRY(const Beams beams, Beams::along_axis(options.beam_axis, options.geometry));
  const auto& geometry = options.geometry;
  const Vec3 last(static_cast<double>(geometry.size[0] - 1), static_cast<double>(geometry.size[1] - 1),
                  static_cast<double>(geometry.size[2] - 1));
  const Vec3 middle_U = geometry.to_mm(0.5 * last);
  const Vec3 beam_W = options.X_WU.R() * beams.direction(geometry.origin_P);
  Mat3 stretch = options.scale * Mat3::Identity();
  stretch(0, 1) += options.shear;
  const Speckle speckle = make_speckle(options, beams, options.seed);
  const Speckle noise = make_speckle(options, beams, mix64(options.seed));
  const double noise_amplitude = std::pow(10.0, kNoise_db / 20.0);
  volume::LabelGrid gray(geometry);
  parallel_for(gray.voxels.size(), 4096, [&](std::size_t first, std::size_t last_n) {
    for (std::size_t n = first; n < last_n; ++n) {
      const Vec3 p_U = geometry.centre_mm(geometry.index_of(n));
      const Vec3 p_W = options.X_WU * Vec3(middle_U + stretch * (p_U - middle_U));
      double level_db = kTissue_db + scene.level_db(p_W);
      if (options.has_shadows && is_shadowed(scene, p_W, beam_W)) level_db += kShadow_db;
      const std::complex<double> echo = std::pow(10.0, level_db / 20.0) * speckle.at(n) + noise_amplitude * noise.at(n);
      const double deeper_mm = beams.to_place(p_U).depth_mm - 0.5 * beams.depth_mm();
      const double gain_db = options.gain_db + options.tgc_db_per_100mm * deeper_mm / 100.0;
      gray.voxels[n] = to_gray(10.0 * std::log10(std::norm(echo) + 1e-20) + gain_db, options.gray_exponent);
    }
  });
  return gray;
}

}  // namespace trocar::registration
