#include "ultrasound/live/scan_request.h"

#include <algorithm>
#include <cmath>

namespace trocar::ultrasound {
namespace {

constexpr double kLeastDepth_mm = 20.0;
constexpr double kLeastFocus_mm = 5.0;
constexpr int kLeastSide = 16, kMostSide = 2048;
/// Lever for rotations of the transducer: half a usual face wide, half an image deep.
constexpr double kLever_mm = 60.0;

double held_between(double value, double low, double high, double fallback) noexcept {
  return std::isfinite(value) ? std::clamp(value, low, high) : std::clamp(fallback, low, high);
}

Acquisition within_ranges(const Acquisition& wanted, const Transducer& transducer) noexcept {
  Acquisition a = wanted;
  a.depth_mm = held_between(wanted.depth_mm, kLeastDepth_mm, transducer.greatest_depth_mm, transducer.depth_mm);
  a.frequency_mhz =
      held_between(wanted.frequency_mhz, transducer.lowest_mhz, transducer.highest_mhz, transducer.frequency_mhz);
  const auto harmonic = wanted.is_harmonic ? harmonic_mhz(transducer, a.frequency_mhz) : std::nullopt;
  a.is_harmonic = harmonic.has_value();
  if (harmonic) a.frequency_mhz = *harmonic;
  a.focus_mm = held_between(wanted.focus_mm, kLeastFocus_mm, a.depth_mm, transducer.focus_mm);
  a.lines = std::clamp(wanted.lines, 16, 1024);
  a.samples = std::clamp(wanted.samples, 64, 4096);
  a.steering_angles = std::clamp(wanted.steering_angles, 1, 5);
  a.planes = std::clamp(wanted.planes, 1, 9) | 1;
  a.scatterers = held_between(wanted.scatterers, 1.0, 4.0, 4.0);
  return a;
}

bool is_near(const Vec3& a, const Vec3& b, double tolerance_mm) noexcept {
  return (a - b).squaredNorm() <= tolerance_mm * tolerance_mm;
}

}  // namespace

ScanRequest within_ranges(const ScanRequest& request, const Transducer& transducer) {
  ScanRequest r = request;
  r.acquisition = within_ranges(request.acquisition, transducer);
  r.display = within_ranges(request.display);
  r.doppler = within_ranges(request.doppler);
  r.needle_diameter_mm = held_between(request.needle_diameter_mm, 0.2, 5.0, 1.2);
  r.needle_bore_share = held_between(request.needle_bore_share, 0.0, 0.9, 0.0);
  r.tip_shift_mm = held_between(request.tip_shift_mm, -10.0, 10.0, 0.0);
  r.renewed_share = held_between(request.renewed_share, 0.05, 1.0, 1.0);
  r.columns = std::clamp(request.columns, kLeastSide, kMostSide);
  r.rows = std::clamp(request.rows, kLeastSide, kMostSide);
  return r;
}

bool has_same_settings(const ScanRequest& a, const ScanRequest& b) noexcept {
  return a.acquisition == b.acquisition && a.panorama == b.panorama && a.display == b.display && a.flow == b.flow &&
         (!a.flow || a.doppler == b.doppler) && a.columns == b.columns && a.rows == b.rows;
}

bool is_equivalent(const ScanRequest& a, const ScanRequest& b, double tolerance_mm) noexcept {
  if (!has_same_settings(a, b)) return false;
  if (a.needle_diameter_mm != b.needle_diameter_mm || a.needle_bore_share != b.needle_bore_share) return false;
  if (a.motion.most_shift_mm(b.motion) > tolerance_mm) return false;
  if (std::abs(a.tip_shift_mm - b.tip_shift_mm) > tolerance_mm) return false;
  for (const Vec3& p_T : {Vec3(0.0, 0.0, 0.0), Vec3(kLever_mm, 0.0, 0.0), Vec3(0.0, kLever_mm, 0.0)})
    if (!is_near(a.X_PT * p_T, b.X_PT * p_T, tolerance_mm)) return false;
  return std::equal(a.needle_shaft_P.begin(), a.needle_shaft_P.end(), b.needle_shaft_P.begin(), b.needle_shaft_P.end(),
                    [&](const Vec3& p, const Vec3& q) { return is_near(p, q, tolerance_mm); });
}

}  // namespace trocar::ultrasound
