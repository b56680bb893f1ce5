#pragma once

#include <cstdint>

#include "geometry/pose.h"
#include "registration/ct_ultrasound/detail/working_images.h"

namespace trocar::registration::detail {

/// Coarse pose X_CU of the ultrasound with the middle of its face on the skin of the CT, its middle beam within 30
/// degrees of the inward normal: the best of all places, tilts and rolls by mutual information (docs/physics.md R14).
/// Error: the CT has no skin.
Result<Pose> search_from_skin(const volume::CtGrid& ct, const WorkingUltrasound& us, const Beams& beams,
                              std::uint64_t seed);

}  // namespace trocar::registration::detail
