#include <array>
#include <cmath>

#include "metrics/measures/groups.h"

namespace trocar::metrics {

std::span<const MetricGroup> metric_groups() {
  static const std::array groups{
      end_position_metrics(),   curve_distance_metrics(), structure_metrics(), risk_metrics(),
      tip_path_metrics(),       tissue_path_metrics(),    insertion_metrics(), first_pass_metrics(),
      bevel_metrics(),          smoothness_metrics(),     action_metrics(),    force_metrics(),
      puncture_force_metrics(), transducer_metrics(),     contact_metrics(),   plane_metrics(),
      visibility_metrics(),     xray_metrics(),
  };
  return groups;
}

std::vector<MetricDescription> metric_catalogue() {
  std::vector<MetricDescription> all;
  for (const MetricGroup& group : metric_groups()) all.insert(all.end(), group.values.begin(), group.values.end());
  return all;
}

const char* reason_without(Role role) noexcept {
  switch (role) {
    case Role::kDepth:
      return "the recording has no depth and no patient was given";
    case Role::kEvents:
      return "the recording has no puncture events";
    case Role::kForce:
      return "the recording has no forces";
    case Role::kTransducer:
      return "the recording has no transducer";
    case Role::kContact:
      return "the recording has no contact force of the transducer and no patient was given";
    case Role::kXray:
      return "no X-ray was used";
    case Role::kTask:
      return "no task was given";
    case Role::kPatient:
      return "no patient was given";
    case Role::kExpert:
      return "no expert path was given";
    case Role::kPlane:
      return "the geometry of the image plane is not known";
    case Role::kRoll:
      return "the recording has no rotation of the needle about its axis";
  }
  return "";
}

double ImagePlane::slice_at_mm(double at_mm) const noexcept {
  if (!(elevation_focus_mm > 0.0)) return slice_mm;
  const double geometric_mm = elevation_mm * (1.0 - at_mm / elevation_focus_mm);
  return std::sqrt(slice_mm * slice_mm + geometric_mm * geometric_mm);
}

namespace {
/// Depth of a point along its scanline, from the face.
double scan_depth_mm(const ImagePlane& plane, const Vec3& p_T) noexcept {
  if (!(plane.field_of_view_rad > 0.0)) return p_T.y();
  const double y_mm = p_T.y() + plane.radius_mm;
  return std::sqrt(p_T.x() * p_T.x() + y_mm * y_mm) - plane.radius_mm;
}
}  // namespace

bool ImagePlane::is_in_field(const Vec3& p_T) const noexcept {
  const double at_mm = scan_depth_mm(*this, p_T);
  if (!(at_mm >= 0.0 && at_mm <= depth_mm)) return false;
  if (!(field_of_view_rad > 0.0)) return std::abs(p_T.x()) <= 0.5 * width_mm;
  return std::abs(std::atan2(p_T.x(), p_T.y() + radius_mm)) <= 0.5 * field_of_view_rad;
}

bool ImagePlane::is_visible(const Vec3& p_T) const noexcept {
  return std::abs(p_T.z()) <= 0.5 * slice_at_mm(scan_depth_mm(*this, p_T)) && is_in_field(p_T);
}

}  // namespace trocar::metrics
