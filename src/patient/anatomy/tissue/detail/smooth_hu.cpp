#include "anatomy/tissue/detail/smooth_hu.h"

#include <span>
#include <vector>

#include "core/parallel.h"

namespace trocar::anatomy::detail {
namespace {

using HuRow = std::span<std::int16_t>;

std::int16_t weighted(int before, int here, int after) {
  return static_cast<std::int16_t>((before + 2 * here + after + 2) >> 2);
}

/// Smooths along a row; the end values continue outside.
void smooth_row(HuRow row) {
  std::int16_t before = row.front();
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::int16_t here = row[i];
    row[i] = weighted(before, here, i + 1 < row.size() ? row[i + 1] : here);
    before = here;
  }
}

/// Smooths across `count` rows, `stride` voxels apart.
void smooth_across(std::int16_t* first, std::size_t length, std::size_t stride, std::size_t count) {
  std::vector<std::int16_t> before(first, first + length);
  for (std::size_t n = 0; n < count; ++n) {
    std::int16_t* row = first + n * stride;
    const std::int16_t* after = n + 1 < count ? row + stride : row;
    for (std::size_t i = 0; i < length; ++i) {
      const std::int16_t here = row[i];
      row[i] = weighted(before[i], here, after[i]);
      before[i] = here;
    }
  }
}

int passes(double spacing_mm) {
  return spacing_mm < 1.2 ? 2 : spacing_mm < 2.5 ? 1 : 0;
}

}  // namespace

volume::CtGrid smooth_hu(const volume::CtGrid& ct) {
  volume::CtGrid smooth = ct;
  const auto columns = static_cast<std::size_t>(ct.geometry.size[0]);
  const auto rows = static_cast<std::size_t>(ct.geometry.size[1]);
  const auto slices = static_cast<std::size_t>(ct.geometry.size[2]);
  const Vec3& spacing_mm = ct.geometry.spacing_mm;
  parallel_for(slices, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      std::int16_t* slice = smooth.voxels.data() + k * rows * columns;
      for (int pass = 0; pass < passes(spacing_mm[0]); ++pass) {
        for (std::size_t j = 0; j < rows; ++j) smooth_row({slice + j * columns, columns});
      }
      for (int pass = 0; pass < passes(spacing_mm[1]); ++pass) smooth_across(slice, columns, columns, rows);
    }
  });
  parallel_for(rows, 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j) {
      for (int pass = 0; pass < passes(spacing_mm[2]); ++pass)
        smooth_across(smooth.voxels.data() + j * columns, columns, rows * columns, slices);
    }
  });
  return smooth;
}

}  // namespace trocar::anatomy::detail
