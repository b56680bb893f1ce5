#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/segmentation/detail/seg_header.h"
#include "dicom/segmentation/segmentation.h"
#include "dicom/stack/slice_stack.h"

namespace trocar::dicom::detail {

/// Plane `to` shows the same as plane `from`.
struct PlaneRepeat {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// Planes that are thicker than the slices of the CT.
struct ThickPlanes {
  double thickness_mm = 0.0;
  double ct_step_mm = 0.0;  ///< The smallest distance of slices beside a plane.
};

/// The planes of a SEG, those without frames included.
struct SegPlanes {
  SliceStack stack;
  std::vector<std::size_t> plane_of_frame;
  std::vector<PlaneRepeat> repeats;  ///< Planes without frames within the thickness of another one.
  std::optional<ThickPlanes> thick;
  double single_step_mm = 1.0;  ///< Thickness of the plane if there is only one.
};

/// Puts frames of one place into one plane, and adds the planes that the file leaves out because nothing is in them:
/// the slices of the CT where the frames lie on them, several for a frame whose SpacingBetweenSlices (else
/// SliceThickness) spans several; else multiples of SpacingBetweenSlices or of the smallest distance. Errors (at
/// `where`): frames of one place are shifted sideways, too many planes for any scan.
Result<SegPlanes> place_planes(const SegHeader& header, const CtReference& ct, const std::string& where);

}  // namespace trocar::dicom::detail
