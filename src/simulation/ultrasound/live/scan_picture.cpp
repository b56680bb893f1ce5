#include "ultrasound/live/scan_picture.h"

#include <algorithm>
#include <cmath>

#include "core/result.h"
#include "ultrasound/probe/probe_contact.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

/// Two neighbours and the weight of the second, of 256.
struct WeightedNeighbours {
  std::size_t low, high;
  unsigned part;
};

WeightedNeighbours weighted_neighbours(double place, int count) noexcept {
  const volume::Neighbours n = volume::neighbours(place, count);
  return {static_cast<std::size_t>(n.low), static_cast<std::size_t>(n.high), static_cast<unsigned>(256.0 * n.share)};
}

}  // namespace

Vec2 shown_place_T(const ScanPicture& picture, const Vec3& p_P) noexcept {
  const Vec3 p_T = picture.X_PT.inverse() * p_P;
  const Vec2 rest_T(p_T.x(), p_T.y());
  if (picture.pressed_mm.empty()) return rest_T;
  const Polar rest = picture.scan.to_polar(rest_T);
  const auto last = static_cast<double>(picture.pressed_mm.size() - 1);
  if (!std::isfinite(rest.line)) return rest_T;
  const double line = std::clamp(rest.line / std::max(1, picture.scan.lines - 1), 0.0, 1.0) * last;
  const auto pressed_mm = static_cast<double>(picture.pressed_mm[static_cast<std::size_t>(std::lround(line))]);
  if (rest.depth_mm <= -pressed_mm) return rest_T;
  return picture.scan.to_cartesian({rest.line, pressed_depth_mm(rest.depth_mm, pressed_mm, picture.dent_reach_mm)});
}

void resample_levels(std::span<const std::uint8_t> from, const ScanGeometry& from_scan, const ScanGeometry& to_scan,
                     std::vector<std::uint8_t>& to) {
  const auto from_samples = static_cast<std::size_t>(from_scan.samples);
  const auto samples = static_cast<std::size_t>(to_scan.samples);
  TROCAR_CHECK(from.size() == static_cast<std::size_t>(from_scan.lines) * from_samples);
  to.resize(static_cast<std::size_t>(to_scan.lines) * samples);
  std::vector<WeightedNeighbours> along(samples);
  for (std::size_t s = 0; s < samples; ++s) {
    const double depth = (static_cast<double>(s) + 0.5) / static_cast<double>(samples);
    along[s] = weighted_neighbours(depth * from_scan.samples - 0.5, from_scan.samples);
  }
  for (int line = 0; line < to_scan.lines; ++line) {
    const double share = static_cast<double>(line) / (to_scan.lines - 1);
    const WeightedNeighbours across = weighted_neighbours(share * (from_scan.lines - 1), from_scan.lines);
    const std::uint8_t* const a = from.data() + across.low * from_samples;
    const std::uint8_t* const b = from.data() + across.high * from_samples;
    std::uint8_t* const target = to.data() + static_cast<std::size_t>(line) * samples;
    for (std::size_t s = 0; s < samples; ++s) {
      const WeightedNeighbours& n = along[s];
      const unsigned near = a[n.low] * (256U - across.part) + b[n.low] * across.part;
      const unsigned far = a[n.high] * (256U - across.part) + b[n.high] * across.part;
      target[s] = static_cast<std::uint8_t>((near * (256U - n.part) + far * n.part + 0x8000U) >> 16);
    }
  }
}

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

namespace {

/// Nominal work of a frame, in samples: constant work (contact, scan conversion), and work for every sample, elevation
/// plane and steering angle. Measured with `trocar bench ultrasound-cost`; FrameCost learns the difference.
constexpr double kWorkOfFrame = 0.8e6, kWorkOfSample = 1.0, kWorkOfPlane = 1.0, kWorkOfAngle = 0.6;

}  // namespace

Acquisition with_detail(const Acquisition& full, ScanDetail detail) noexcept {
  if (detail == ScanDetail::kFull) return full;
  const bool is_middle = detail == ScanDetail::kMiddle;
  Acquisition a = full;
  a.lines = std::max(16, is_middle ? full.lines * 3 / 4 : full.lines / 2);
  a.samples = std::max(64, is_middle ? full.samples * 3 / 4 : full.samples / 2);
  a.lines = std::min(a.lines, full.lines);
  a.samples = std::min(a.samples, full.samples);
  // A single plane makes borders too bright and sharp, and saves little time.
  a.planes = std::min(full.planes, 3);
  a.steering_angles = is_middle ? full.steering_angles : 1;
  a.scatterers = std::min(full.scatterers, is_middle ? 3.0 : 2.0);
  return a;
}

double ScanLevels::work(const ScanRequest& request, ScanDetail detail) const noexcept {
  const Acquisition a = with_detail(request.acquisition, detail);
  return kWorkOfFrame + a.lines * static_cast<double>(a.samples) *
                            (kWorkOfSample + kWorkOfPlane * a.planes + kWorkOfAngle * a.steering_angles);
}

}  // namespace trocar::ultrasound
