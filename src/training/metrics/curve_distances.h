#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/segment.h"
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
