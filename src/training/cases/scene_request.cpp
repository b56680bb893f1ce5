#include "cases/scene_request.h"

#include <cmath>

namespace trocar::cases {

Pose room_in_patient(const Segment& path_P, double needle_length_mm) noexcept {
  Mat3 R_PW;
  R_PW.col(0) = -Vec3::UnitZ();  // LPS: +z is towards the head
  R_PW.col(1) = Vec3::UnitX();
  R_PW.col(2) = -Vec3::UnitY();
  const Vec3 way = path_P.b - path_P.a;
  const double length_mm = way.norm();
  const Vec3 direction = length_mm > 0.0 ? Vec3(way / length_mm) : Vec3::UnitY();
  return {R_PW, path_P.a + direction * (0.5 * length_mm - needle_length_mm)};
}

link::LoadScene scene_request(const Case& the_case, const SceneChoice& choice) {
  const haptics::NeedleGeometry needle = needle_geometry(the_case.needle);
  link::LoadScene request;
  request.task = the_case.task.name;
  request.patient = choice.patient_source;
  request.patient_seed = choice.patient_seed;
  request.patient_hash = the_case.patient->content_hash;
  request.motion_hash = anatomy::motion_hash(*the_case.patient);
  request.tool = choice.tool;
  request.needle_length_mm = needle.length_mm;
  request.needle_radius_mm = needle.radius_mm;
  request.needle_inner_radius_mm = needle.inner_radius_mm;
  request.needle_stylet_radius_mm = needle.stylet_radius_mm;
  request.needle_young_gpa = needle.young_gpa;
  request.needle_bevel_rad = needle.bevel_rad;
  request.needle_bevel_share = needle.bevel_share;
  request.force_model = choice.force_model.empty() ? the_case.task.force_model : choice.force_model;
  request.tissues_toml = the_case.tissues.to_toml();
  request.seed = choice.seed;
  request.X_PW = room_in_patient(the_case.plan.line_P, needle.length_mm);
  return request;
}

link::SetParameters tissue_parameters(const std::vector<anatomy::TissueSetting>& settings) {
  link::SetParameters parameters;
  parameters.tissues.emplace();
  for (const anatomy::TissueSetting& setting : settings) {
    const bool is_never = std::isinf(setting.value);
    parameters.tissues->push_back({setting.row, setting.key, is_never ? std::nullopt : std::optional(setting.value)});
  }
  return parameters;
}

haptics::NeedleGeometry needle_geometry(const tasks::Needle& needle) noexcept {
  haptics::NeedleGeometry geometry;
  geometry.radius_mm = 0.5 * needle.outer_diameter_mm;
  geometry.length_mm = needle.length_mm;
  geometry.inner_radius_mm = 0.5 * needle.inner_diameter_mm;
  geometry.stylet_radius_mm = 0.5 * needle.stylet_diameter_mm;
  geometry.bevel_rad = radians(needle.bevel_deg);
  geometry.bevel_share = needle.bevel_share;
  return geometry;
}

}  // namespace trocar::cases
