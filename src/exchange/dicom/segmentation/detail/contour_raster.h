#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/segmentation/detail/contour_planes.h"
#include "dicom/segmentation/detail/contours.h"
#include "volume/grid.h"

namespace trocar::dicom::detail {

/// The CT's grid if the contours are parallel to one of its planes, else a grid of its own along the contours. Errors
/// (at `where`, by the structure's name): a contour that is not planar, or not parallel to the others; a grid too large
/// for the memory.
Result<ContourGrid> choose_grid(const ContourStructure& structure, const volume::GridGeometry& ct,
                                const std::string& where);

/// The voxels inside the contours; one byte a voxel of the grid.
struct RasterResult {
  std::vector<std::uint8_t> mask;
  PlaneDistances distances;
  std::size_t repeated = 0;  ///< Contours that repeat another one, left out: twice inside would be outside.
  std::size_t crossing = 0;  ///< Pairs of contours of one plane that cross,
  double crossing_ml = 0.0;  ///< and what lies in both: inside, but for a structure of CLOSEDPLANAR_XOR.
  std::size_t doubtful = 0;  ///< Holes that may be none (OutlinePair),
  double doubtful_ml = 0.0;  ///< and what lies in them.
  double outside_ml = 0.0;   ///< Inside the contours, but beyond the grid.
};
RasterResult rasterise(const ContourStructure& structure, const ContourGrid& grid);

}  // namespace trocar::dicom::detail
