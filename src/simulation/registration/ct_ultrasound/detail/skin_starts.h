#pragma once

#include <cstdint>
#include <functional>

#include "core/progress.h"
#include "geometry/pose.h"
#include "registration/ct_ultrasound/detail/working_images.h"

namespace trocar::registration::detail {

/// Coarse pose X_CU of the ultrasound with the middle of its face on the skin of the CT, its middle beam within 30
/// degrees of the inward normal: the best of all places, tilts and rolls by mutual information (docs/physics.md R14).
/// Polls `is_cancelled` between poses. Errors: the CT has no skin, cancelled.
Result<Pose> search_from_skin(const volume::CtGrid& ct, const WorkingUltrasound& us, const Beams& beams,
                              std::uint64_t seed, const std::function<bool()>& is_cancelled, const Progress& progress);

}  // namespace trocar::registration::detail
