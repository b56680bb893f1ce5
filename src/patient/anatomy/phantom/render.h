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

/// How the structures of a block of voxels are chosen. kEvery exists to prove in a test that kNear changes nothing.
enum class Culling { kNear, kEvery };

/// Paints the anatomy onto a grid (R_PV identity) with scanner noise. Parallel; the same bits for any number of
/// threads.
Rendering render(const Anatomy& anatomy, const volume::GridGeometry& geometry, const Progress& progress = {},
                 Culling culling = Culling::kNear);

}  // namespace trocar::anatomy::phantom
