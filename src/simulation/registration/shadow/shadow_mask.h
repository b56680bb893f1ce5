#pragma once

#include <cstdint>
#include <span>

#include "core/result.h"
#include "registration/shadow/beams.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Regions of an ultrasound volume, on its grid.
struct ImagedRegion {
  volume::MaskGrid inside;    ///< 1 within the fan. Parallel beams: 0 where a beam begins with samples of gray 0.
  volume::MaskGrid usable;    ///< 1 inside and not shadowed: the only voxels that later steps read.
  double shadow_share = 0.0;  ///< Shadowed share of the inside, 0..1.
};

/// Gray level that separates shadows from tissue: the lower of the two thresholds of three classes (shadow, tissue,
/// bright echoes) with the least variance within, over the voxels inside (Otsu, IEEE Trans Syst Man Cybern 9:62, 1979).
/// Shadow is darker than it. `scans` and `inside` have the same length (checked). Error: all voxels have the same gray
/// level.
Result<double> estimate_shadow_threshold(std::span<const volume::LabelGrid> scans,
                                         std::span<const volume::MaskGrid> inside);

/// Voxels within the fan (docs/physics.md R1).
volume::MaskGrid imaged_voxels(const volume::LabelGrid& gray, const Beams& beams);

/// Paper A, section 2: each beam is read from its deepest sample towards the transducer; samples below the threshold
/// are shadow, up to the first one that is not. `threshold`: 0..255 (exit status 2 otherwise). Parallel.
Result<ImagedRegion> find_shadows(const volume::LabelGrid& gray, const Beams& beams, double threshold);

}  // namespace trocar::registration
