#include "tasks/fit_to_patient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tasks/assess_path.h"
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

}  // namespace trocar::tasks
