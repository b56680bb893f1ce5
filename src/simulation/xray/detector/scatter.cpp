#include "xray/detector/scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/parallel.h"
#include "core/result.h"
#include "volume/resample.h"

namespace trocar::xray {
namespace {

constexpr int kRaster = 64;  ///< Cells along each edge of the field.

std::size_t at(int column, int row, int columns) noexcept {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// First pixel of a cell of the raster.
int first_of(int cell, int cells, int pixels) noexcept {
  return cell * pixels / cells;
}

float mass_at(const MassImage& patient, std::size_t n) noexcept {
  const auto value = [&](Basis basis) { return patient.of(basis).empty() ? 0.0F : patient.of(basis)[n]; };
  return value(Basis::kWater) + value(Basis::kBone);
}

/// Mean over the pixels of a cell.
template <class Value>
double cell_mean(int u, int v, const Scatter& raster, int columns, int rows, const Value& value) {
  const int c0 = first_of(u, raster.columns, columns), c1 = first_of(u + 1, raster.columns, columns);
  const int r0 = first_of(v, raster.rows, rows), r1 = first_of(v + 1, raster.rows, rows);
  double sum = 0.0;
  for (int row = r0; row < r1; ++row)
    for (int column = c0; column < c1; ++column) sum += value(at(column, row, columns));
  return sum / std::max(1, (c1 - c0) * (r1 - r0));
}

}  // namespace

double Scatter::mean() const noexcept {
  return signal.empty() ? 0.0 : std::accumulate(signal.begin(), signal.end(), 0.0) / static_cast<double>(signal.size());
}

Scatter estimate_scatter(const MassImage& patient, std::span<const float> primary, const CArm& arm,
                         const DetectorParams& params) {
  TROCAR_CHECK(primary.size() == static_cast<std::size_t>(arm.pixels) * static_cast<std::size_t>(arm.pixels));
  Scatter scatter;
  scatter.columns = std::min({kRaster, arm.pixels, std::max(1, patient.columns)});
  scatter.rows = std::min({kRaster, arm.pixels, std::max(1, patient.rows)});
  volume::GridGeometry geometry;
  geometry.size = {scatter.columns, scatter.rows, 1};
  volume::FloatGrid grid(geometry);
  if (patient.size() > 0)
    for (int v = 0; v < scatter.rows; ++v)
      for (int u = 0; u < scatter.columns; ++u) {
        const double mass =
            cell_mean(u, v, scatter, patient.columns, patient.rows, [&](std::size_t n) { return mass_at(patient, n); });
        const double beam = cell_mean(u, v, scatter, arm.pixels, arm.pixels, [&](std::size_t n) { return primary[n]; });
        grid.voxels[at(u, v, scatter.columns)] =
            static_cast<float>(params.scatter_per_g_per_cm2 * mass * beam * params.grid_scatter / params.grid_primary);
      }
  const double cell_mm = arm.field_mm / scatter.columns;
  volume::gaussian_blur(grid, Vec3(params.scatter_spread_mm / cell_mm, params.scatter_spread_mm / cell_mm, 0.0));
  scatter.signal = std::move(grid.voxels);
  return scatter;
}

void add_scatter(const Scatter& scatter, int columns, int rows, std::span<float> signal) {
  if (scatter.signal.empty()) return;
  struct Place {
    int first, second;
    float weight;
  };
  const auto place = [](int pixel, int pixels, int cells) {
    const double x = std::clamp((pixel + 0.5) * cells / pixels - 0.5, 0.0, cells - 1.0);
    const int first = static_cast<int>(x);
    return Place{first, std::min(first + 1, cells - 1), static_cast<float>(x - first)};
  };
  std::vector<Place> places;
  for (int column = 0; column < columns; ++column) places.push_back(place(column, columns, scatter.columns));
  parallel_for(static_cast<std::size_t>(rows), 64, [&](std::size_t first, std::size_t last) {
    std::vector<float> line(static_cast<std::size_t>(scatter.columns));
    for (std::size_t row = first; row < last; ++row) {
      const Place y = place(static_cast<int>(row), rows, scatter.rows);
      for (int u = 0; u < scatter.columns; ++u) {
        const float a = scatter.signal[at(u, y.first, scatter.columns)];
        line[static_cast<std::size_t>(u)] = a + y.weight * (scatter.signal[at(u, y.second, scatter.columns)] - a);
      }
      float* const pixels = signal.data() + row * static_cast<std::size_t>(columns);
      for (int column = 0; column < columns; ++column) {
        const Place& x = places[static_cast<std::size_t>(column)];
        const float a = line[static_cast<std::size_t>(x.first)];
        pixels[column] += a + x.weight * (line[static_cast<std::size_t>(x.second)] - a);
      }
    }
  });
}

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
