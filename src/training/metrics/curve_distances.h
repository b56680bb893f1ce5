#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/shapes.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics {

/// Distances (mm) of a way of the needle's tip from an expert path; docs/metrics.md.
struct CurveDistances {
  double frechet_mm = 0.0;    ///< Eiter, Mannila 1994.
  double hausdorff_mm = 0.0;  ///< Hausdorff 1914.
  double dtw_mm = 0.0;        ///< Sakoe, Chiba 1978.
};

/// Both curves are resampled to 256 points at equal distances. `way_P`: one or more points.
CurveDistances curve_distances(std::span<const Vec3> way_P, const Segment& expert_P);

/// The tip's way from the skin to the end, in the insertion that contains the end: the shot (`fired`), else the deepest
/// moment. Empty: the needle never was in the body.
std::vector<Vec3> insertion_way(std::span<const telemetry::TickSample> samples, std::optional<std::size_t> fired);

}  // namespace trocar::metrics

namespace trocar::metrics::detail {

/// A path with points at least `spacing` apart, of bounded length: when it is full every second point is removed and
/// the spacing doubled.
class ThinPath {
 public:
  struct Point {
    Vec3 p_P;
    double time_s = 0.0;
  };
  static constexpr std::size_t kMostPoints = 4096;
  static constexpr double kSpacing_mm = 0.25;

  void add(const Vec3& p_P, double time_s);
  void clear() noexcept {
    points_.clear();
    spacing_mm_ = kSpacing_mm;
  }
  const std::vector<Point>& points() const noexcept { return points_; }

 private:
  std::vector<Point> points_;
  double spacing_mm_ = kSpacing_mm;
};

/// `count` points at equal distances along a polyline of one or more points; count >= 2.
std::vector<Vec3> resample(std::span<const Vec3> polyline, std::size_t count);

// Distances (mm) of two sequences of points, neither of them empty.
/// Discrete Fréchet distance (Eiter, Mannila 1994): largest gap between both when they are followed forwards, at the
/// best choice of speeds.
double frechet_mm(std::span<const Vec3> a, std::span<const Vec3> b);
/// Hausdorff distance: the largest distance of a point of one to the nearest point of the other.
double hausdorff_mm(std::span<const Vec3> a, std::span<const Vec3> b);
/// Time-normalised distance of dynamic time warping with symmetric weights (Sakoe, Chiba 1978): a mean distance of
/// paired points.
double warped_mm(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace trocar::metrics::detail
