#pragma once

#include <functional>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"

namespace trocar::surface {

struct SurfaceOptions {
  int smoothing_iterations = 20;      ///< Windowed sinc, which does not shrink. Range 0..200.
  double smoothing_pass_band = 0.05;  ///< Smaller is smoother. Range 0.001..2.
  double decimate_to_fraction = 0.5;  ///< Triangles kept (quadric decimation), 0..1.
  /// Approximate limit of one mesh; larger ones are decimated further. Range 1000 and up.
  std::size_t max_triangles = 60000;
  std::size_t min_voxels = 20;  ///< Smaller structures are left out.
};

/// Smoothed, decimated, closed surface of every structure and of the skin ("skin"), in P. The tissue between structures
/// (fat, the muscle found from HU, gas, soft tissue) and derived membranes (peritoneum, pleura) have no surface. An
/// organ's surface encloses its lesions (lesions_as_organs), which also have their own surfaces. Structures are
/// processed in parallel.
std::vector<anatomy::NamedMesh> extract_surfaces(const anatomy::VirtualPatient& patient,
                                                 const SurfaceOptions& options = {}, const Progress& progress = {});
/// Receives a surface (without triangles if the structure has none), the number of surfaces received so far and the
/// number of all. Returns false to stop.
using SurfaceReceiver = std::function<bool(anatomy::NamedMesh mesh, std::size_t done, std::size_t count)>;
/// The same surfaces one after the other, the skin first, then from small structures to large ones: for a view that
/// shows them as they arrive. `receive` is called on several threads, but only by one at a time.
void extract_each_surface(const anatomy::VirtualPatient& patient, const SurfaceOptions& options,
                          const SurfaceReceiver& receive);
/// Surface of one mask, closed also where the grid cuts the mask; empty for an empty mask. It encloses the volume of
/// the mask's voxels. A mask of more than 40,000 faces is made coarser first if that
/// does not lose thin walls.
TriangleMesh extract_surface(const volume::MaskGrid& mask, const SurfaceOptions& options = {});

}  // namespace trocar::surface
