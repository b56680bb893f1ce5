#include "tasks/detail/planning_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/parallel.h"
#include "tasks/detail/block_grid.h"
#include "tasks/fit_to_patient.h"
#include "volume/distance.h"
#include "volume/sampling.h"

namespace trocar::tasks::detail {
namespace {

constexpr double kCell_mm = 2.5;           ///< Approximate edge of the coarse cells.
constexpr double kTargetSpread_mm = 10.0;  ///< Between parenchymal targets.
constexpr std::size_t kMaxTargets = 48;
constexpr std::size_t kMaxLesions = 16;
constexpr double kLesionCore = 0.8;  ///< Centre of a lesion: deeper than this fraction of its maximum depth.

Role role_of(const Task& task, const anatomy::Label& label) {
  if (is_target(task, label)) return Role::kTarget;
  if (is_organ(task, label)) return Role::kOrgan;
  if (find_risk(task, label)) return Role::kForbidden;
  if (label.tissue == "muscle") return Role::kMuscle;
  for (const char* tissue : {"skin", "adipose", "soft_tissue", "fluid", "ascites", "peritoneum"})
    if (label.tissue == tissue) return Role::kPassable;
  const bool passes = std::find(task.passes.begin(), task.passes.end(), label.tissue) != task.passes.end();
  return passes ? Role::kMuscle : Role::kForbidden;
}

/// Where the task lets target points lie.
struct TargetRegion {
  double highest_z_mm = std::numeric_limits<double>::infinity();
  const anatomy::Landmark* away_from = nullptr;
  double away_mm = 0.0;

  bool contains(const Vec3& p_P) const {
    return p_P.z() <= highest_z_mm && (away_from == nullptr || (p_P - away_from->p_P).norm() >= away_mm);
  }
};

/// Points on the middle line of a long target, at least `step_mm` apart, the thickest parts first.
std::vector<Vec3> points_along(const volume::LabelGrid& labels, std::uint8_t id, const IndexBox& box, double step_mm,
                               const TargetRegion& region) {
  const volume::MaskGrid mask = cut_mask(labels, grown(box, 1), [&](std::uint8_t label) { return label == id; });
  const volume::FloatGrid distance = volume::signed_distance_mm(mask);
  std::vector<std::pair<float, std::size_t>> order;
  for (std::size_t n = 0; n < distance.voxels.size(); ++n)
    if (distance.voxels[n] < 0.0F) order.emplace_back(distance.voxels[n], n);
  std::sort(order.begin(), order.end());
  std::vector<Vec3> points;
  for (const auto& [depth, n] : order) {
    const Vec3 p_P = mask.geometry.centre_mm(mask.geometry.index_of(n));
    const bool is_free = region.contains(p_P) && std::none_of(points.begin(), points.end(), [&](const Vec3& other) {
                           return (other - p_P).norm() < step_mm;
                         });
    if (is_free) points.push_back(p_P);
    if (points.size() == kMaxTargets) break;
  }
  return points;
}

/// Height (z) of the lowest voxel of a structure; infinity without a name. Error: the patient lacks it.
Result<double> lowest_of(const PlanningMap& map, const LabelBoxes& boxes, const std::string& name) {
  if (name.empty()) return std::numeric_limits<double>::infinity();
  const anatomy::Label* label = map.patient.label_table.find(name);
  if (label == nullptr || boxes.voxels[label->id] == 0)
    return fail("has no " + name + ", below which the target lies", map.patient.name,
                "label it, or take target_below out of the task");
  const volume::LabelGrid& labels = map.patient.labels;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < labels.voxels.size(); ++n)
    if (labels.voxels[n] == label->id)
      lowest = std::min(lowest, labels.geometry.centre_mm(labels.geometry.index_of(n)).z());
  return lowest;
}

/// The centre of one lesion: that of its deepest part, or its deepest voxel if the part is curved.
Vec3 lesion_middle(const volume::LabelGrid& labels, std::uint8_t id, const IndexBox& box) {
  const volume::MaskGrid mask = cut_mask(labels, grown(box, 1), [&](std::uint8_t label) { return label == id; });
  const volume::FloatGrid distance = volume::signed_distance_mm(mask);
  const auto deepest = std::min_element(distance.voxels.begin(), distance.voxels.end());
  const auto point_of = [&](std::size_t n) {
    const volume::Index3 ijk = mask.geometry.index_of(n);
    return mask.geometry.centre_mm(ijk);
  };
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (std::size_t n = 0; n < distance.voxels.size(); ++n) {
    if (static_cast<double>(distance.voxels[n]) > kLesionCore * static_cast<double>(*deepest)) continue;
    sum += point_of(n);
    count += 1.0;
  }
  const Vec3 middle = sum / count;
  if (volume::sample_nearest(labels, middle, std::uint8_t{0}) == id) return middle;
  return point_of(static_cast<std::size_t>(deepest - distance.voxels.begin()));
}

/// Points of the organ deep enough below its surface and far enough from vessels, on coarse cells.
std::vector<Vec3> parenchymal_points(const PlanningMap& map, const IndexBox& organ_box) {
  const volume::LabelGrid& labels = map.patient.labels;
  std::array<bool, 256> is_inside{};
  std::array<bool, 256> is_vessel{};
  for (const anatomy::Label& label : map.patient.label_table.labels) {
    is_vessel[label.id] = label.tissue == "vessel";
    is_inside[label.id] = is_organ(map.task, label) || is_vessel[label.id];
  }
  // One cell around the organ, even outside the volume: unseen space does not count as organ.
  const BlockGrid blocks =
      make_blocks(labels.geometry, grown(organ_box, blocks_factor(labels.geometry, kCell_mm)), kCell_mm);
  const volume::MaskGrid outside = block_mask(
      labels, blocks, [&](std::uint8_t id) { return !is_inside[id]; }, /*beyond=*/true);
  const volume::MaskGrid vessels = block_mask(
      labels, blocks, [&](std::uint8_t id) { return is_vessel[id]; }, false);
  const volume::FloatGrid depth = volume::distance_to_mask_mm(outside);
  const bool has_vessels = std::find(vessels.voxels.begin(), vessels.voxels.end(), 1) != vessels.voxels.end();
  const volume::FloatGrid to_vessel = has_vessels ? volume::distance_to_mask_mm(vessels) : volume::FloatGrid();
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < depth.voxels.size(); ++n) {
    if (static_cast<double>(depth.voxels[n]) < map.task.parenchymal_depth_mm + blocks.half_diagonal_mm) continue;
    if (has_vessels &&
        static_cast<double>(to_vessel.voxels[n]) < map.task.parenchymal_vessel_mm + blocks.half_diagonal_mm)
      continue;
    points.push_back(blocks.centre(n));
  }
  return points;
}

/// At most kMaxTargets of the points, those nearest to the skin, with a minimum distance.
std::vector<Vec3> spread_targets(const std::vector<Vec3>& points, const volume::FloatGrid& skin_distance) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t n = 0; n < points.size(); ++n)
    order.emplace_back(-volume::sample_linear(skin_distance, points[n]), n);
  std::sort(order.begin(), order.end());
  std::vector<Vec3> chosen;
  for (const auto& [depth, n] : order) {
    const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&, index = n](const Vec3& other) {
      return (other - points[index]).norm() < kTargetSpread_mm;
    });
    if (!is_near) chosen.push_back(points[n]);
    if (chosen.size() == kMaxTargets) break;
  }
  return chosen;
}

}  // namespace

Role PlanningMap::role_at(const Vec3& p_P) const noexcept {
  return roles[volume::sample_nearest(patient.labels, p_P, std::uint8_t{0})];
}

PlanningMap make_planning_map(const Task& task, const anatomy::VirtualPatient& patient) {
  PlanningMap map{task, patient};
  map.posture = posture_of(task, patient);
  for (const anatomy::Label& label : patient.label_table.labels) {
    map.roles[label.id] = role_of(task, label);
    if (map.roles[label.id] == Role::kForbidden) map.risks[label.id] = find_risk(task, label);
  }
  return map;
}

Result<PlanTargets> find_targets(const PlanningMap& map) {
  const volume::LabelGrid& labels = map.patient.labels;
  if (std::string shortage = target_shortage(map.task, map.patient); !shortage.empty())
    return fail(std::move(shortage), map.patient.name, "label the target, or choose another patient");
  if (map.task.target_P) {
    const Role role = map.role_at(*map.task.target_P);
    if (role == Role::kTarget || role == Role::kOrgan) return PlanTargets{{*map.task.target_P}, role == Role::kOrgan};
    return fail("the target point does not lie in the " + map.task.organ, map.patient.name, "move the target");
  }
  const LabelBoxes boxes = find_label_boxes(labels);
  PlanTargets targets;
  std::vector<std::pair<std::size_t, std::uint8_t>> lesions;
  IndexBox organ_box;
  for (const anatomy::Label& label : map.patient.label_table.labels) {
    if (boxes.voxels[label.id] == 0) continue;
    if (map.roles[label.id] == Role::kTarget) lesions.emplace_back(boxes.voxels[label.id], label.id);
    if (map.roles[label.id] == Role::kOrgan || map.roles[label.id] == Role::kTarget)
      organ_box = united(organ_box, boxes.boxes[label.id]);
  }
  if (organ_box.is_empty()) return fail("has no " + map.task.organ, map.patient.name, "choose another task");
  std::sort(lesions.begin(), lesions.end(), std::greater<>());
  TargetRegion region{0.0, find_landmark(map.patient, map.task.target_away_from), map.task.target_away_mm};
  TROCAR_TRY(region.highest_z_mm, lowest_of(map, boxes, map.task.target_below));
  for (const auto& [voxels, id] : lesions) {
    if (map.task.target_step_mm <= 0.0) break;
    const auto points = points_along(labels, id, boxes.boxes[id], map.task.target_step_mm, region);
    targets.points_P.insert(targets.points_P.end(), points.begin(), points.end());
  }
  if (!targets.points_P.empty()) return targets;
  if (map.task.target_step_mm > 0.0 && !lesions.empty())
    return fail("no part of the target lies where the task allows it", map.patient.name,
                "relax target_below or target_away_mm of the task, or choose another patient");
  for (const auto& [voxels, id] : lesions)
    if (targets.points_P.size() < kMaxLesions) targets.points_P.push_back(lesion_middle(labels, id, boxes.boxes[id]));
  if (!targets.points_P.empty()) return targets;
  if (!map.task.target_label.empty())
    return fail(fmt::format("has no structure \"{}\", the target", map.task.target_label), map.patient.name,
                "choose another target");
  targets.is_parenchymal = true;
  targets.points_P = spread_targets(parenchymal_points(map, organ_box), map.patient.skin_distance_mm);
  if (targets.points_P.empty())
    return fail("no point of the " + map.task.organ + " lies deep enough below its surface and far enough from vessels",
                map.patient.name, "lower [parenchymal] depth_mm or vessel_mm in the task");
  return targets;
}

void measure_clearance(PlanningMap& map, const PlanTargets& targets, double reach_mm) {
  const volume::LabelGrid& labels = map.patient.labels;
  IndexBox box;
  for (const Vec3& target : targets.points_P) box = united(box, box_around(labels.geometry, target, reach_mm));
  const BlockGrid blocks = make_blocks(labels.geometry, clipped(box, labels.geometry), kCell_mm);
  map.slack_mm = blocks.half_diagonal_mm;
  map.clearance_mm = volume::FloatGrid(blocks.geometry, std::numeric_limits<float>::infinity());

  // One distance map per margin instead of one per structure.
  std::map<double, std::array<bool, 256>> ids_of_margin;
  for (std::size_t id = 0; id < map.risks.size(); ++id)
    if (map.risks[id]) ids_of_margin[map.risks[id]->margin_mm][id] = true;
  for (const auto& [margin, ids] : ids_of_margin) {
    const volume::MaskGrid mask = block_mask(
        labels, blocks, [&set = ids](std::uint8_t id) { return set[id]; }, false);
    if (std::find(mask.voxels.begin(), mask.voxels.end(), 1) == mask.voxels.end()) continue;
    map.largest_margin_mm = std::max(map.largest_margin_mm, margin);
    const volume::FloatGrid distance = volume::distance_to_mask_mm(mask);
    for (std::size_t n = 0; n < distance.voxels.size(); ++n)
      map.clearance_mm.voxels[n] =
          std::min(map.clearance_mm.voxels[n], distance.voxels[n] - static_cast<float>(margin));
  }
  // Far from everything but finite, so that interpolation is finite.
  for (float& clearance : map.clearance_mm.voxels) clearance = std::min(clearance, static_cast<float>(reach_mm));
}

}  // namespace trocar::tasks::detail
