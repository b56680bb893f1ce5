#pragma once

#include <vector>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::registration {

struct ScaleSpaceOptions {
  double spacing_mm = 0.0;   ///< Of the first octave's isotropic grid; 0: the cube root of a voxel's volume.
  double first_sigma = 1.6;  ///< Of the first level, voxels of the octave (Lowe 2004). Range 0.8..4.
  int scales = 3;            ///< Per octave. Range 1..8.
  int octaves = 4;           ///< Fewer if the volume is small. Range 1..8.
};

/// One octave: scales + 3 levels; level n has sigma = first_sigma * 2^(n / scales) voxels.
struct Octave {
  volume::GridGeometry geometry;  ///< Isotropic.
  /// Means of the usable gray levels near a voxel, Gaussian weights; NaN at unusable voxels, and where less than 0.4 of
  /// the weight is usable. Unit: local standard deviations of gray.
  std::vector<volume::FloatGrid> levels;
};

/// Gaussian scale space of the usable voxels (docs/physics.md R2).
struct ScaleSpace {
  ScaleSpaceOptions options;
  std::vector<Octave> octaves;

  /// Blur of a level in mm; `level` may be fractional.
  double sigma_mm(std::size_t octave, double level) const noexcept;
};

/// Of flattened gray levels (intensity/gray_levels.h); `usable` lies on the same grid (checked). The blur is isotropic
/// in mm for any voxel size. Errors (exit status 2): options out of range.
Result<ScaleSpace> build_scale_space(const volume::FloatGrid& flat, const volume::MaskGrid& usable,
                                     const ScaleSpaceOptions& options = {});

}  // namespace trocar::registration
