#include "metrics/metric.h"

#include <array>
#include <cmath>

#include "metrics/measures/groups.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics {

Moment moment_of(const telemetry::TickSample& sample) {
  Moment moment;
  moment.time_s = sample.time_s;
  moment.tip_P = sample.tip_mm;
  moment.axis_P = sample.axis;
  moment.rest_tip_A = sample.rest_tip_mm;
  moment.rest_axis_A = sample.rest_axis;
  moment.R_PN = telemetry::felt_needle(sample).R();
  moment.depth_mm = sample.depth_mm;
  moment.phase = sample.phase;
  moment.events = sample.events;
  moment.resistance_n = telemetry::axial_resistance_n(sample);
  moment.pressed_mm = (sample.rest_tip_mm - telemetry::pierced_rest_tip_mm(sample)).norm();
  return moment;
}

motion::PatientMotion recorded_motion(const motion::MotionModel* model, const telemetry::TickSample& sample) noexcept {
  const auto& [first, second, first_per_s, second_per_s] = sample.drivers;
  motion::MotionState state;
  state.time_s = sample.time_s;
  state.phase = sample.breathing;
  state.is_breath_held = sample.is_breath_held;
  state.drivers = {first, second};
  state.rates_per_s = {first_per_s, second_per_s};
  const motion::PatientMotion motion(model, state);
  return motion.is_finite() ? motion : motion::PatientMotion();
}

namespace {

constexpr double kBeamStep_mm = 0.5;
constexpr double kBefore_mm = 1.0;  // the point's own surface does not hide it

}  // namespace

const anatomy::Label* find_shadow(const anatomy::VirtualPatient& patient, const motion::PatientMotion& motion,
                                  const ImagePlane& plane, const Pose& X_PT, const Vec3& p_P) {
  const Vec3 p_T = X_PT.inverse() * p_P;
  const Vec3 in_plane_T(p_T.x(), p_T.y(), 0.0);
  // Parallel scanlines begin above the point; those of a fan at the face, on the line to its virtual apex.
  Vec3 face_T(p_T.x(), 0.0, 0.0);
  if (plane.field_of_view_rad > 0.0) {
    const Vec3 apex_T(0.0, -plane.radius_mm, 0.0);
    face_T = apex_T + plane.radius_mm * (in_plane_T - apex_T).normalized();
  }
  const Vec3 way_T = in_plane_T - face_T;
  for (double at_mm = 0.0; at_mm < way_T.norm() - kBefore_mm; at_mm += kBeamStep_mm) {
    const anatomy::Label* const label =
        anatomy::find_label(patient, motion.to_rest(X_PT * (face_T + at_mm * way_T.normalized())));
    if (label != nullptr && (label->tissue == "bone" || label->tissue == "lung" || label->tissue == "gas"))
      return label;
  }
  return nullptr;
}

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
