#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "patient_builder/detail/label_boxes.h"
#include "volume/morphology.h"

namespace trocar::patient_builder::detail {

// Each repair changes labels and table, and appends to `repairs`.

/// Exchanges the names of a pair (X_left, X_right) that lie on each other's side, and relabels parts of one that lie at
/// the other. Nothing is exchanged if nearly all pairs are: then the image is mirrored, which is only a finding.
void correct_sides(volume::LabelGrid& labels, anatomy::LabelTable& table, std::vector<anatomy::Finding>& repairs);
/// The number of pairs on the right and on the wrong sides.
struct SideCount {
  std::size_t right = 0, wrong = 0;
  bool is_mirrored() const noexcept { return wrong >= 3 && wrong > 4 * right; }
};
SideCount count_sides(const volume::LabelGrid& labels, const anatomy::LabelTable& table);

/// Small parts far from a structure's largest part are removed; those that touch a structure of the same kind (a
/// vertebra's part at the next vertebra) get its label.
void remove_islands(volume::LabelGrid& labels, const anatomy::LabelTable& table,
                    std::vector<anatomy::Finding>& repairs);

/// Closed holes of a solid structure without any label get its label.
void fill_label_holes(volume::LabelGrid& labels, const anatomy::LabelTable& table,
                      std::vector<anatomy::Finding>& repairs);

/// Joins the pieces of a rib, and a rib and its vertebra, across short gaps that are bone in the CT.
void join_ribs(const volume::CtGrid& ct, volume::LabelGrid& labels, const anatomy::LabelTable& table,
               std::vector<anatomy::Finding>& repairs);
/// The gap between a rib and its vertebra.
struct RibGap {
  std::uint8_t rib = 0, vertebra = 0;
  volume::Index3 from{}, to{};  ///< Nearest voxels of rib and vertebra.
  double length_mm = 0.0;       ///< Between their centres.
};
/// Ribs whose vertebra is labelled, and that do not touch, up to a distance of 40 mm.
std::vector<RibGap> find_rib_gaps(const volume::LabelGrid& labels, const anatomy::LabelTable& table,
                                  const LabelBoxes& boxes);

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
bool is_one_part(const anatomy::Label& label);
/// "rib_left_7": 7; 0: no single rib.
int rib_number(const anatomy::Label& label);

/// "2 parts (0.4 ml)".
std::string amount_text(std::size_t count, const char* one, const char* many, double volume_ml);

}  // namespace trocar::patient_builder::detail
