#pragma once

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "ultrasound/sweep/freehand_options.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// A volume reconstructed from tracked pictures.
struct FreehandVolume {
  volume::LabelGrid gray;  ///< 0..255; 0 also for unknown voxels. Its P is the reference frame, taken as LPS, mm.
  std::size_t frames_used = 0;
  std::size_t frames_left_out = 0;  ///< Invalid pictures, and pictures without a known pose.
  std::size_t voxels_met = 0;       ///< Voxels that received a pixel.
  std::size_t holes_filled = 0;
};

/// Reconstructs the smallest volume that contains all pictures of a freehand sweep (docs/physics.md U12).
/// `calibration`: constant transforms, such as ImageToProbe; a frame's own transforms take precedence. The result does
/// not depend on the number of threads. Errors: no frame has a chain of transforms from the image to the reference
/// frame (the message names the missing part), a volume above 256 million voxels, no pixels left by the clipping,
/// options out of range.
Result<FreehandVolume> reconstruct_freehand(const TrackedSequence& sequence,
                                            const TrackedSequence::Transforms& calibration,
                                            const FreehandOptions& options, const Progress& progress = {});

}  // namespace trocar::ultrasound
