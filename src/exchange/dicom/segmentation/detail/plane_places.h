#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/segmentation/detail/seg_header.h"
#include "dicom/segmentation/segmentation.h"
#include "dicom/stack/slice_stack.h"

namespace trocar::dicom::detail {

/// The planes of a SEG, those without frames included.
struct SegPlanes {
  SliceStack stack;
  std::vector<std::size_t> plane_of_frame;
  double single_step_mm = 1.0;  ///< Thickness of the plane if there is only one.
};

/// Puts frames of one place into one plane, and adds the planes that the file leaves out because nothing is in them:
/// the slices of the CT where the frames lie on them; else multiples of SpacingBetweenSlices or of the smallest
/// distance. Errors (at `where`): frames of one place are shifted sideways, too many planes for any scan.
Result<SegPlanes> place_planes(const SegHeader& header, const CtReference& ct, const std::string& where);

}  // namespace trocar::dicom::detail
