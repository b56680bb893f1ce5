#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"

namespace trocar {

struct SurfaceOptions {
  int smoothing_iterations = 20;      ///< Windowed sinc, which does not shrink. Range 0..200.
  double smoothing_pass_band = 0.05;  ///< Smaller is smoother. Range 0.001..2.
  double decimate_to_fraction = 0.5;  ///< Triangles kept, 0..1.
  std::size_t min_voxels = 20;        ///< Structures below are left out.
};

/// Smoothed, decimated surface of every label and of the skin ("skin"), in P.
std::vector<NamedMesh> extract_surfaces(const VirtualPatient& patient, const SurfaceOptions& options = {},
                                        const Progress& progress = {});
/// Surface of one mask.
TriangleMesh extract_surface(const MaskGrid& mask, const SurfaceOptions& options = {});

}  // namespace trocar
