#pragma once

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "ultrasound/sweep/freehand_options.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// A volume made of tracked pictures.
struct FreehandVolume {
  volume::LabelGrid gray;  ///< 0..255; 0 also where nothing is known. Its P is the reference frame, taken as LPS, mm.
  std::size_t frames_used = 0;
  std::size_t frames_left_out = 0;  ///< Invalid pictures, and those whose place is not known.
  std::size_t voxels_met = 0;       ///< By a pixel.
  std::size_t holes_filled = 0;
};

/// Puts the pictures of a freehand sweep into a volume that just holds them all (docs/physics.md U12). `calibration`:
/// transforms that do not move, such as ImageToProbe; a frame's own go before. The same result whatever the number of
/// threads. Errors: no frame has a way from the image to the reference frame (said what is missing), a volume above
/// 256 million voxels, nothing left by the clipping, options out of range.
Result<FreehandVolume> reconstruct_freehand(const TrackedSequence& sequence,
                                            const TrackedSequence::Transforms& calibration,
                                            const FreehandOptions& options, const Progress& progress = {});

}  // namespace trocar::ultrasound
