#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "geometry/pose.h"
#include "lab/registration/tissue_scene.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Settings of one generated acquisition.
struct AcquisitionOptions {
  Pose X_WU;                      ///< From the volume's frame U to the scene.
  volume::GridGeometry geometry;  ///< In U.
  std::string beam_axis = "+z";   ///< Parallel beams, along the axes of the grid.
  std::uint64_t seed = 1;         ///< Speckle and noise.
  double gain_db = 0.0;
  double tgc_db_per_100mm = 0.0;  ///< Gain that rises with depth from the middle of the volume on.
  double gray_exponent = 1.0;     ///< Gray map: gray^exponent of 0..1.
  double axial_sigma_mm = 0.45;   ///< Resolution of the speckle along the beam and across it.
  double lateral_sigma_mm = 0.8;
  bool has_shadows = true;
  double scale = 1.0;  ///< Lengths of the scene over lengths of the volume, about the volume's middle.
  double shear = 0.0;  ///< x of the scene grows by this times y, about the volume's middle.
};

/// A volume of a scene as a 3D transducer would acquire it: speckle of its own, log compression over 60 dB, noise, and
/// shadows behind bones along its own beams. Error: the beam axis.
Result<volume::LabelGrid> acquire_volume(const TissueScene& scene, const AcquisitionOptions& options);

}  // namespace trocar::registration
