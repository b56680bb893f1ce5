#include "tasks/outside_guess.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tasks/assess_path.h"
#include "tasks/detail/block_grid.h"
#include "tasks/detail/path_check.h"
#include "tasks/fit_to_patient.h"

namespace trocar::tasks {
namespace {

constexpr double kFelt_mm = 80.0;  // bone that is further from the skin is not felt

/// The middle between the left and the right skin, at the height of a point and through it from side to side; the
/// point's own x where the body leaves the volume.
double middle_x_mm(const anatomy::VirtualPatient& patient, const Vec3& p_P) {
  const volume::GridGeometry& geometry = patient.skin_distance_mm.geometry;
  const Vec3 at_V = geometry.to_index(p_P);
  const auto k = static_cast<std::int64_t>(std::lround(at_V.z()));
  if (k < 0 || k >= geometry.size[2]) return p_P.x();
  double low_mm = HUGE_VAL, high_mm = -HUGE_VAL;
  for (std::int64_t j = 0; j < geometry.size[1]; ++j)
    for (std::int64_t i = 0; i < geometry.size[0]; ++i) {
      if (!(patient.skin_distance_mm[{i, j, k}] < 0.0F)) continue;
      const double x_mm = geometry.centre_mm({i, j, k}).x();
      low_mm = std::min(low_mm, x_mm);
      high_mm = std::max(high_mm, x_mm);
    }
  return high_mm > low_mm ? 0.5 * (low_mm + high_mm) : p_P.x();
}

double bone_below_mm(const anatomy::VirtualPatient& patient, const Vec3& p_P) {
  std::array<bool, 256> is_bone{};
  for (const anatomy::Label& label : patient.label_table.labels) is_bone[label.id] = label.tissue == "bone";
  const volume::LabelGrid& labels = patient.labels;
  const detail::IndexBox box = detail::clipped(detail::box_around(labels.geometry, p_P, kFelt_mm), labels.geometry);
  double nearest_mm = kFelt_mm;
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i)
        if (is_bone[labels[{i, j, k}]])
          nearest_mm = std::min(nearest_mm, (labels.geometry.centre_mm({i, j, k}) - p_P).norm());
  return nearest_mm;
}

}  // namespace

std::optional<OutsideGuess> guess_from_outside(const Task& task, const anatomy::VirtualPatient& patient,
                                               const Segment& plan_P) {
  const bool has_zone = task.landmark_zone && task.entry_zone;
  if (patient.skin_distance_mm.empty() || !(has_zone || task.guidance == Guidance::kPalpation)) return std::nullopt;
  Vec3 entry_P = has_zone ? task.entry_zone->centre_P : plan_P.a;
  if (!has_zone) entry_P.x() = middle_x_mm(patient, plan_P.a);
  const auto on_skin_P = find_nearest_skin(patient, entry_P);
  if (!on_skin_P) return std::nullopt;
  const Vec3 inward_P = -detail::skin_normal(patient.skin_distance_mm, *on_skin_P);
  if (!(inward_P.norm() > 0.0)) return std::nullopt;
  const anatomy::Landmark* const landmark = has_zone ? find_landmark(patient, task.landmark_zone->landmark) : nullptr;
  return OutsideGuess{{*on_skin_P, *on_skin_P + plan_P.length_mm() * inward_P},
                      bone_below_mm(patient, landmark != nullptr ? landmark->p_P : plan_P.a)};
}

}  // namespace trocar::tasks
