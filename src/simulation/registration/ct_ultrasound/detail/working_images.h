#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "registration/shadow/beams.h"
#include "volume/grid.h"

namespace trocar::registration::detail {

/// The ultrasound at the working resolution, with the samples that may be compared.
struct WorkingUltrasound {
  volume::FloatGrid gray;        ///< Mean gray levels of blocks of voxels.
  volume::MaskGrid inside;       ///< Imaged, shadows included.
  volume::MaskGrid lit;          ///< Imaged and not shadowed.
  volume::MaskGrid usable;       ///< Away from shadows and edges of the image.
  std::size_t usable_count = 0;  ///< Voxels.
  double shadow_share = 0.0;     ///< Of the inside, 0..1.
  Vec3 centre = Vec3::Zero();    ///< Mean of the usable voxels.
  double radius_mm = 0.0;        ///< Root mean square distance of the usable voxels from the centre.
};

/// Errors: one gray level only, too few usable voxels (all shadow).
Result<WorkingUltrasound> prepare_ultrasound(const volume::LabelGrid& gray, const Beams& beams);

/// The CT around `centre_C` (mm) at the working resolution, limited to soft tissue (HU; docs/physics.md R11).
volume::FloatGrid prepare_ct(const volume::CtGrid& ct, const Vec3& centre_C, double radius_mm);

/// One resolution: local contrast of both images.
struct Level {
  volume::FloatGrid us;
  volume::FloatGrid ct;  ///< In the frame of the ultrasound.
};

/// Standard deviations of the smoothing at the finest level (docs/physics.md R12, R14; assumed).
inline constexpr double kUsFine_mm = 1.2, kCtFine_mm = 0.5;

/// Local contrast of both volumes, smoothed by the standard deviations (mm), on grids of every `factor`-th voxel.
Level make_level(const WorkingUltrasound& us, const volume::FloatGrid& ct_U, double us_sigma_mm, double ct_sigma_mm,
                 std::int64_t factor);

/// About `count` seeded points, each anywhere within a usable voxel of its own, spread evenly over these in the order
/// of memory.
std::vector<Vec3> sample_usable(const WorkingUltrasound& us, std::size_t count, std::uint64_t seed);

}  // namespace trocar::registration::detail
