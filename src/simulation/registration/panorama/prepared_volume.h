#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "registration/intensity/rigid_alignment.h"
#include "registration/matching/match.h"
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

}  // namespace trocar::registration
