#pragma once

#include <cstdint>

#include "core/progress.h"
#include "phantom/structure.h"
#include "volume/grid.h"

namespace trocar::phantom {

/// The three volumes of a phantom.
struct Rendering {
  volume::CtGrid ct;
  volume::LabelGrid labels;
  volume::FloatGrid skin_distance_mm;
};

/// Selection of structures for a block of voxels. A test compares kNear with kEvery.
enum class Culling { kNear, kEvery };

/// Paints the anatomy onto a grid (R_PV identity) with scanner noise. Parallel; the same bits for any number of
/// threads.
Rendering render(const Anatomy& anatomy, const volume::GridGeometry& geometry, const Progress& progress = {},
                 Culling culling = Culling::kNear);

/// Adds the quantum noise of a scanner: Gaussian with sigma_hu half way to the middle of the body, a fifth less at the
/// skin and a fifth more in the middle, two thirds of its power correlated over about 1.3 voxels,
/// the rest white. HU stay within
/// -1024..3071. Parallel; a pure function of seed and voxel index.
void add_scanner_noise(volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, std::uint64_t seed,
                       double sigma_hu);

}  // namespace trocar::phantom
