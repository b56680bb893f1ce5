#include "metrics/shadow.h"

namespace trocar::metrics {
namespace {

constexpr double kBeamStep_mm = 0.5;
constexpr double kBefore_mm = 1.0;  // the point's own surface does not hide it

}  // namespace

const anatomy::Label* find_shadow(const anatomy::VirtualPatient& patient, const ImagePlane& plane, const Pose& X_PT,
                                  const Vec3& p_P) {
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
    const anatomy::Label* const label = anatomy::find_label(patient, X_PT * (face_T + at_mm * way_T.normalized()));
    if (label != nullptr && (label->tissue == "bone" || label->tissue == "lung" || label->tissue == "gas"))
      return label;
  }
  return nullptr;
}

}  // namespace trocar::metrics
