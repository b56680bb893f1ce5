#include "metrics/curve_distances.h"

#include <algorithm>
#include <array>
#include <limits>

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

namespace trocar::metrics::detail {
namespace {

/// The distance of each point of `a` to the nearest one of `b`, the largest.
double one_way_mm(std::span<const Vec3> a, std::span<const Vec3> b) {
  double largest = 0.0;
  for (const Vec3& p : a) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& q : b) nearest = std::min(nearest, (p - q).squaredNorm());
    largest = std::max(largest, nearest);
  }
  return std::sqrt(largest);
}

}  // namespace

void ThinPath::add(const Vec3& p_P, double time_s) {
  if (!points_.empty() && (p_P - points_.back().p_P).squaredNorm() < spacing_mm_ * spacing_mm_) return;
  points_.push_back({p_P, time_s});
  if (points_.size() < kMostPoints) return;
  for (std::size_t n = 0; 2 * n < points_.size(); ++n) points_[n] = points_[2 * n];
  points_.resize((points_.size() + 1) / 2);
  spacing_mm_ *= 2.0;
}

std::vector<Vec3> resample(std::span<const Vec3> polyline, std::size_t count) {
  std::vector<double> along_mm(polyline.size(), 0.0);
  for (std::size_t n = 1; n < polyline.size(); ++n)
    along_mm[n] = along_mm[n - 1] + (polyline[n] - polyline[n - 1]).norm();
  std::vector<Vec3> points;
  points.reserve(count);
  std::size_t piece = 1;
  for (std::size_t n = 0; n < count; ++n) {
    const double at_mm = along_mm.back() * static_cast<double>(n) / static_cast<double>(count - 1);
    while (piece + 1 < polyline.size() && along_mm[piece] < at_mm) ++piece;
    if (polyline.size() == 1) {
      points.push_back(polyline[0]);
      continue;
    }
    const double length_mm = along_mm[piece] - along_mm[piece - 1];
    const double fraction = length_mm > 0.0 ? std::clamp((at_mm - along_mm[piece - 1]) / length_mm, 0.0, 1.0) : 0.0;
    points.push_back(polyline[piece - 1] + fraction * (polyline[piece] - polyline[piece - 1]));
  }
  return points;
}

double frechet_mm(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<double> row(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    double diagonal = 0.0;  // of the row before, one column to the left
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double above = row[j];
      double way = i > 0 ? above : j > 0 ? row[j - 1] : 0.0;
      if (i > 0 && j > 0) way = std::min({above, row[j - 1], diagonal});
      row[j] = std::max(way, (a[i] - b[j]).norm());
      diagonal = above;
    }
  }
  return row.back();
}

double hausdorff_mm(std::span<const Vec3> a, std::span<const Vec3> b) {
  return std::max(one_way_mm(a, b), one_way_mm(b, a));
}

double warped_mm(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<double> row(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    double diagonal = 0.0;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double above = row[j];
      const double apart = (a[i] - b[j]).norm();
      double sum = 2.0 * apart;  // a diagonal step counts twice, as do the two straight ones that replace it
      if (i > 0 && j > 0)
        sum = std::min({above + apart, row[j - 1] + apart, diagonal + 2.0 * apart});
      else if (i > 0)
        sum = above + apart;
      else if (j > 0)
        sum = row[j - 1] + apart;
      row[j] = sum;
      diagonal = above;
    }
  }
  return row.back() / static_cast<double>(a.size() + b.size());
}

}  // namespace trocar::metrics::detail
