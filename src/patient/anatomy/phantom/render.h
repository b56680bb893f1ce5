#pragma once

#include "anatomy/phantom/structure.h"
#include "core/progress.h"
#include "volume/grid.h"

namespace trocar::anatomy::phantom {

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

}  // namespace trocar::anatomy::phantom
