#include "tasks/detail/target_volume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "tasks/detail/block_grid.h"
#include "volume/morphology.h"

namespace trocar::tasks::detail {
namespace {

constexpr double kMm3PerMl = 1000.0;

/// Volume (ml) of the largest connected piece of some labels.
double largest_piece_ml(const volume::LabelGrid& labels, const std::array<bool, 256>& is_target) {
  const LabelBoxes boxes = find_label_boxes(labels);
  IndexBox box;
  for (std::size_t id = 0; id < is_target.size(); ++id)
    if (is_target[id] && boxes.voxels[id] > 0) box = united(box, boxes.boxes[id]);
  if (box.is_empty()) return 0.0;
  const volume::Components pieces =
      volume::connected_components(cut_mask(labels, box, [&](std::uint8_t id) { return is_target[id]; }));
  return static_cast<double>(pieces.voxel_counts.front()) * labels.geometry.spacing_mm.prod() / kMm3PerMl;
}

}  // namespace

std::string target_shortage(const Task& task, const anatomy::VirtualPatient& patient) {
  if (task.least_target_ml <= 0.0) return {};
  std::array<bool, 256> is_wanted{};
  bool is_derived = false;
  for (const anatomy::Label& label : patient.label_table.labels) {
    is_wanted[label.id] = is_target(task, label);
    is_derived |= is_wanted[label.id] && label.is_derived;
  }
  const double ml = largest_piece_ml(patient.labels, is_wanted);
  if (ml >= task.least_target_ml) return {};
  const std::string target =
      task.target_label.empty() ? fmt::format("{}", fmt::join(task.target_tissues, ", ")) : task.target_label;
  if (ml == 0.0) return fmt::format("no {} is labelled: the target of this task is no healthy tissue", target);
  return fmt::format("the {} has at most {:.2g} ml in one piece{}: the task needs {:g} ml", target, ml,
                     is_derived ? " (derived, not seen in the scan)" : "", task.least_target_ml);
}

}  // namespace trocar::tasks::detail
