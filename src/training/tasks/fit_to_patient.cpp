#include "tasks/fit_to_patient.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/pose.h"
#include "tasks/assess_path.h"
#include "tasks/detail/block_grid.h"
#include "tasks/detail/path_check.h"

namespace trocar::tasks {
namespace {

constexpr double kSkinStep_mm = 1.0;        // over the skin
constexpr double kLandmarkReach_mm = 30.0;  // from a landmark to the skin over it

std::optional<EntryZone> find_zone(const LandmarkZone& zone, const anatomy::VirtualPatient& patient) {
  const anatomy::Landmark* const landmark = find_landmark(patient, zone.landmark);
  if (landmark == nullptr || patient.skin_distance_mm.empty()) return std::nullopt;
  const auto on_skin_P = find_nearest_skin(patient, landmark->p_P, kLandmarkReach_mm);
  if (!on_skin_P) return std::nullopt;
  const auto raised_P = walk_on_skin(patient, *on_skin_P, Vec3::UnitZ(), zone.cranial_mm);
  if (!raised_P) return std::nullopt;
  const Vec3 medial_P = zone.landmark.starts_with("left ") ? Vec3(-Vec3::UnitX()) : Vec3::UnitX();  // LPS: +x is left
  const auto centre_P = walk_on_skin(patient, *raised_P, medial_P, zone.medial_mm);
  if (!centre_P) return std::nullopt;
  return EntryZone{*centre_P, zone.radius_mm};
}

const anatomy::Label* find_finding(const Task& task, const anatomy::VirtualPatient& patient) {
  if (!task.target_label.empty() || task.target_P) return nullptr;
  const auto is_possible = [&](const anatomy::Label& label) { return is_target(task, label); };
  if (std::ranges::count_if(patient.label_table.labels, is_possible) < 2) return nullptr;
  const auto path = std::ranges::find_if(
      patient.paths, [&](const anatomy::NeedlePath& one) { return one.name.starts_with(task.name + ": "); });
  const anatomy::Label* const label =
      path != patient.paths.end() ? anatomy::find_label(patient, path->line_P.b) : nullptr;
  return label != nullptr && is_possible(*label) ? label : nullptr;
}

}  // namespace

const anatomy::Landmark* find_landmark(const anatomy::VirtualPatient& patient, std::string_view name) noexcept {
  const auto found = std::ranges::find(patient.landmarks, name, &anatomy::Landmark::name);
  return found != patient.landmarks.end() ? &*found : nullptr;
}

std::optional<Vec3> walk_on_skin(const anatomy::VirtualPatient& patient, const Vec3& from_P, const Vec3& towards_P,
                                 double distance_mm) {
  const Vec3 direction_P = distance_mm < 0.0 ? Vec3(-towards_P) : towards_P;
  const int steps = static_cast<int>(std::ceil(std::abs(distance_mm) / kSkinStep_mm));
  Vec3 p_P = from_P;
  for (int n = 0; n < steps; ++n) {
    const Vec3 normal_P = detail::skin_normal(patient.skin_distance_mm, p_P);
    const Vec3 along_P = direction_P - direction_P.dot(normal_P) * normal_P;
    if (!(along_P.norm() > 0.0)) return std::nullopt;
    const auto next_P = find_nearest_skin(patient, p_P + std::abs(distance_mm) / steps * along_P.normalized());
    if (!next_P) return std::nullopt;
    p_P = *next_P;
  }
  return p_P;
}

Task fit_to_patient(Task task, const anatomy::VirtualPatient& patient) {
  if (task.landmark_zone && !task.entry_zone) task.entry_zone = find_zone(*task.landmark_zone, patient);
  if (const anatomy::Label* const finding = find_finding(task, patient)) task.target_label = finding->name;
  return task;
}

bool is_path_for(const Task& task, const anatomy::NeedlePath& path) {
  return path.name.starts_with(task.name + ": ") &&
         (!task.entry_zone || task.entry_zone->distance_outside_mm(path.line_P.a) <= 0.0);
}

std::vector<std::string> unserved_rules(const Task& task, const anatomy::VirtualPatient& patient) {
  std::vector<std::string> rules;
  const auto lacks_landmark = [&](const std::string& name) { return find_landmark(patient, name) == nullptr; };
  const auto lacks_structure = [&](const std::string& name) {
    return std::ranges::none_of(patient.label_table.labels, [&](const anatomy::Label& label) {
      return label.name == name || label.tissue == name;
    });
  };
  if (task.landmark_zone && !task.entry_zone && lacks_landmark(task.landmark_zone->landmark))
    rules.push_back(fmt::format("there is no landmark \"{}\": the entry is not judged", task.landmark_zone->landmark));
  if (!task.target_away_from.empty() && lacks_landmark(task.target_away_from))
    rules.push_back(
        fmt::format("there is no landmark \"{}\": the distance from it is not judged", task.target_away_from));
  if (task.highest_entry && lacks_structure(task.highest_entry->above))
    rules.push_back(fmt::format("{} is not labelled: the level of the entry is not judged", task.highest_entry->above));
  if (task.bevel && lacks_structure(task.bevel->fibres))
    rules.push_back(fmt::format("{} is not labelled: the bevel is not judged", task.bevel->fibres));
  return rules;
}

std::vector<anatomy::Posture> postures_to_try(const Task& task, const anatomy::VirtualPatient& patient) {
  if (task.posture) return {*task.posture};
  if (task.postures.empty()) return {patient.posture};
  std::vector<anatomy::Posture> postures = task.postures;
  const auto own = std::ranges::find(postures, patient.posture);
  if (own != postures.end()) std::rotate(postures.begin(), own, own + 1);
  return postures;
}

anatomy::Posture posture_of(const Task& task, const anatomy::VirtualPatient& patient) {
  return postures_to_try(task, patient).front();
}

std::vector<std::string> allowed_needles(const Task& task, const std::vector<Needle>& all) {
  std::vector<std::string> allowed{task.needle};
  const auto add = [&](const std::string& name) {
    if (name != task.needle) allowed.push_back(name);
  };
  for (const std::string& name : task.needles) add(name);
  if (!task.needles.empty()) return allowed;
  for (const Needle& needle : needles_like(all, task.needle)) add(needle.name);
  return allowed;
}

TaskLabels::TaskLabels(const Task& task, const anatomy::VirtualPatient& patient) {
  const auto& labels = patient.label_table.labels;
  is_parenchymal_ = trocar::tasks::is_parenchymal(task, patient);
  for (const anatomy::Label& label : labels) {
    if (is_target(task, label)) {
      parts_[label.id] = Part::kTarget;
    } else if (is_organ(task, label)) {
      parts_[label.id] = is_parenchymal_ ? Part::kTarget : Part::kOrgan;
    } else if (label.tissue == "vessel") {
      parts_[label.id] = Part::kVessel;
    }
    risks_[label.id] = find_risk(task, label);
    harms_[label.id] = find_harm(task, label).grade;
    is_bone_[label.id] = label.tissue == "bone";
  }
}

namespace {

constexpr double kReach_mm = 15.0;  // of the structure above and below the point, and to its sides
constexpr double kLeast_mm = 5.0;   // between the two centres
constexpr double kLeast = 1e-6;

}  // namespace

std::optional<Vec3> find_fibres(const Task& task, const anatomy::VirtualPatient& patient, const Vec3& near_P) {
  if (!task.bevel) return std::nullopt;
  std::array<bool, 256> is_along{};
  for (const anatomy::Label& label : patient.label_table.labels)
    is_along[label.id] = label.tissue == task.bevel->fibres || label.name == task.bevel->fibres;
  const volume::LabelGrid& labels = patient.labels;
  const detail::IndexBox box = detail::clipped(detail::box_around(labels.geometry, near_P, kReach_mm), labels.geometry);
  std::vector<Vec3> points_P;
  Vec3 middle_P = Vec3::Zero();
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) {
        if (!is_along[labels[{i, j, k}]]) continue;
        points_P.push_back(labels.geometry.centre_mm({i, j, k}));
        middle_P += points_P.back();
      }
  middle_P /= std::max<double>(1.0, static_cast<double>(points_P.size()));
  std::array<Vec3, 2> sum{Vec3::Zero(), Vec3::Zero()};  // below and above the middle: the scan may end near the point
  std::array<double, 2> count{};
  for (const Vec3& p_P : points_P) {
    const std::size_t half = p_P.z() < middle_P.z() ? 0 : 1;
    sum[half] += p_P;
    count[half] += 1.0;
  }
  if (count[0] < 1.0 || count[1] < 1.0) return std::nullopt;
  const Vec3 up_P = sum[1] / count[1] - sum[0] / count[0];
  if (up_P.norm() < kLeast_mm) return std::nullopt;
  return up_P.normalized();
}

double bevel_to_fibres_deg(const Mat3& R_PN, const Vec3& fibres_P) noexcept {
  const Vec3 across_P = fibres_P - fibres_P.dot(R_PN.col(2)) * R_PN.col(2);
  if (!(across_P.norm() > kLeast)) return 0.0;
  const double sine = std::abs(R_PN.col(1).dot(across_P.normalized()));
  return degrees(std::asin(std::min(sine, 1.0)));
}

Vec3 bevel_across_fibres_P(const Vec3& axis_P, const Vec3& fibres_P) noexcept {
  const Vec3 face_P = fibres_P.cross(axis_P);
  if (!(face_P.norm() > kLeast)) return axis_P.unitOrthogonal();
  return face_P.x() < 0.0 ? Vec3(-face_P.normalized()) : Vec3(face_P.normalized());
}

std::optional<Vec3> planned_bevel_P(const Task& task, const anatomy::VirtualPatient& patient, const Segment& path_P) {
  const auto fibres_P = find_fibres(task, patient, path_P.b);
  if (!fibres_P) return std::nullopt;
  return bevel_across_fibres_P(path_P.direction(), *fibres_P);
}

Mat3 needle_rotation(const Vec3& axis_P, const Vec3& bevel_P) noexcept {
  const Vec3 z_P = axis_P.normalized();
  const Vec3 y_P = bevel_P - bevel_P.dot(z_P) * z_P;
  if (!(y_P.norm() > kLeast)) return needle_pose(Vec3::Zero(), z_P).R();
  Mat3 R_PN;
  R_PN.col(2) = z_P;
  R_PN.col(1) = y_P.normalized();
  R_PN.col(0) = R_PN.col(1).cross(z_P);
  return R_PN;
}

}  // namespace trocar::tasks
