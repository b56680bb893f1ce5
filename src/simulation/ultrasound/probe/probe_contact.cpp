#include "ultrasound/probe/probe_contact.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ultrasound/tissue/acoustic_scene.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

constexpr int kMaxSteps = 24;
constexpr double kContactTolerance_mm = 0.02;

// Assumed: half of an indentation is within the fat if that is 20 mm thick.
constexpr double kReachWithoutFat_mm = 24.0;
constexpr double kReachOfFat = 0.8;
constexpr double kLeastContactReach_mm = 12.0;
constexpr double kGreatestContactReach_mm = 48.0;
/// A larger impedance is bone (6 MRayl or more; cartilage and muscle have less than 2.5).
constexpr double kRigid_mrayl = 3.0;
constexpr int kReachLines = 9;

/// Distance from p to the skin along a unit direction, at most `farthest_mm`: the signed distance never exceeds it, so
/// steps of that length approach the skin without passing it; shorter ones where motion may have compressed it.
double distance_to_skin_mm(const volume::FloatGrid& skin_distance_mm, const motion::PatientMotion& motion,
                           const Vec3& p_P, const Vec3& direction_P, double sign, double farthest_mm) noexcept {
  const double step_share = motion.is_rest() ? 1.0 : 0.6;
  double way_mm = 0.0;
  for (int step = 0; step < kMaxSteps && way_mm < farthest_mm; ++step) {
    const double left_mm = sign * sample_linear(skin_distance_mm, motion.to_rest(p_P + way_mm * direction_P));
    if (!(left_mm > kContactTolerance_mm)) break;  // also NaN
    way_mm += step_share * left_mm;
  }
  return std::min(way_mm, farthest_mm);
}

struct Scanline {
  Vec3 origin_P;
  Vec3 direction_P;
};

Scanline scanline(const ScanGeometry& geometry, const Pose& X_PT, double line) noexcept {
  const Vec2 origin = geometry.line_origin(line);
  const Vec2 direction = geometry.line_direction(line);
  return {X_PT * Vec3(origin.x(), origin.y(), 0.0), X_PT.R() * Vec3(direction.x(), direction.y(), 0.0)};
}

/// Tissue at a point; air outside the grid.
std::uint8_t tissue_at(const AcousticScene& scene, const Vec3& p_P) noexcept {
  const Vec3 index = scene.geometry.to_index(p_P);
  if (!index.allFinite() || index.cwiseAbs().maxCoeff() > 1e6) return 0;
  const auto nearest = [](double v) { return static_cast<std::int64_t>(std::floor(v + 0.5)); };
  const volume::Index3 ijk{nearest(index.x()), nearest(index.y()), nearest(index.z())};
  if (!scene.geometry.contains(ijk)) return 0;
  return static_cast<std::uint8_t>(scene.tissue[scene.geometry.offset(ijk)] & ~kMixedCell);
}

/// Depth of the indented tissue under one scanline.
double line_reach_mm(const AcousticScene& scene, const motion::PatientMotion& motion, std::uint8_t fat,
                     const Scanline& line) noexcept {
  constexpr double kStep_mm = 1.0;
  double fat_mm = 0.0;
  double depth_mm = 0.0;
  for (; depth_mm < kGreatestContactReach_mm; depth_mm += kStep_mm) {
    const std::uint8_t tissue = tissue_at(scene, motion.to_rest(line.origin_P + depth_mm * line.direction_P));
    if (tissue < scene.table.tissues.size() && scene.table.tissues[tissue].impedance_mrayl() > kRigid_mrayl) break;
    if (tissue == fat) fat_mm += kStep_mm;
  }
  return std::clamp(std::min(depth_mm, kReachWithoutFat_mm + kReachOfFat * fat_mm), kLeastContactReach_mm,
                    kGreatestContactReach_mm);
}

}  // namespace

float gap_coupling(float gap_mm) noexcept {
  constexpr auto kFills = static_cast<float>(kGelFills_mm);
  constexpr auto kEnds = static_cast<float>(kGelEnds_mm);
  const float t = std::clamp((gap_mm - kFills) / (kEnds - kFills), 0.0F, 1.0F);
  return 1.0F - t * t * (3.0F - 2.0F * t);
}

void find_contact(const volume::FloatGrid& skin_distance_mm, const ScanGeometry& geometry, const Pose& X_PT,
                  std::span<LineContact> contact, int first_line, const motion::PatientMotion& motion) noexcept {
  const bool has_skin = !skin_distance_mm.empty() && X_PT.is_finite();
  const std::size_t lines =
      std::min(contact.size(), static_cast<std::size_t>(std::max(geometry.lines - first_line, 0)));
  for (std::size_t n = 0; n < lines; ++n) {
    LineContact& line_contact = contact[n];
    line_contact = {};
    if (!has_skin) continue;
    const Scanline line = scanline(geometry, X_PT, static_cast<double>(n) + first_line);
    if (sample_linear(skin_distance_mm, motion.to_rest(line.origin_P)) < 0.0) {
      line_contact.pressed_mm = static_cast<float>(
          distance_to_skin_mm(skin_distance_mm, motion, line.origin_P, -line.direction_P, -1.0, kDeepestDent_mm));
    } else {
      line_contact.gap_mm = static_cast<float>(
          distance_to_skin_mm(skin_distance_mm, motion, line.origin_P, line.direction_P, 1.0, kWidestGap_mm));
      line_contact.coupling = gap_coupling(line_contact.gap_mm);
    }
  }
}

double pressed_depth_mm(double rest_depth_mm, double pressed_mm, double reach_mm) noexcept {
  if (rest_depth_mm >= reach_mm) return rest_depth_mm;
  // r - p (1 - r/L)² = rest is p/L² r² - (1 + 2 p/L) r + (p + rest) = 0; the smaller root, in the form without
  // cancellation. Its discriminant is at least 1.
  const double share = pressed_mm / reach_mm;
  const double half_b = 1.0 + 2.0 * share;
  const double c = pressed_mm + rest_depth_mm;
  const double discriminant = std::max(half_b * half_b - 4.0 * share * c / reach_mm, 0.0);
  return 2.0 * c / (half_b + std::sqrt(discriminant));
}

double find_dent_reach_mm(const AcousticScene& scene, const ScanGeometry& geometry, const Pose& X_PT,
                          const motion::PatientMotion& motion) noexcept {
  const std::uint8_t fat = scene.table.find("adipose").value_or(0xFF);
  double sum_mm = 0.0;
  for (int n = 0; n < kReachLines; ++n) {
    const double line = (0.5 + n) / kReachLines * (geometry.lines - 1);
    sum_mm += line_reach_mm(scene, motion, fat, scanline(geometry, X_PT, line));
  }
  return sum_mm / kReachLines;
}

namespace {

constexpr double kGreatestTilt = radians(15.0);  ///< In the image plane, to improve the contact.
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
