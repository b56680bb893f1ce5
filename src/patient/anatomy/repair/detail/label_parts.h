#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/detail/label_boxes.h"
#include "anatomy/label_table.h"
#include "volume/morphology.h"

namespace trocar::anatomy::detail {

/// The connected parts (6 neighbours) of one label, the largest first.
struct LabelParts {
  std::uint8_t id = 0;
  IndexBox box;                        ///< Around all parts.
  volume::Components parts;            ///< On the grid of the box.
  std::vector<volume::Index3> middle;  ///< Of each part: its voxel nearest to its centroid.
  double voxel_ml = 0.0;

  std::size_t count() const noexcept { return parts.voxel_counts.size(); }
  double volume_ml(std::size_t part) const { return static_cast<double>(parts.voxel_counts[part]) * voxel_ml; }
  /// Calls visit(offset in the whole grid, ijk) for the voxels of a part.
  template <class Visit>
  void for_each(const volume::GridGeometry& geometry, std::size_t part, Visit&& visit) const {
    for_each_in(geometry, box, [&](std::size_t n, std::size_t in_box, const volume::Index3& ijk) {
      if (static_cast<std::size_t>(parts.ids.voxels[in_box]) == part + 1) visit(n, ijk);
    });
  }
};
LabelParts find_parts(const volume::LabelGrid& labels, std::uint8_t id, const IndexBox& box);

/// Least distance (mm) of each part to the largest one; 0 for the largest.
std::vector<double> distances_to_main_mm(const LabelParts& parts);

/// True for a structure that is one connected part in every person: "liver", "vertebrae_L3"; not bowel, vessels,
/// lesions, cartilages, or a label for several structures ("bone", "kidneys").
bool is_one_part(const Label& label);
/// "rib_left_7": 7; 0: no single rib.
int rib_number(const Label& label);

/// "2 parts (0.4 ml)".
std::string amount_text(std::size_t count, const char* one, const char* many, double volume_ml);

}  // namespace trocar::anatomy::detail
