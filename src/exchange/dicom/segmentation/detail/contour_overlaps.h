#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace trocar::dicom::detail {

/// A contour in indices of a grid: u and v in the plane, w along the axis.
struct FlatContour {
  std::vector<Eigen::Vector2d> points;
  double w = 0.0;
  Eigen::AlignedBox2d box;
};

enum class OutlineRelation {
  kApart,
  kNested,    ///< One lies inside the other one: a hole.
  kSame,      ///< The same outline: from another point, in the other direction, with other points, up to 0.5 mm beside.
  kCrossing,  ///< Parts that overlap.
};

/// How two contours of one plane lie to each other.
struct OutlinePair {
  OutlineRelation relation = OutlineRelation::kApart;
  double common_mm2 = 0.0;   ///< Inside both.
  bool is_doubtful = false;  ///< Nested, but it crosses the outer one a little, or leaves only a thin ring of it.
};
/// `pixel_mm` is the size of a pixel along u and v.
OutlinePair relate_outlines(const FlatContour& a, const FlatContour& b, const Eigen::Vector2d& pixel_mm);

/// What contours of one plane mean together: `contours` and each list of `united` count as one outline each; inside is
/// what an odd number of these contains.
struct CombinedOutlines {
  std::vector<const FlatContour*> contours;
  std::vector<std::vector<const FlatContour*>> united;  ///< Outlines that cross: their union.
  std::size_t repeated = 0;                             ///< Contours left out, as they are the same as another one.
  std::size_t crossing = 0;                             ///< Pairs that cross,
  double crossing_mm2 = 0.0;                            ///< and what lies in both.
  std::size_t doubtful = 0;                             ///< Pairs whose inner one may be no hole,
  double doubtful_mm2 = 0.0;                            ///< and its area.
};

/// `is_exclusive_or`: the file says that common parts are outside (CLOSEDPLANAR_XOR); then nothing is united.
CombinedOutlines combine_outlines(const std::vector<const FlatContour*>& contours, const Eigen::Vector2d& pixel_mm,
                                  bool is_exclusive_or);

}  // namespace trocar::dicom::detail
