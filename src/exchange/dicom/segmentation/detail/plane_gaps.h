#pragma once

#include <cstddef>
#include <vector>

#include "dicom/segmentation/detail/label_layers.h"
#include "dicom/stack/slice_stack.h"

namespace trocar::dicom::detail {

/// Empty planes within a structure of a SEG.
struct PlaneGaps {
  std::size_t drawn = 0;   ///< Planes with at least one pixel.
  std::size_t count = 0;   ///< Gaps of one to three planes between two planes that share a pixel.
  double widest_mm = 0.0;  ///< From the plane below to the plane above.
};

/// The gaps of each structure of a layer, in their order: planes that nobody drew, or that lie between those of a
/// thicker scan. Wider gaps, and those between planes without a common pixel, are between separate parts.
std::vector<PlaneGaps> find_plane_gaps(const LabelLayers::Layer& layer, const SliceStack& stack);

}  // namespace trocar::dicom::detail
