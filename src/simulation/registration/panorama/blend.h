#pragma once

#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "registration/panorama/pair_registration.h"

namespace trocar::registration {

struct BlendOptions {
  double spacing_mm = 0.0;  ///< Of the panorama; 0: that of the first volume.
  double margin_mm = 8.0;   ///< A volume's weight rises over this distance from shadows and from the fan's edge.
  double sharpness = 6.0;   ///< Exponent of the weights: high values mix speckle in narrow seams only. Range 1..20.
};

struct PlacedVolume {
  const PreparedVolume* volume = nullptr;
  Pose X_0N;  ///< From the volume's frame to that of the panorama.
};

struct Panorama {
  volume::LabelGrid gray;        ///< 1..255; 0: in no volume, or in shadow in all.
  volume::LabelGrid source;      ///< Number of the volume with the largest weight, from 1; 0: none.
  double seam_difference = 0.0;  ///< Mean absolute difference of the smoothed gray levels of the two volumes at seams.
};

/// One volume of all, in the frame and along the axes of the first (docs/physics.md R19). A voxel's weights: distance
/// to shadow and to the edge of the fan, and the angle between the beam and the nearest fan's middle; gray levels are
/// matched to the first volume by their ranks in the overlaps. Errors (exit status 2): options out of range, a panorama
/// above 512 million voxels.
Result<Panorama> blend(const std::vector<PlacedVolume>& volumes, const BlendOptions& options = {},
                       const Progress& progress = {});

}  // namespace trocar::registration
