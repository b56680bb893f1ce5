#include "lab/registration/volume_series.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "core/result.h"
#include "volume/sampling.h"

namespace trocar::registration {
namespace {

constexpr double kTarget_mm = 6.0;

SceneOptions scene_of(const SeriesOptions& options) {
  const auto edge = static_cast<double>(options.edge_voxels);
  SceneOptions scene;
  scene.last_W = {edge + options.step_mm * (options.volumes - 1) + 10.0, edge + 4.0, edge + 4.0};
  const double size = scene.last_W.prod() / (160.0 * 100.0 * 100.0);
  scene.vessels = static_cast<int>(std::lround(16.0 * options.density * size));
  scene.ellipsoids = static_cast<int>(std::lround(24.0 * options.density * size));
  scene.bones = static_cast<int>(std::lround(3.0 * size));
  return scene;
}

}  // namespace

std::vector<GeneratedVolume> make_volume_series(const SeriesOptions& options, std::uint64_t seed) {
  const TissueScene scene = make_tissue_scene(scene_of(options), seed);
  Random random(mix64(seed));
  std::vector<GeneratedVolume> series;
  Mat3 R_WU = Mat3::Identity();
  const auto edge = static_cast<double>(options.edge_voxels);
  for (int n = 0; n < options.volumes; ++n) {
    AcquisitionOptions acquisition;
    acquisition.geometry.size.fill(options.edge_voxels);
    const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    if (n > 0) R_WU = R_WU * Eigen::AngleAxisd(radians(options.turn_deg), axis);
    const Vec3 middle_W(0.5 * edge + n * options.step_mm + random.uniform(-3.0, 3.0),
                        0.5 * edge + 2.0 + random.uniform(-4.0, 4.0), 0.5 * edge + 2.0 + random.uniform(-4.0, 4.0));
    acquisition.X_WU = Pose(R_WU, middle_W - R_WU * Vec3::Constant(0.5 * (edge - 1.0)));
    acquisition.seed = mix64(seed + 1000003 * static_cast<std::uint64_t>(n + 1));
    acquisition.has_shadows = options.has_shadows;
    if (n % 2 == 1) {
      acquisition.scale = options.scale;
      acquisition.shear = options.shear;
    }
    if (options.has_varied_controls) {
      acquisition.gain_db = random.uniform(-6.0, 6.0);
      acquisition.tgc_db_per_100mm = random.uniform(-8.0, 8.0);
      acquisition.gray_exponent = random.uniform(0.75, 1.3);
    }
    auto gray = acquire_volume(scene, acquisition);
    TROCAR_CHECK(gray.has_value());
    series.push_back({*std::move(gray), acquisition.X_WU});
  }
  return series;
}

TargetError target_error(const volume::MaskGrid& shown_a, const volume::MaskGrid& shown_b, const Pose& X_AB_true,
                         const Pose& X_AB) {
  const volume::GridGeometry& b = shown_b.geometry;
  TargetError error;
  std::array<std::int64_t, 3> step;
  for (std::size_t axis = 0; axis < 3; ++axis)
    step[axis] = std::max<std::int64_t>(1, std::llround(kTarget_mm / b.spacing_mm[static_cast<Eigen::Index>(axis)]));
  for (std::int64_t k = 0; k < b.size[2]; k += step[2]) {
    for (std::int64_t j = 0; j < b.size[1]; j += step[1]) {
      for (std::int64_t i = 0; i < b.size[0]; i += step[0]) {
        if (shown_b[{i, j, k}] == 0) continue;
        const Vec3 p_B = b.centre_mm({i, j, k});
        const Vec3 p_A = X_AB_true * p_B;
        if (volume::sample_nearest(shown_a, p_A, std::uint8_t{0}) == 0) continue;
        const double apart_mm = (X_AB * p_B - p_A).norm();
        error.mean_mm += apart_mm;
        error.max_mm = std::max(error.max_mm, apart_mm);
        ++error.targets;
      }
    }
  }
  if (error.targets > 0) error.mean_mm /= static_cast<double>(error.targets);
  return error;
}

TargetError target_error(const volume::GridGeometry& a, const volume::GridGeometry& b, const Pose& X_AB_true,
                         const Pose& X_AB) {
  return target_error(volume::MaskGrid(a, 1), volume::MaskGrid(b, 1), X_AB_true, X_AB);
}

}  // namespace trocar::registration
