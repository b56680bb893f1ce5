#include "ultrasound/live/scan_picture.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound {
namespace {

/// Two neighbours and the weight of the second, of 256.
struct WeightedNeighbours {
  std::size_t low, high;
  unsigned part;
};

WeightedNeighbours weighted_neighbours(double place, int count) noexcept {
  const double held = std::clamp(place, 0.0, static_cast<double>(count - 1));
  const auto low = static_cast<std::size_t>(held);
  return {low, std::min(low + 1, static_cast<std::size_t>(count - 1)),
          static_cast<unsigned>(256.0 * (held - static_cast<double>(low)))};
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

}  // namespace trocar::ultrasound
