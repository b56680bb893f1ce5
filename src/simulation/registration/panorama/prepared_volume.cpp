#include "registration/panorama/prepared_volume.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/fail_at.h"
#include "registration/intensity/flatten.h"
#include "registration/intensity/smooth_volume.h"
#include "volume/morphology.h"

namespace trocar::registration {
namespace {

struct Detail {
  double sigma_voxels;
  int stride;
};
/// Wide maxima first, then accuracy.
constexpr std::array<Detail, 4> kDetails = {{{6.0, 9}, {4.0, 6}, {2.0, 3}, {1.0, 1}}};
constexpr std::size_t kLeastUsable = 1000;  ///< Voxels.

std::size_t count_usable(const volume::MaskGrid& usable) {
  std::size_t count = 0;
  for (const std::uint8_t v : usable.voxels) count += v;
  return count;
}

Result<double> threshold_of(const PreparedVolume& volume, const PreparationOptions& options) {
  if (options.shadow_threshold) return *options.shadow_threshold;
  const volume::MaskGrid inside = imaged_voxels(volume.gray, volume.beams);
  return estimate_shadow_threshold(std::span(&volume.gray, 1), std::span(&inside, 1));
}

/// Voxels for the comparison of gray levels: away from shadows, and not in the near part of a fan.
volume::MaskGrid comparable_voxels(const PreparedVolume& volume, const PreparationOptions& options, double voxel_mm) {
  volume::MaskGrid usable = volume.region.usable;
  if (volume.beams.is_fan()) {
    for (std::size_t n = 0; n < usable.voxels.size(); ++n) {
      if (usable.voxels[n] == 0) continue;
      const Vec3 p = usable.geometry.centre_mm(usable.geometry.index_of(n));
      if (volume.beams.to_place(p).depth_mm < options.near_part_mm) usable.voxels[n] = 0;
    }
  }
  return volume::erode(usable, options.widening_voxels * voxel_mm);
}

/// Smoothed gray levels for comparisons.
void add_details(PreparedVolume& volume, const volume::FloatGrid& flat, const PreparationOptions& options) {
  const double spacing_mm = options.scale_space.spacing_mm;
  const double voxel_mm = spacing_mm > 0.0 ? spacing_mm : std::cbrt(volume.gray.geometry.voxel_volume_mm3());
  const volume::MaskGrid narrowed = comparable_voxels(volume, options, voxel_mm);
  for (const Detail& detail : kDetails) {
    DetailLevel level;
    level.sigma_mm = detail.sigma_voxels * voxel_mm;
    level.values = smooth_usable(flat, narrowed, level.sigma_mm);
    level.points = alignment_points(level.values, detail.stride);
    volume.details.push_back(std::move(level));
  }
}

Status prepare_steps(PreparedVolume& volume, const PreparationOptions& options, const Progress& progress) {
  if (!(options.widening_voxels >= 0.0 && options.widening_voxels <= 20.0))
    return fail_usage("the widening of shadows is out of range", fmt::format("{:g}", options.widening_voxels),
                      "give 0 to 20 voxels");
  if (!(options.near_part_mm >= 0.0 && options.near_part_mm <= 200.0))
    return fail_usage("the near part is out of range", fmt::format("{:g}", options.near_part_mm), "give 0 to 200 mm");
  report(progress, "finding shadows", 0.0);
  TROCAR_TRY(volume.shadow_threshold, threshold_of(volume, options));
  TROCAR_TRY(volume.region, find_shadows(volume.gray, volume.beams, volume.shadow_threshold));
  if (count_usable(volume.region.usable) < kLeastUsable)
    return fail("nearly all voxels are in shadow or outside of the fan", {},
                "check the beam axis and the shadow threshold");
  report(progress, "finding keypoints", 0.1);
  TROCAR_TRY(const volume::FloatGrid flat, flatten(volume.gray, volume.region.usable));
  TROCAR_TRY(const ScaleSpace space, build_scale_space(flat, volume.region.usable, options.scale_space));
  TROCAR_TRY(volume.keypoints.keypoints, find_keypoints(space, options.keypoints));
  report(progress, "describing keypoints", 0.3);
  TROCAR_TRY(volume.keypoints.features, describe(space, volume.keypoints.keypoints, options.descriptors));
  volume.keypoints.gray = gray_histograms(volume.gray, volume.region.usable, volume.keypoints.keypoints);
  report(progress, "smoothing", 0.8);
  add_details(volume, flat, options);
  return {};
}

}  // namespace

double PreparedVolume::extent_mm() const noexcept {
  return std::cbrt(static_cast<double>(count_usable(region.usable)) * gray.geometry.voxel_volume_mm3());
}

Result<PreparedVolume> prepare(std::string name, volume::LabelGrid gray, const Beams& beams,
                               const PreparationOptions& options, const Progress& progress) {
  PreparedVolume volume;
  volume.name = std::move(name);
  volume.gray = std::move(gray);
  volume.beams = beams;
  if (Status done = prepare_steps(volume, options, progress); !done)
    return fail_at(volume.name, std::move(done).error());
  report(progress, "done", 1.0);
  return volume;
}

}  // namespace trocar::registration
