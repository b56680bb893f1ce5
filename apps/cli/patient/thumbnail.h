#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "cli/commands.h"
#include "core/result.h"
#include "image/image.h"
#include "slices/slice_picture.h"

namespace trocar::cli {

/// Small picture of a patient: the region in 3D from the side of the needle path, the skin translucent, with a coronal
/// slice in the corner. Without an X server: slices.
Result<image::RgbImage> make_thumbnail(const anatomy::VirtualPatient& patient,
                                       const std::vector<anatomy::NamedMesh>& meshes,
                                       const slices::ThumbnailRegion& region);

/// trocar patient thumbnail.
void add_thumbnail_command(Command& patient, Action& action);

}  // namespace trocar::cli
