#pragma once

#include "slices/slice_picture.h"

namespace trocar::slices {

/// Draws the orientation letters (R L A P H F) at the four edges of a slice image, as in radiology, and a scale bar
/// with its length in mm at the lower left. Text has a dark outline. Images below 96 pixels are not changed.
void draw_slice_legend(SlicePicture& picture);

/// Length of a scale bar: the largest 1, 2 or 5 x 10^n mm that fits into `most_mm` (> 0).
double scale_bar_mm(double most_mm) noexcept;

}  // namespace trocar::slices
