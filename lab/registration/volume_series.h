#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "lab/registration/acquired_volume.h"

namespace trocar::registration {

struct SeriesOptions {
  int volumes = 6;
  std::int64_t edge_voxels = 96;  ///< Cubes at 1 mm.
  double step_mm = 48.0;          ///< From the middle of a volume to that of the next, along x of the scene.
  double turn_deg = 15.0;         ///< From a volume to the next, about a random axis.
  double density = 1.0;           ///< Vessels and ellipsoids, relative to 16 and 24 in 160 x 100 x 100 mm.
  /// Each volume with a gain of -6..6 dB, a TGC of -8..8 dB over 100 mm and a gray map gray^0.75 to gray^1.3.
  bool has_varied_controls = false;
  bool has_shadows = true;
  double scale = 1.0;  ///< Of every second volume, see AcquisitionOptions.
  double shear = 0.0;
};

struct GeneratedVolume {
  volume::LabelGrid gray;
  Pose X_WU;  ///< To the scene.
};

/// Overlapping volumes of one random scene, with speckle and shadows of their own, beams along +z.
std::vector<GeneratedVolume> make_volume_series(const SeriesOptions& options, std::uint64_t seed);

struct TargetError {
  double mean_mm = 0.0, max_mm = 0.0;
  std::size_t targets = 0;
};

/// Distances between true and estimated places of a lattice of points (about every 6 mm) that both volumes show: voxels
/// of the masks that are not 0.
TargetError target_error(const volume::MaskGrid& shown_a, const volume::MaskGrid& shown_b, const Pose& X_AB_true,
                         const Pose& X_AB);
/// The same for volumes that show every voxel.
TargetError target_error(const volume::GridGeometry& a, const volume::GridGeometry& b, const Pose& X_AB_true,
                         const Pose& X_AB);

}  // namespace trocar::registration
