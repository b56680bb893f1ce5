#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "motion/patient_motion.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray::detail {

/// Densities of a voxel in one word: water in the lower half, bone in the upper one, signed, in kPackedUnit g/cm³. (Fat
/// is a mixture with a little negative bone.)
using PackedVoxel = std::int32_t;
inline constexpr double kPackedUnit_g_per_cm3 = 1.0 / 8192.0;

/// A row of voxels that are not all zero.
struct RowSpan {
  std::int32_t begin = 0, end = 0;  ///< First voxel that is not zero, and one beyond the last; equal: an empty row.
  std::ptrdiff_t first = 0;  ///< Place of the row's voxel 0 in RowStack::voxels; before it where it is not stored.
};

/// A volume as rows along one of its axes, without the zeros at both ends of a row. Row (a, b) of the other two axes is
/// rows[a + b * size_a]. A row stores all voxels in which it or one of its four neighbours is not zero, so that two
/// neighbours can be blended without a test for ends.
template <class Voxel>
struct RowStack {
  std::int64_t length = 0, size_a = 0, size_b = 0;
  std::vector<RowSpan> rows;
  std::vector<Voxel> voxels;
};

inline constexpr std::size_t kRowPadding = 64;  ///< Voxels before and after all rows: vectors read beyond a row's end.

/// Union of a row's span and those of its neighbours.
inline RowSpan with_neighbours(const std::vector<RowSpan>& rows, std::int64_t a, std::int64_t b, std::int64_t size_a,
                               std::int64_t size_b) {
  RowSpan all;
  constexpr std::array<std::array<int, 2>, 5> kOffsets{{{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (const auto& [da, db] : kOffsets) {
    const std::int64_t at_a = a + da, at_b = b + db;
    if (at_a < 0 || at_b < 0 || at_a >= size_a || at_b >= size_b) continue;
    const RowSpan& row = rows[static_cast<std::size_t>(at_a + at_b * size_a)];
    if (row.begin == row.end) continue;
    if (all.begin == all.end) {
      all = row;
      continue;
    }
    all.begin = std::min(all.begin, row.begin);
    all.end = std::max(all.end, row.end);
  }
  return all;
}

/// Builds the rows of a volume; value(x, a, b) is the voxel x of row (a, b). All cores; value is called twice a voxel.
template <class Voxel, class Value>
RowStack<Voxel> make_row_stack(std::int64_t length, std::int64_t size_a, std::int64_t size_b, const Value& value) {
  RowStack<Voxel> stack{length, size_a, size_b, {}, {}};
  stack.rows.resize(static_cast<std::size_t>(size_a * size_b));
  const auto for_rows = [&](const auto& body) {
    parallel_for(static_cast<std::size_t>(size_b), 1, [&](std::size_t first, std::size_t last) {
      for (auto b = static_cast<std::int64_t>(first); b < static_cast<std::int64_t>(last); ++b)
        for (std::int64_t a = 0; a < size_a; ++a) body(a, b, stack.rows[static_cast<std::size_t>(a + b * size_a)]);
    });
  };
  for_rows([&](std::int64_t a, std::int64_t b, RowSpan& row) {
    std::int64_t begin = 0, end = length;
    while (begin < end && value(begin, a, b) == Voxel{}) ++begin;
    while (end > begin && value(end - 1, a, b) == Voxel{}) --end;
    row.begin = static_cast<std::int32_t>(begin);
    row.end = static_cast<std::int32_t>(end);
  });
  std::vector<RowSpan> stored(stack.rows.size());
  std::ptrdiff_t next = kRowPadding;
  for (std::int64_t b = 0; b < size_b; ++b) {
    for (std::int64_t a = 0; a < size_a; ++a) {
      const auto n = static_cast<std::size_t>(a + b * size_a);
      stored[n] = with_neighbours(stack.rows, a, b, size_a, size_b);
      stack.rows[n].first = next - stored[n].begin;
      next += stored[n].end - stored[n].begin;
    }
  }
  stack.voxels.assign(static_cast<std::size_t>(next) + kRowPadding, Voxel{});
  for_rows([&](std::int64_t a, std::int64_t b, const RowSpan& row) {
    const RowSpan& span = stored[static_cast<std::size_t>(a + b * size_a)];
    Voxel* const voxels = stack.voxels.data() + row.first;
    for (std::int64_t x = span.begin; x < span.end; ++x) voxels[x] = value(x, a, b);
  });
  return stack;
}

/// Rows of a stack as a projector walks them: slices n, and rows y in each.
template <class Voxel>
struct RowsView {
  const RowSpan* rows = nullptr;
  const Voxel* voxels = nullptr;
  std::int64_t length = 0;                  ///< Voxels of a row.
  std::int64_t count_y = 0;                 ///< Rows of a slice.
  std::int64_t stride_y = 1, stride_n = 1;  ///< From a row to the next one of its slice, and to that of the next slice.
};

}  // namespace trocar::xray::detail

namespace trocar::xray {

/// The volume's voxels twice: as rows along index axis 0, and along axis 1 for rays that advance along axis 0.
struct XrayVolume::Impl {
  volume::GridGeometry geometry;
  detail::RowStack<detail::PackedVoxel> rows, transposed;
  std::shared_ptr<const anatomy::VirtualPatient> patient;  ///< Empty for a CT alone.
  motion::PatientMotion motion;                            ///< Where the patient is in this volume.

  /// Builds both from `voxel(offset)`.
  template <class Voxel>
  void fill(const Voxel& voxel) {
    const auto [i, j, k] = geometry.size;
    rows = detail::make_row_stack<detail::PackedVoxel>(
        i, j, k, [&, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
          return voxel(static_cast<std::size_t>((b * size_j + a) * size_i + x));
        });
    transposed = detail::make_row_stack<detail::PackedVoxel>(
        j, i, k, [&, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
          return voxel(static_cast<std::size_t>((b * size_j + x) * size_i + a));
        });
  }
};

}  // namespace trocar::xray
