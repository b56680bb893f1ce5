#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dicom/segmentation/detail/contour_overlaps.h"
#include "dicom/segmentation/detail/contours.h"
#include "volume/grid.h"

namespace trocar::dicom::detail {

/// The grid that contours are drawn on, and the axis of it that they are at right angles to.
struct ContourGrid {
  volume::GridGeometry geometry;
  int axis = 2;
};

/// Contours in indices of the grid.
std::vector<FlatContour> flatten(const std::vector<Contour>& contours, const ContourGrid& grid);

/// Contours of one plane whose boxes overlap: an outline with its holes. Fills [low, high) along the axis.
struct ContourGroup {
  CombinedOutlines outlines;
  Eigen::AlignedBox2d box;
  double w = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// Distances between planes, in steps of the grid. Gaps are counted once for each part of the structure beside them.
struct PlaneDistances {
  double usual = 1.0;  ///< Median, or the multiple of the grid's step next to it.
  std::size_t filled_gaps = 0;
  double widest_filled = 0.0;
  std::size_t open_gaps = 0;
  double narrowest_open = 0.0;
};

struct GroupedContours {
  std::vector<ContourGroup> groups;  ///< In order of w.
  PlaneDistances distances;
};

/// Gives each outline the part of the axis that it fills. Planes lie where the file puts them: beside the slices of the
/// CT, at uneven distances, on every other slice. An outline reaches half-way to the next one above and below that
/// overlaps it; where there is none, or beyond a gap between separate parts, half the usual distance. A gap is one if
/// it is wider than two usual distances and the jitter of the planes, and much wider than the distances beside it.
/// `is_exclusive_or` as for combine_outlines.
GroupedContours group_contours(const std::vector<FlatContour>& contours, const ContourGrid& grid, bool is_exclusive_or);

/// The usual distance of planes at these places (mm, in any order), by the same rule; `fallback_mm` for one plane.
double usual_distance(std::vector<double> places_mm, double fallback_mm);

}  // namespace trocar::dicom::detail
