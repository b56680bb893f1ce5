#include "xray/detector/image_blur.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/parallel.h"
#include "volume/gaussian_blur.h"

namespace trocar::xray {
namespace {

constexpr double kNarrow_px = 0.7;
constexpr std::size_t kGrainBlurredRows = 32;

/// Three weights with variance `variance_px2` (pixels squared, at most 0.5), along rows and columns.
void blur_three(std::vector<float>& pixels, std::size_t columns, std::size_t rows, double variance_px2) {
  const auto side = static_cast<float>(0.5 * variance_px2), middle = static_cast<float>(1.0 - variance_px2);
  std::vector<float> along(pixels.size());
  parallel_for(rows, kGrainBlurredRows, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const float* const from = pixels.data() + row * columns;
      float* const to = along.data() + row * columns;
      for (std::size_t n = 1; n + 1 < columns; ++n) to[n] = middle * from[n] + side * (from[n - 1] + from[n + 1]);
      to[0] = (middle + side) * from[0] + side * from[std::min<std::size_t>(1, columns - 1)];
      to[columns - 1] = (middle + side) * from[columns - 1] + side * from[columns >= 2 ? columns - 2 : 0];
    }
  });
  parallel_for(rows, kGrainBlurredRows, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const float* const here = along.data() + row * columns;
      const float* const above = along.data() + (row == 0 ? 0 : row - 1) * columns;
      const float* const below = along.data() + std::min(row + 1, rows - 1) * columns;
      float* const to = pixels.data() + row * columns;
      for (std::size_t n = 0; n < columns; ++n) to[n] = middle * here[n] + side * (above[n] + below[n]);
    }
  });
}

/// A Gaussian on an image that is continued beyond its edges.
void blur_wide(std::vector<float>& pixels, int columns, int rows, double sigma_px) {
  const int margin = static_cast<int>(std::ceil(4.0 * sigma_px));
  volume::GridGeometry geometry;
  geometry.size = {columns + 2 * margin, rows + 2 * margin, 1};
  volume::FloatGrid grid(geometry);
  const int wide = columns + 2 * margin;
  const auto row_of = [&](int row) { return pixels.begin() + static_cast<std::ptrdiff_t>(row) * columns; };
  for (int row = 0; row < rows + 2 * margin; ++row) {
    const auto from = row_of(std::clamp(row - margin, 0, rows - 1));
    const auto to = grid.voxels.begin() + static_cast<std::ptrdiff_t>(row) * wide;
    std::fill_n(to, margin, *from);
    std::copy_n(from, columns, to + margin);
    std::fill_n(to + margin + columns, margin, *(from + columns - 1));
  }
  volume::gaussian_blur(grid, Vec3(sigma_px, sigma_px, 0.0));
  for (int row = 0; row < rows; ++row)
    std::copy_n(grid.voxels.begin() + static_cast<std::ptrdiff_t>(row + margin) * wide + margin, columns, row_of(row));
}

}  // namespace

void blur_image(std::vector<float>& pixels, int columns, int rows, double sigma_px) {
  TROCAR_CHECK(sigma_px >= 0.0 && sigma_px <= 100.0);
  if (sigma_px == 0.0 || pixels.empty()) return;
  if (sigma_px < kNarrow_px)
    blur_three(pixels, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), sigma_px * sigma_px);
  else
    blur_wide(pixels, columns, rows, sigma_px);
}

double scintillator_sigma_mm(const DetectorParams& params) noexcept {
  // The transfer of a Gaussian is exp(-2 (pi sigma f)²).
  return std::sqrt(0.5 * std::numbers::ln2) / (std::numbers::pi * params.mtf_half_lp_per_mm);
}

double focal_spot_sigma_mm(const DetectorParams& params, const CArm& arm) noexcept {
  const double shadow_mm = params.focal_spot_mm * (arm.source_detector_mm / arm.source_isocentre_mm - 1.0);
  return shadow_mm / std::sqrt(12.0);  // of an even square
}

}  // namespace trocar::xray
