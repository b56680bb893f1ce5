#pragma once

#include <vector>

#include "anatomy/detail/label_boxes.h"
#include "anatomy/patient.h"

namespace trocar::anatomy::detail {

// Each repair changes labels and table, and appends to `repairs`.

/// Exchanges the names of a pair (X_left, X_right) that lie on each other's side, and relabels parts of one that lie at
/// the other. Nothing is exchanged if nearly all pairs are: then the image is mirrored, which is only a finding.
void correct_sides(volume::LabelGrid& labels, LabelTable& table, std::vector<Finding>& repairs);
/// The number of pairs on the right and on the wrong sides.
struct SideCount {
  std::size_t right = 0, wrong = 0;
  bool is_mirrored() const noexcept { return wrong >= 3 && wrong > 4 * right; }
};
SideCount count_sides(const volume::LabelGrid& labels, const LabelTable& table);

/// Small parts far from a structure's largest part are removed; those that touch a structure of the same kind (a
/// vertebra's part at the next vertebra) get its label.
void remove_islands(volume::LabelGrid& labels, const LabelTable& table, std::vector<Finding>& repairs);

/// Closed holes of a solid structure without any label get its label.
void fill_label_holes(volume::LabelGrid& labels, const LabelTable& table, std::vector<Finding>& repairs);

/// Joins the pieces of a rib, and a rib and its vertebra, across short gaps that are bone in the CT.
void join_ribs(const volume::CtGrid& ct, volume::LabelGrid& labels, const LabelTable& table,
               std::vector<Finding>& repairs);
/// The gap between a rib and its vertebra.
struct RibGap {
  std::uint8_t rib = 0, vertebra = 0;
  volume::Index3 from{}, to{};  ///< Nearest voxels of rib and vertebra.
  double length_mm = 0.0;       ///< Between their centres.
};
/// Ribs whose vertebra is labelled, and that do not touch, up to a distance of 40 mm.
std::vector<RibGap> find_rib_gaps(const volume::LabelGrid& labels, const LabelTable& table, const LabelBoxes& boxes);

}  // namespace trocar::anatomy::detail
