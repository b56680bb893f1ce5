#pragma once

#include <cstdint>
#include <span>

namespace trocar::volume {

/// Which pairs of voxels a comparison looks at.
enum class ComparedVoxels { kAll, kBothAboveZero };

/// Normalised cross correlation of two images on one grid (Pearson's coefficient), -1..1. 0 where one of them is
/// constant or no pair is looked at.
double correlation(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                   ComparedVoxels voxels = ComparedVoxels::kAll);

}  // namespace trocar::volume
