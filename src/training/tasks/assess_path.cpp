#include "tasks/assess_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tasks/detail/block_grid.h"
#include "tasks/detail/path_check.h"
#include "tasks/detail/planning_map.h"
#include "tasks/fit_to_patient.h"
#include "tasks/plan.h"
#include "volume/sampling.h"

namespace trocar::tasks {
namespace {

using detail::PlanningMap;
using detail::Role;

constexpr double kPathStep_mm = 0.25;
constexpr double kOnSkin_mm = 3.0;    ///< Distance from the skin at which a path may start: one or two voxels.
constexpr double kNotchShare = 0.25;  ///< Part of the notch around its centre that must contain the target.

/// Collects all findings along the path.
class Assessor {
 public:
  Assessor(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle, const Segment& line_P)
      : task_(task),
        patient_(patient),
        needle_(needle),
        line_P_(line_P),
        axis_P_(line_P.direction()),
        map_(detail::make_planning_map(task, patient)) {
    made_.path.line_P = line_P;
    made_.path.length_mm = line_P.length_mm();
  }

  PathAssessment assess() {
    check_entry();
    check_length();
    walk();
    measure_margins();
    check_target();
    return std::move(made_);
  }

 private:
  double whole_mm() const { return made_.path.length_mm + needle_.throw_mm; }
  Vec3 at(double depth_mm) const { return line_P_.a + depth_mm * axis_P_; }
  double depth_of(const Vec3& p_P) const { return (p_P - line_P_.a).dot(axis_P_); }
  void add(PathFault fault, const Vec3& where_P, std::string text, std::string label = {}, double clearance_mm = 0.0) {
    made_.findings.push_back(
        {fault, std::move(label), std::move(text), where_P, std::max(0.0, depth_of(where_P)), clearance_mm});
  }

  void check_entry() {
    const Vec3& entry_P = line_P_.a;
    made_.skin_distance_mm = volume::sample_linear(patient_.skin_distance_mm, entry_P);
    if (std::abs(made_.skin_distance_mm) > kOnSkin_mm)
      add(PathFault::kNotOnSkin, entry_P,
          fmt::format("the path begins {:.0f} mm {} the skin", std::abs(made_.skin_distance_mm),
                      made_.skin_distance_mm < 0.0 ? "below" : "above"));
    const Vec3 normal = detail::skin_normal(patient_.skin_distance_mm, entry_P);
    const double cosine = std::clamp(-normal.dot(axis_P_), -1.0, 1.0);
    made_.entry_angle_deg = degrees(std::acos(cosine));
    if (made_.entry_angle_deg > task_.max_entry_angle_deg)
      add(PathFault::kGlancing, entry_P,
          fmt::format("the needle is {:.0f}° from the skin's normal; the limit is {:.0f}°", made_.entry_angle_deg,
                      task_.max_entry_angle_deg));
    const anatomy::Posture posture = posture_of(task_, patient_);
    const double down = normal.dot(anatomy::gravity_P(posture));
    if (down > std::sin(radians(task_.max_posterior_deg)))
      add(PathFault::kOutOfReach, entry_P,
          fmt::format("the patient is {}: the entry faces down and is not accessible",
                      anatomy::posture_words(posture)));
    if (!task_.entry_zone) return;
    const double outside_mm = task_.entry_zone->distance_outside_mm(entry_P);
    if (outside_mm > 0.0)
      add(PathFault::kOutsideZone, entry_P, fmt::format("the entry is {:.0f} mm outside the entry zone", outside_mm));
  }

  void check_length() {
    const double reach_mm = needle_.length_mm - detail::kHubReserve_mm;
    const double longest_mm = std::min(task_.max_path_mm, reach_mm);
    if (made_.path.length_mm <= longest_mm) return;
    add(PathFault::kTooLong, line_P_.b,
        fmt::format("the path is {:.0f} mm long; {} {:.0f} mm", made_.path.length_mm,
                    reach_mm < task_.max_path_mm ? "the needle reaches" : "the task allows", longest_mm));
  }

  void walk() {
    const int steps = static_cast<int>(std::floor(whole_mm() / kPathStep_mm));
    bool has_target = false;
    for (int n = 0; n <= steps; ++n) {
      const double s_mm = n * kPathStep_mm;
      const Vec3 p_P = at(s_mm);
      const std::uint8_t id = volume::sample_nearest(patient_.labels, p_P, std::uint8_t{0});
      const Role role = map_.roles[id];
      has_target |= role == Role::kTarget;
      if (role == Role::kOrgan && !has_target && s_mm < made_.path.length_mm) made_.path.organ_path_mm += kPathStep_mm;
      if (id == 0 || role != Role::kForbidden || is_crossed_[id]) continue;
      is_crossed_[id] = true;
      const anatomy::Label& label = *patient_.label_table.find(id);
      const bool is_in_throw = s_mm > made_.path.length_mm;
      add(PathFault::kCrosses, p_P,
          fmt::format("the {} goes through {} ({}) {:.0f} mm below the skin",
                      is_in_throw ? "biopsy needle's throw" : "path", label.name, label.tissue, s_mm),
          label.name);
    }
    if (made_.path.organ_path_mm < task_.min_organ_path_mm)
      add(PathFault::kOrganPath, line_P_.b,
          fmt::format("the path passes through {:.0f} mm of {} before the target; the minimum is {:.0f} mm",
                      made_.path.organ_path_mm, task_.organ, task_.min_organ_path_mm));
  }

  struct Nearest {
    double distance_mm = std::numeric_limits<double>::infinity();
    Vec3 where_P = Vec3::Zero();
  };

  /// Finds every risk voxel within its margin plus 10 mm of one piece of the path.
  void look_around(const Segment& piece, double radius_mm, std::array<Nearest, 256>& nearest) const {
    const volume::GridGeometry& geometry = patient_.labels.geometry;
    const detail::IndexBox box = detail::clipped(detail::united(detail::box_around(geometry, piece.a, radius_mm),
                                                                detail::box_around(geometry, piece.b, radius_mm)),
                                                 geometry);
    const double half_voxel_mm = 0.5 * geometry.spacing_mm.norm();
    for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
      for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
        for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) {
          const std::uint8_t id = patient_.labels[{i, j, k}];
          if (map_.risks[id] == nullptr || is_crossed_[id]) continue;
          const Vec3 centre_P =
              geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
          if (distance_mm(piece, centre_P) - half_voxel_mm >= nearest[id].distance_mm) continue;
          const double away_mm = detail::segment_box_distance_mm(piece, geometry, centre_P);
          if (away_mm < nearest[id].distance_mm) nearest[id] = {away_mm, centre_P};
        }
  }

  void measure_margins() {
    double widest_mm = 0.0;
    for (const RiskStructure& risk : task_.risks) widest_mm = std::max(widest_mm, risk.margin_mm);
    const double radius_mm = widest_mm + detail::kReportedMargin_mm + 0.5 * patient_.labels.geometry.spacing_mm.norm();
    std::array<Nearest, 256> nearest;
    const Segment way{line_P_.a, at(whole_mm())};
    const int count = std::max(1, static_cast<int>(std::ceil(whole_mm() / detail::kChunk_mm)));
    for (int n = 0; n < count; ++n)
      look_around({way.at(static_cast<double>(n) / count), way.at(static_cast<double>(n + 1) / count)}, radius_mm,
                  nearest);
    made_.path.spare_margin_mm = detail::kReportedMargin_mm;
    for (const anatomy::Label& label : patient_.label_table.labels) {
      const RiskStructure* risk = map_.risks[label.id];
      if (risk == nullptr) continue;
      const double away_mm = is_crossed_[label.id] ? 0.0 : nearest[label.id].distance_mm;
      if (away_mm - risk->margin_mm < made_.path.spare_margin_mm) {
        made_.path.spare_margin_mm = away_mm - risk->margin_mm;
        made_.path.nearest_risk = label.name;
      }
      if (is_crossed_[label.id] || away_mm >= risk->margin_mm) continue;
      const Vec3& where_P = nearest[label.id].where_P;
      add(PathFault::kMargin, where_P,
          fmt::format(
              "the path passes {} ({}) at {:.1f} mm, {:.0f} mm below the skin; the required margin is {:.0f} mm",
              label.name, label.tissue, away_mm, std::max(0.0, depth_of(where_P)), risk->margin_mm),
          label.name, away_mm);
    }
  }

  void check_target() {
    const Vec3 reached_P = at(made_.path.length_mm + needle_.notch_middle_mm());
    if (const anatomy::Landmark* const landmark = find_landmark(patient_, task_.target_away_from)) {
      const double away_mm = (reached_P - landmark->p_P).norm();
      if (away_mm < task_.target_away_mm)
        add(PathFault::kOffTarget, reached_P,
            fmt::format("the needle ends {:.0f} mm from the {}; the minimum is {:.0f} mm", away_mm, landmark->name,
                        task_.target_away_mm));
    }
    if (task_.target_P) {
      const double miss_mm = (reached_P - *task_.target_P).norm();
      if (miss_mm > task_.target_tolerance_mm)
        add(PathFault::kOffTarget, reached_P,
            fmt::format("the needle's end position is {:.0f} mm from the target", miss_mm));
      return;
    }
    const bool wants_organ = is_parenchymal(task_, patient_);
    const double around_mm = kNotchShare * needle_.notch_mm;
    for (const double s_mm : {0.0, -around_mm, around_mm}) {
      const Role role = map_.role_at(reached_P + s_mm * axis_P_);
      if (role == Role::kTarget || (wants_organ && role == Role::kOrgan)) return;
    }
    const anatomy::Label* label = anatomy::find_label(patient_, reached_P);
    add(PathFault::kOffTarget, reached_P,
        fmt::format("the needle ends in {}, not in the target", label != nullptr ? label->name : "nothing labelled"));
  }

  const Task& task_;
  const anatomy::VirtualPatient& patient_;
  const Needle& needle_;
  Segment line_P_;
  Vec3 axis_P_;
  PlanningMap map_;
  std::array<bool, 256> is_crossed_{};
  PathAssessment made_;
};

bool is_in_volume(const volume::GridGeometry& geometry, const Vec3& p_P) {
  const Vec3 index = geometry.to_index(p_P);
  for (int a = 0; a < 3; ++a)
    if (!(index[a] >= 0.0 && index[a] <= static_cast<double>(geometry.size[static_cast<std::size_t>(a)] - 1)))
      return false;
  return true;
}

}  // namespace

PathAssessment assess_path(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle,
                           const Segment& line_P) {
  return Assessor(task, patient, needle, line_P).assess();
}

std::optional<Vec3> find_skin_entry(const anatomy::VirtualPatient& patient, const Vec3& target_P, const Vec3& towards_P,
                                    double longest_mm) {
  const Vec3 way = towards_P - target_P;
  if (!(way.norm() > 0.0)) return std::nullopt;
  const Vec3 outward = way.normalized();
  double inside_mm = 0.0;
  for (double s_mm = 0.0; s_mm <= longest_mm; s_mm += kPathStep_mm) {
    const Vec3 p_P = target_P + s_mm * outward;
    if (!is_in_volume(patient.skin_distance_mm.geometry, p_P)) return std::nullopt;
    const double distance = volume::sample_linear(patient.skin_distance_mm, p_P);
    if (distance < 0.0) {
      inside_mm = s_mm;
      continue;
    }
    double outside_mm = s_mm;
    for (int n = 0; n < 20; ++n) {
      const double middle_mm = 0.5 * (inside_mm + outside_mm);
      (volume::sample_linear(patient.skin_distance_mm, target_P + middle_mm * outward) < 0.0 ? inside_mm : outside_mm) =
          middle_mm;
    }
    return Vec3(target_P + outside_mm * outward);
  }
  return std::nullopt;
}

std::optional<Vec3> find_nearest_skin(const anatomy::VirtualPatient& patient, const Vec3& p_P, double reach_mm) {
  constexpr int kMaxSteps = 100;
  constexpr double kClose_mm = 0.05;
  Vec3 q_P = p_P;
  for (int n = 0; n < kMaxSteps; ++n) {
    if (!is_in_volume(patient.skin_distance_mm.geometry, q_P) || (q_P - p_P).norm() > reach_mm) return std::nullopt;
    const double distance = volume::sample_linear(patient.skin_distance_mm, q_P);
    if (std::abs(distance) < kClose_mm) return q_P;
    const Vec3 normal = detail::skin_normal(patient.skin_distance_mm, q_P);
    if (!(normal.norm() > 0.0)) return std::nullopt;
    q_P -= 0.8 * distance * normal;  // damped: the normal changes abruptly at edges of the skin
  }
  return std::nullopt;
}

TaskReadiness check_task_and_paths(const Task& general, const anatomy::VirtualPatient& patient, const Needle& needle,
                                   const Progress& progress) {
  const Task task = fit_to_patient(general, patient);
  TaskReadiness readiness = check_task(task, patient);
  if (!readiness.is_possible) return readiness;
  const auto paths = plan_paths(task, patient, needle, {}, progress);
  if (paths) {
    const anatomy::Posture posture = paths->front().posture;
    if (posture == patient.posture) return readiness;
    readiness.posture = posture;
    readiness.reasons.push_back(fmt::format("done with the patient {}, who is {} in the scan",
                                            anatomy::posture_words(posture), anatomy::posture_words(patient.posture)));
    return readiness;
  }
  readiness.is_possible = false;
  readiness.reasons.push_back(paths.error().what);
  return readiness;
}

}  // namespace trocar::tasks
