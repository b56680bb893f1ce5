#pragma once

#include "anatomy/patient.h"
#include "geometry/shapes.h"
#include "motion/patient_motion.h"

namespace trocar::anatomy {

/// The skin where it is now. Frame P, mm; the patient outlives it. Real-time safe.
class SkinNow {
 public:
  explicit SkinNow(const VirtualPatient& patient, const motion::PatientMotion& motion = {}) noexcept
      : patient_(&patient), motion_(motion) {}

  const motion::PatientMotion& motion() const noexcept { return motion_; }
  /// Signed distance of a point, negative inside the body: exact at rest, else to first order in the stretch.
  double distance_mm(const Vec3& p_P) const noexcept;
  /// Unit normal of the skin at a point, into the body; towards the back where there is none.
  Vec3 inward(const Vec3& p_P) const noexcept;
  /// The point of the skin nearest to a point that lies within some cm of it.
  Vec3 nearest(const Vec3& p_P) const noexcept;
  /// A path at rest, straight between its ends now.
  Segment path_now(const Segment& path_A) const noexcept {
    return {motion_.to_now(path_A.a), motion_.to_now(path_A.b)};
  }

 private:
  const VirtualPatient* patient_;
  motion::PatientMotion motion_;
};

}  // namespace trocar::anatomy
