#pragma once

#include <algorithm>
#include <cmath>

#include "anatomy/patient.h"
#include "geometry/shapes.h"
#include "metrics/metric.h"
#include "volume/sampling.h"

namespace trocar::metrics::detail {

inline constexpr double kTestedEvery_mm = 0.5;  ///< Distance of the points of a way whose structures are looked up.

inline constexpr double kToBone_mm = 0.5;  ///< From a tip that presses on bone to its label.
inline constexpr double kInside_mm = 0.1;  ///< A tip is in a structure from so much behind its border on.

/// Depth (mm) of a tip below the resting skin along its shaft, 0 outside: the shaft is followed from the tip backwards
/// in steps of the distance to the skin. A shaft that meets no skin within 400 mm has the depth 400.
inline double depth_in_body_mm(const anatomy::VirtualPatient& patient, const Vec3& tip_P, const Vec3& axis_P) noexcept {
  constexpr double kFarthest_mm = 400.0, kLeastStep_mm = 0.05;
  if (patient.skin_distance_mm.empty()) return 0.0;
  double depth_mm = 0.0;
  while (depth_mm < kFarthest_mm) {
    const double outside_mm = volume::sample_linear(patient.skin_distance_mm, tip_P - depth_mm * axis_P);
    if (!(outside_mm < 0.0)) break;
    depth_mm += std::max(kLeastStep_mm, -outside_mm);
  }
  return std::min(depth_mm, kFarthest_mm);
}

/// The label that the tip is in, or presses on if that is bone.
inline std::uint8_t label_ahead(const anatomy::VirtualPatient& patient, const Moment& moment) noexcept {
  const Vec3 ahead_P = moment.tip_A() + (moment.pressed_mm > 0.0 ? kToBone_mm : 0.0) * moment.axis_A();
  return volume::sample_nearest<std::uint8_t>(patient.labels, ahead_P, 0);
}

/// Share of a straight step that lies in the body: at a border the depth inside over the length of the step.
inline double share_inside(double depth_before_mm, double depth_now_mm, double length_mm) noexcept {
  if (depth_before_mm > 0.0 && depth_now_mm > 0.0) return 1.0;
  const double deepest_mm = std::max(depth_before_mm, depth_now_mm);
  if (!(deepest_mm > 0.0)) return 0.0;
  return length_mm > deepest_mm ? deepest_mm / length_mm : 1.0;
}

/// Mean and largest distance of a straight piece from a segment, at points at most 1 mm apart.
struct PieceDistance {
  double mean_mm = 0.0, largest_mm = 0.0;
};
inline PieceDistance piece_distance(const Segment& piece, const Segment& segment) noexcept {
  const int steps = std::clamp(static_cast<int>(std::ceil(piece.length_mm())), 1, 1000);
  PieceDistance result;
  for (int n = 0; n <= steps; ++n) {
    const double apart_mm = distance_mm(segment, piece.at(static_cast<double>(n) / steps));
    result.mean_mm += (n == 0 || n == steps ? 0.5 : 1.0) * apart_mm / steps;
    result.largest_mm = std::max(result.largest_mm, apart_mm);
  }
  return result;
}

}  // namespace trocar::metrics::detail
