#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "registration/sift3d/keypoints.h"
#include "volume/grid.h"

namespace trocar::registration {

inline constexpr int kGrayBins = 16;
/// Shares of the gray levels near a keypoint; their sum is 1, or 0 where no voxel is usable.
using GrayHistogram = std::array<float, kGrayBins>;

/// Histograms of the usable voxels in 8 x 8 x 8 voxels about each keypoint. Bins: ranks among the usable gray levels of
/// the whole volume (each bin contains a sixteenth of them), so that neither gain nor a rising gray map changes them.
std::vector<GrayHistogram> gray_histograms(const volume::LabelGrid& gray, const volume::MaskGrid& usable,
                                           const std::vector<Keypoint>& keypoints);

/// Half the sum of absolute differences, with neighbouring bins taken together: 0 (equal)..1.
double histogram_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept;

}  // namespace trocar::registration
