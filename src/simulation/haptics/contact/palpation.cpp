#include "haptics/contact/palpation.h"

#include <array>

#include "haptics/contact/contact_column.h"
#include "haptics/insertion/skin_contact.h"

namespace trocar::haptics {
namespace {

/// The points of a fingertip's face and the tissue under them.
class Fingertip {
 public:
  Fingertip(const PatientNow& now, const Vec3& skin_P, const Vec3& along_P) noexcept : count_(now.scene.face.count) {
    const HapticScene& scene = now.scene;
    // The finger's frame: y into the body.
    Mat3 R_PT;
    R_PT.col(1) = along_P;
    R_PT.col(0) = along_P.unitOrthogonal();
    R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
    for (std::size_t n = 0; n < static_cast<std::size_t>(count_); ++n) {
      const Vec3& point_T = scene.face.point_T[n];
      const Vec3 beside_P = skin_P + R_PT * Vec3(point_T.x(), 0.0, point_T.z());
      const double off_skin_mm = skin_distance_mm(now, beside_P);
      Point& point = points_[n];
      point.before_mm = off_skin_mm - point_T.y();
      point.area_mm2 = scene.face.area_mm2[n] * scene.face.normal_T[n].y();
      point.column = tissue_column(now, beside_P + off_skin_mm * along_P, along_P);
    }
  }

  /// Force and its slope.
  ColumnResponse respond_to(double pressed_mm) const noexcept {
    ColumnResponse all;
    for (std::size_t n = 0; n < static_cast<std::size_t>(count_); ++n) {
      const ColumnResponse one = respond(points_[n].column, pressed_mm - points_[n].before_mm);
      all.pressure += points_[n].area_mm2 * one.pressure;
      all.tangent += points_[n].area_mm2 * one.tangent;
    }
    return all;
  }

 private:
  struct Point {
    double before_mm = 0.0;  ///< Press at which it touches the skin.
    double area_mm2 = 0.0;   ///< Across the press.
    TissueColumn column;
  };
  int count_;
  std::array<Point, kMaxContactPoints> points_{};
};

bool is_place(const Vec3& skin_P, const Vec3& inward_P) noexcept {
  return skin_P.allFinite() && inward_P.allFinite() && inward_P.norm() > 0.0;
}

Palpation felt_at(const PatientNow& now, const Vec3& skin_P, const Vec3& along_P, const Fingertip& finger,
                  double pressed_mm) noexcept {
  const ColumnResponse response = finger.respond_to(pressed_mm);
  Palpation felt{response.pressure, pressed_mm, response.tangent, {}};
  const TissueColumn middle = tissue_column(now, skin_P, along_P);
  if (middle.length_mm < kColumn_mm) felt.bone_mm = middle.length_mm;
  return felt;
}

}  // namespace

Palpation press(const PatientNow& now, const Vec3& skin_P, const Vec3& inward_P, double pressed_mm) noexcept {
  if (!is_place(skin_P, inward_P) || !(pressed_mm > 0.0)) return {};
  const Vec3 along_P = inward_P.normalized();
  return felt_at(now, skin_P, along_P, Fingertip(now, skin_P, along_P), pressed_mm);
}

Palpation palpate(const PatientNow& now, const Vec3& skin_P, const Vec3& inward_P, double force_n) noexcept {
  if (!is_place(skin_P, inward_P) || !(force_n > 0.0)) return {};
  constexpr int kHalvings = 12;  // 0.01 mm
  const Vec3 along_P = inward_P.normalized();
  const Fingertip finger(now, skin_P, along_P);
  double low_mm = 0.0, high_mm = kColumn_mm;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle_mm = 0.5 * (low_mm + high_mm);
    (finger.respond_to(middle_mm).pressure < force_n ? low_mm : high_mm) = middle_mm;
  }
  return felt_at(now, skin_P, along_P, finger, 0.5 * (low_mm + high_mm));
}

Hardness hardness_of(const Palpation& palpation) noexcept {
  if (palpation.stiffness_n_per_mm >= kHard_n_per_mm) return Hardness::kHard;
  return palpation.stiffness_n_per_mm >= kFirm_n_per_mm ? Hardness::kFirm : Hardness::kSoft;
}

}  // namespace trocar::haptics
