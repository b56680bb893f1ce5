#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "registration/intensity/rigid_alignment.h"
#include "registration/matching/match.h"
#include "registration/matching/ransac.h"
#include "registration/shadow/shadow_mask.h"

namespace trocar::registration {

struct PreparationOptions {
  std::optional<double> shadow_threshold;  ///< Gray level; estimated from the volume if empty.
  ScaleSpaceOptions scale_space;
  KeypointOptions keypoints;
  DescriptorOptions descriptors;
  /// Of a fan: tissue nearer to the face is pressed out of shape by it, so that it is not compared. Assumed; range
  /// 0..200.
  double near_part_mm = 25.0;
  double widening_voxels = 3.0;  ///< Of shadows, for the comparison of gray levels. Range 0..20.
};

/// Smoothed gray levels of a volume at one level of detail, and their points of comparison.
struct DetailLevel {
  double sigma_mm = 0.0;
  volume::FloatGrid values;  ///< NaN where not usable.
  std::vector<AlignmentPoint> points;
};

/// An ultrasound volume with everything that the comparison with others reads.
struct PreparedVolume {
  std::string name;
  volume::LabelGrid gray;
  Beams beams;
  double shadow_threshold = 0.0;
  ImagedRegion region;
  KeypointSet keypoints;
  std::vector<DetailLevel> details;  ///< From coarse to fine.

  double extent_mm() const noexcept;  ///< Edge of a cube of the usable voxels' volume.
};

/// Shadows, keypoints, descriptors and smoothed gray levels of a volume. Errors: those of the steps, with the volume's
/// name: constant or wholly shadowed volumes, options out of range.
Result<PreparedVolume> prepare(std::string name, volume::LabelGrid gray, const Beams& beams,
                               const PreparationOptions& options = {}, const Progress& progress = {});

struct PairOptions {
  MatchOptions match;
  RansacOptions ransac;
  double least_confidence = 0.5;  ///< A pair below is refused. Range 0..1.
};

/// Motion between two volumes, found from keypoints and refined by gray levels.
struct PairRegistration {
  std::size_t a = 0, b = 0;  ///< Indices of the volumes.
  Pose X_AB;
  std::vector<Match> matches;
  std::vector<std::size_t> inliers;  ///< Of the matches: those that X_AB brings together.
  double keypoint_rms_mm = 0.0;
  double ncc = -1.0;          ///< After the refinement, -1..1.
  double overlap = 0.0;       ///< Share of A's points that meet B.
  double significance = 0.0;  ///< Of the correlation, in standard deviations of that of independent speckle.
  double confidence = 0.0;    ///< 0..1: that no other motion explains both volumes (docs/physics.md R9).
  Matrix6 information = Matrix6::Zero();
  Vec3 middle_A{0, 0, 0};
  bool is_found = false;  ///< The confidence reaches the least one.
};

/// Registers B to A (docs/physics.md R9): motions of three matches (RANSAC) and of single matches with their
/// orientations are compared by the correlation of smoothed gray levels; the best is refined at full detail. Errors
/// (exit status 2): options out of range.
Result<PairRegistration> register_pair(const PreparedVolume& a, const PreparedVolume& b,
                                       const PairOptions& options = {});

/// Refines a known motion at the finest detail.
Alignment refine_pair(const PreparedVolume& a, const PreparedVolume& b, const Pose& X_AB);

}  // namespace trocar::registration
