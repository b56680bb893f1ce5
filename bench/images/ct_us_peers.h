#pragma once

#include <filesystem>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::bench {

/// Files of one pair of volumes; a start at the identity.
struct PairFiles {
  std::filesystem::path ct, us, us_mask;
};

/// Rigid registration by elastix as a process, in a new folder: Mattes mutual information, three resolutions, 250
/// iterations of 4000 samples each. Points of the ultrasound to points of the CT. Error: it failed, or is missing.
Result<Pose> run_elastix(const PairFiles& files, const std::filesystem::path& folder);
/// The same by plastimatch: mutual information, versor optimiser, two resolutions.
Result<Pose> run_plastimatch(const PairFiles& files, const std::filesystem::path& folder);

}  // namespace trocar::bench
