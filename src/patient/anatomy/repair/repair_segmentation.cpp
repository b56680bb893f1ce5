#include "anatomy/repair/repair_segmentation.h"

#include "anatomy/repair/detail/repairs.h"

namespace trocar::anatomy {

std::vector<Finding> repair_segmentation(const volume::CtGrid& ct, volume::LabelGrid& labels, LabelTable& table) {
  std::vector<Finding> repairs;
  detail::correct_sides(labels, table, repairs);
  detail::remove_islands(labels, table, repairs);
  detail::join_ribs(ct, labels, table, repairs);
  detail::fill_label_holes(labels, table, repairs);
  return repairs;
}

}  // namespace trocar::anatomy
