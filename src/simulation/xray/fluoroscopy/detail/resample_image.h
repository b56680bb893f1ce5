#pragma once

#include <vector>

namespace trocar::xray::detail {

/// Bilinear values of an image on another raster over the same area. All cores.
std::vector<float> resample_image(const std::vector<float>& image, int columns, int rows, int new_columns,
                                  int new_rows);

}  // namespace trocar::xray::detail
