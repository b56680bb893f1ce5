#pragma once

#include <string>

#include "tasks/detail/planning_map.h"
#include "tasks/needle.h"

namespace trocar::tasks::detail {

/// Why a line is no path. The first ones have to do with the skin alone.
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

/// A straight way of a needle that may turn out to be no path.
struct PathCandidate {
  Segment line_P{Vec3::Zero(), Vec3::Zero()};  ///< Skin -> tip.
  double length_mm = 0.0;
  double largest_margin_mm = 0.0;  ///< The exact spare margin of a kFree line is at most this.
  PathVerdict verdict = PathVerdict::kFree;
  Vec3 where_P = Vec3::Zero();  ///< Where a kCrosses was found.
};

/// Searches from a target along `outward` (unit) for the skin and tests what is quick to test: length, reach, angle,
/// the coarse clearance. What passes may still fail check_path. Deterministic.
PathCandidate trace_path(const PlanningMap& map, const Needle& needle, const Vec3& target_P, const Vec3& outward);

/// Outward normal of the skin at a point of P, over a few voxels; zero where the distance has no slope.
Vec3 skin_normal(const volume::FloatGrid& skin_distance, const Vec3& p_P);

/// Distance between a segment and the box of a voxel. mm.
double segment_box_distance_mm(const Segment& segment, const volume::GridGeometry& geometry, const Vec3& centre_P);

/// What an exact look at a path finds.
struct PathFindings {
  PathVerdict verdict = PathVerdict::kFree;
  Vec3 where_P = Vec3::Zero();
  double organ_path_mm = 0.0;
  double spare_margin_mm = 0.0;   ///< Clearance beyond the required margin, at most kReportedMargin_mm.
  std::uint8_t nearest_risk = 0;  ///< Label id; 0: none within kReportedMargin_mm.
};
inline constexpr double kHubReserve_mm = 10.0;      ///< Of the needle stays outside.
inline constexpr double kReportedMargin_mm = 10.0;  ///< Upper bound of spare_margin_mm.

/// Walks the path and the throw beyond it voxel by voxel: layers in order, organ passed, margins to the risk voxels.
PathFindings check_path(const PlanningMap& map, const Needle& needle, const PathCandidate& path);

}  // namespace trocar::tasks::detail
