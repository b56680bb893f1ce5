#include "lab/registration/generated_pair.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "registration/ct_ultrasound/detail/smoothing.h"

namespace trocar::registration::testing {
namespace {

constexpr double kRange_db = 50.0;
constexpr double kNoise_gray = 6.0;  ///< In shadows.

struct Ellipsoid {
  Vec3 centre, inverse_radius;
  Mat3 R;
  double hu = 0.0, echo = 1.0;
  bool is_bone = false;
  bool contains(const Vec3& p) const { return (R * (p - centre)).cwiseProduct(inverse_radius).squaredNorm() < 1.0; }
};

struct Tissue {
  double hu = -90.0, echo = 0.45;  ///< Fat.
  bool is_bone = false;
};

Vec3 random_direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

Ellipsoid random_ellipsoid(Random& random, double half_mm, double smallest_mm, double largest_mm) {
  Ellipsoid e;
  for (int a = 0; a < 3; ++a) {
    e.centre[a] = random.uniform(-0.8 * half_mm, 0.8 * half_mm);
    e.inverse_radius[a] = 1.0 / random.uniform(smallest_mm, largest_mm);
  }
  e.R = Eigen::AngleAxisd(random.uniform(0.0, 3.0), random_direction(random)).toRotationMatrix();
  return e;
}

/// Large organs first; later shapes lie in front.
std::vector<Ellipsoid> make_anatomy(const PairOptions& options) {
  Random random(options.seed);
  const double half_mm = 0.5 * options.spacing_mm * static_cast<double>(options.size);
  std::vector<Ellipsoid> shapes;
  for (int n = 0; n < 14; ++n) {
    shapes.push_back(random_ellipsoid(random, half_mm, 0.2 * half_mm, 0.5 * half_mm));
    shapes.back().hu = random.uniform(20.0, 130.0);
    shapes.back().echo = std::exp(random.uniform(-1.2, 0.8));
  }
  for (int n = 0; n < 26; ++n) {
    shapes.push_back(random_ellipsoid(random, half_mm, 0.05 * half_mm, 0.25 * half_mm));
    shapes.back().hu = random.uniform(140.0, 220.0);
    shapes.back().echo = 0.08;
  }
  for (int n = 0; options.has_bone && n < 2; ++n) {
    Ellipsoid bone;
    bone.centre = Vec3((n == 0 ? -0.45 : 0.5) * half_mm, -0.75 * half_mm, 0.0);
    bone.inverse_radius = Vec3(1.0 / (0.12 * half_mm), 1.0 / (0.08 * half_mm), 1.0 / (0.8 * half_mm));
    bone.R = Eigen::AngleAxisd(0.3, Vec3::UnitX()).toRotationMatrix();
    bone.hu = 700.0;
    bone.echo = 5.0;
    bone.is_bone = true;
    shapes.push_back(bone);
  }
  return shapes;
}

Tissue tissue_at(const std::vector<Ellipsoid>& shapes, const Vec3& p) {
  for (auto shape = shapes.rbegin(); shape != shapes.rend(); ++shape)
    if (shape->contains(p)) return {shape->hu, shape->echo, shape->is_bone};
  return {};
}

volume::GridGeometry cube(const PairOptions& options) {
  volume::GridGeometry geometry;
  geometry.size = {options.size, options.size, options.size};
  geometry.spacing_mm = Vec3::Constant(options.spacing_mm);
  geometry.origin_P = Vec3::Constant(-0.5 * options.spacing_mm * static_cast<double>(options.size - 1));
  return geometry;
}

/// The grid as the transducer would be: moved from the CT by X_UC.
volume::GridGeometry moved_grid(volume::GridGeometry geometry, const Pose& X) {
  geometry.origin_P = X * geometry.origin_P;
  geometry.R_PV = X.R() * geometry.R_PV;
  return geometry;
}

}  // namespace

GeneratedPair make_pair(const PairOptions& options) {
  const std::vector<Ellipsoid> shapes = make_anatomy(options);
  const volume::GridGeometry geometry = cube(options);
  GeneratedPair pair;
  pair.ct = volume::CtGrid(geometry);
  for (std::size_t n = 0; n < pair.ct.voxels.size(); ++n) {
    const double hu = tissue_at(shapes, geometry.centre_mm(geometry.index_of(n))).hu;
    const double noise = 24.0 * (uniform01(options.seed ^ 71, n) + uniform01(options.seed ^ 72, n) - 1.0);
    pair.ct.voxels[n] = static_cast<std::int16_t>(std::lround(hu + noise));
  }

  Random random(options.seed ^ 0x5eed);
  const Vec3 axis = random_direction(random);
  const Vec3 direction = random_direction(random);
  const Pose X_UC(Eigen::AngleAxisd(options.offset_rad, axis).toRotationMatrix(), options.offset_mm * direction);
  pair.X_CU = X_UC.inverse();

  // Echo strengths in the ultrasound's voxels, and speckle as the filtered sum of random phasors.
  volume::FloatGrid real(geometry), imaginary(geometry);
  volume::MaskGrid shadow(geometry);
  for (std::int64_t k = 0; k < options.size; ++k)
    for (std::int64_t i = 0; i < options.size; ++i) {
      bool is_shadowed = false;
      for (std::int64_t j = 0; j < options.size; ++j) {
        const std::size_t n = geometry.offset({i, j, k});
        const Vec3 p = geometry.centre_mm({i, j, k});
        const Tissue tissue = tissue_at(shapes, options.warp ? Vec3(p + options.warp(p)) : p);
        shadow.voxels[n] = is_shadowed ? 1 : 0;
        is_shadowed = is_shadowed || tissue.is_bone;
        real.voxels[n] = static_cast<float>(tissue.echo * random.normal());
        imaginary.voxels[n] = static_cast<float>(tissue.echo * random.normal());
      }
    }
  detail::smooth(real, 0.6 * options.spacing_mm);
  detail::smooth(imaginary, 0.6 * options.spacing_mm);
  pair.us = volume::LabelGrid(moved_grid(geometry, X_UC));
  for (std::size_t n = 0; n < pair.us.voxels.size(); ++n) {
    const double amplitude = std::hypot(static_cast<double>(real.voxels[n]), static_cast<double>(imaginary.voxels[n]));
    const double db = 20.0 * std::log10(amplitude + 1e-6);
    const double gray =
        shadow.voxels[n] != 0 ? kNoise_gray * random.uniform() : 255.0 * (db + 0.75 * kRange_db) / kRange_db;
    pair.us.voxels[n] = static_cast<std::uint8_t>(std::clamp(gray, 1.0, 255.0));
  }
  return pair;
}

}  // namespace trocar::registration::testing
