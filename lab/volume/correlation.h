#pragma once

#include <cstdint>
#include <span>

namespace trocar::volume {

/// Pairs of voxels that a comparison includes.
enum class ComparedVoxels { kAll, kBothAboveZero };

/// Normalised cross correlation of two images on one grid (Pearson's coefficient), -1..1. 0 if one image is constant or
/// no pair is included.
double correlation(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                   ComparedVoxels voxels = ComparedVoxels::kAll);

}  // namespace trocar::volume
