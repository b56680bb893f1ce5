#include "ultrasound/probe/face_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ultrasound/probe/probe_contact.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

constexpr double kGreatestTilt = 15.0 * std::numbers::pi / 180.0;  ///< In the image plane, to improve the contact.
constexpr double kPressStep_mm = 0.5;
constexpr double kTouchingShare = 0.97;  ///< Required share of scanlines with contact.

Pose tilted(const Vec3& skin_P, const Mat3& R_PT, double tilt) {
  return {R_PT * Mat3(Eigen::AngleAxisd(tilt, Vec3::UnitZ())), skin_P};
}

Pose lay_along(const volume::FloatGrid& skin_distance_mm, const ScanGeometry& scan, const Vec3& skin_P,
               const Mat3& R_PT) {
  double tilt = 0.0;
  for (int round = 0; round < 4; ++round) {
    const Pose X_PT = tilted(skin_P, R_PT, tilt);
    double sum_xx = 0.0;
    double sum_xd = 0.0;
    for (int n = 0; n < scan.lines; ++n) {
      const Vec2 at_T = scan.line_origin(n);
      sum_xx += at_T.x() * at_T.x();
      sum_xd += at_T.x() * -volume::sample_linear(skin_distance_mm, X_PT * Vec3(at_T.x(), at_T.y(), 0.0));
    }
    if (sum_xx <= 0.0) break;  // a phased array: all scanlines start at one point
    tilt = std::clamp(tilt - std::atan(sum_xd / sum_xx), -kGreatestTilt, kGreatestTilt);
  }
  return tilted(skin_P, R_PT, tilt);
}

}  // namespace

FaceFit fit_face(const volume::FloatGrid& skin_distance_mm, const ScanGeometry& scan, const Vec3& skin_P,
                 const Mat3& R_PT, double pressed_mm) {
  const Pose on_skin = lay_along(skin_distance_mm, scan, skin_P, R_PT);
  std::vector<LineContact> contact(static_cast<std::size_t>(scan.lines));
  FaceFit fit;
  for (double press_mm = pressed_mm;; press_mm += kPressStep_mm) {
    fit.X_PT = {on_skin.R(), on_skin.p() + press_mm * on_skin.R().col(1)};
    find_contact(skin_distance_mm, scan, fit.X_PT, contact);
    const auto touching =
        std::count_if(contact.begin(), contact.end(), [](const LineContact& c) { return c.coupling > 0.5F; });
    fit.touching = static_cast<double>(touching) / scan.lines;
    fit.dent_mm = 0.0;
    for (const LineContact& line : contact) fit.dent_mm = std::max<double>(fit.dent_mm, line.pressed_mm);
    if (fit.touching >= kTouchingShare || press_mm + kPressStep_mm > kGreatestFitPress_mm) return fit;
  }
}

}  // namespace trocar::ultrasound
