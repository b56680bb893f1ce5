#pragma once

#include "geometry/pose.h"
#include "image/image.h"
#include "registration/shadow/beams.h"
#include "volume/grid.h"

namespace trocar::registration {

/// A picture to judge a registration by: two planes of the ultrasound through the middle of its usable voxels, depth
/// downwards, and in each row the ultrasound, the CT at X_CU (-150 to 250 HU), a checkerboard of both with fields of
/// 20 mm, and a blend with the ultrasound in orange. Error: the ultrasound cannot be used (register_rigid).
Result<image::RgbImage> overlay_picture(const volume::CtGrid& ct, const volume::LabelGrid& us, const Beams& beams,
                                        const Pose& X_CU);

}  // namespace trocar::registration
