#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace trocar::patient_builder::detail {

// Where structures usually lie and how they look in a CT, to tell what label numbers mean. Wide on purpose: adults and
// children, with and without contrast agent; rare variants contradict a few of them, wrong numbers many. [assumed]

struct UsualHu {
  std::string_view name;  ///< Of a structure or tissue.
  double low, high;       ///< Of the mean.
};
/// nullptr: anything.
const UsualHu* usual_hu(std::string_view name, std::string_view tissue);

struct UsualSize {
  std::string_view name;
  double low_ml, high_ml;
  double spread_x_mm;  ///< Largest standard deviation of its places from left to right.
};
const UsualSize* usual_size(std::string_view name, bool is_vertebra);

/// Distance from the body's middle along x (left is positive) or y (back).
struct UsualSide {
  int axis;
  double low_mm, high_mm;
};
std::vector<UsualSide> usual_sides(std::string_view name, bool is_vertebra);

/// `first` lies at least so far towards the left (axis 0), back (1) or head (2) of `second`.
struct UsualRelation {
  std::string_view first;
  int axis;
  std::string_view second;
  double least_mm;
};
inline constexpr std::string_view kSpine = "spine";  ///< The mean place of the vertebrae from T11 to L5.
std::span<const UsualRelation> usual_relations();

struct UsualDistance {
  std::string_view first, second;
  double least_mm, most_mm;  ///< Between their middles.
};
std::span<const UsualDistance> usual_distances();

}  // namespace trocar::patient_builder::detail
