#pragma once

#include <string>

#include "tasks/detail/planning_map.h"
#include "tasks/needle.h"

namespace trocar::tasks::detail {

/// Reason why a line is not a valid path. The first ones concern only the skin.
enum class PathVerdict : std::uint8_t {
  kFree,
  kTooLong,
  kCutFace,
  kOutOfReach,
  kOutsideZone,
  kGlancing,
  kCrosses,
  kNoMuscle,
  kLeavesOrgan,
  kOrganPath,
  kMargin,
};

/// A straight line of a needle that may not be a valid path.
struct PathCandidate {
  Segment line_P{Vec3::Zero(), Vec3::Zero()};  ///< Skin -> tip.
  double length_mm = 0.0;
  double largest_margin_mm = 0.0;  ///< The exact spare margin of a kFree line is at most this.
  PathVerdict verdict = PathVerdict::kFree;
  Vec3 where_P = Vec3::Zero();  ///< Point at which kCrosses was found.
};

/// Searches from a target along `outward` (unit) for the skin and runs the fast tests: length, reach, angle, the coarse
/// clearance. A candidate that passes may still fail check_path. Deterministic.
PathCandidate trace_path(const PlanningMap& map, const Needle& needle, const Vec3& target_P, const Vec3& outward);

/// Outward normal of the skin at a point of P, over a few voxels; zero if the distance has no slope.
Vec3 skin_normal(const volume::FloatGrid& skin_distance, const Vec3& p_P);

/// Distance between a segment and the box of a voxel. mm.
double segment_box_distance_mm(const Segment& segment, const volume::GridGeometry& geometry, const Vec3& centre_P);

/// Result of the exact check of a path.
struct PathFindings {
  PathVerdict verdict = PathVerdict::kFree;
  Vec3 where_P = Vec3::Zero();
  double organ_path_mm = 0.0;
  double spare_margin_mm = 0.0;   ///< Clearance beyond the required margin, at most kReportedMargin_mm.
  std::uint8_t nearest_risk = 0;  ///< Label id; 0: none within kReportedMargin_mm.
};
inline constexpr double kHubReserve_mm = 10.0;      ///< Length of the needle that stays outside.
inline constexpr double kChunk_mm = 8.0;            ///< Piece of the path, for the exact margins.
inline constexpr double kReportedMargin_mm = 10.0;  ///< Upper bound of spare_margin_mm.

/// Walks the path and the throw beyond it voxel by voxel: layers in order, organ passed, margins to the risk voxels.
PathFindings check_path(const PlanningMap& map, const Needle& needle, const PathCandidate& path);

}  // namespace trocar::tasks::detail
