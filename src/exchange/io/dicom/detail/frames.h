#pragma once

#include <vector>

#include "io/dicom/detail/dicom_slice.h"

namespace trocar::io::detail {

/// The frames of an enhanced file (PS3.3, C.7.6.16): places, directions, spacings and scaling from the functional
/// groups of each frame, or those that all share. A file without such groups gives `whole` itself. Errors: groups that
/// do not fit the number of frames, or are damaged.
Result<std::vector<DicomSlice>> frames_of(const DicomHeader& header, DicomSlice whole);

}  // namespace trocar::io::detail
