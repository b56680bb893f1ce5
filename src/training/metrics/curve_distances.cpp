#include "metrics/curve_distances.h"

#include <array>

#include "metrics/detail/curve.h"

namespace trocar::metrics {
namespace {

constexpr std::size_t kPoints = 256;

/// The end of the needle's way; empty: it never was in the body.
std::optional<std::size_t> find_end(std::span<const telemetry::TickSample> samples, std::optional<std::size_t> fired) {
  if (fired && *fired < samples.size() && samples[*fired].depth_mm > 0.0) return fired;
  std::optional<std::size_t> end;
  for (std::size_t n = 0; n < samples.size(); ++n)
    if (samples[n].depth_mm > 0.0 && (!end || samples[n].depth_mm > samples[*end].depth_mm)) end = n;
  return end;
}

}  // namespace

CurveDistances curve_distances(std::span<const Vec3> way_P, const Segment& expert_P) {
  const std::array<Vec3, 2> ends_P{expert_P.a, expert_P.b};
  const std::vector<Vec3> a_P = detail::resample(way_P, kPoints), b_P = detail::resample(ends_P, kPoints);
  return {detail::frechet_mm(a_P, b_P), detail::hausdorff_mm(a_P, b_P), detail::warped_mm(a_P, b_P)};
}

std::vector<Vec3> insertion_way(std::span<const telemetry::TickSample> samples, std::optional<std::size_t> fired) {
  const std::optional<std::size_t> end = find_end(samples, fired);
  if (!end) return {};
  std::size_t first = *end;
  while (first > 0 && samples[first - 1].depth_mm > 0.0) --first;
  detail::ThinPath way;
  for (std::size_t n = first; n <= *end; ++n)
    if (samples[n].rest_tip_mm.allFinite()) way.add(samples[n].rest_tip_mm, samples[n].time_s);
  std::vector<Vec3> points_P;
  for (const detail::ThinPath::Point& point : way.points()) points_P.push_back(point.p_P);
  if (samples[*end].rest_tip_mm.allFinite()) points_P.push_back(samples[*end].rest_tip_mm);
  return points_P;
}

}  // namespace trocar::metrics
