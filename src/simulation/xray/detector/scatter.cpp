#include "xray/detector/scatter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/parallel.h"
#include "volume/gaussian_blur.h"

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

}  // namespace trocar::xray
