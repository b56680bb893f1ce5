#include "io/dicom/detail/padding.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace trocar::io::detail {
namespace {

constexpr double kHighestTissue_hu = 3071.0;  ///< Of a 12-bit CT: metal, enamel.

/// Marks the padding that reaches the edge through padding.
std::vector<bool> from_edge(const std::vector<bool>& is_padding, std::size_t columns, std::size_t rows) {
  std::vector<bool> reached(is_padding.size(), false);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t at) {
    if (!is_padding[at] || reached[at]) return;
    reached[at] = true;
    open.push_back(at);
  };
  for (std::size_t i = 0; i < columns; ++i) {
    reach(i);
    reach((rows - 1) * columns + i);
  }
  for (std::size_t j = 0; j < rows; ++j) {
    reach(j * columns);
    reach(j * columns + columns - 1);
  }
  while (!open.empty()) {
    const std::size_t at = open.back(), i = at % columns, j = at / columns;
    open.pop_back();
    if (i > 0) reach(at - 1);
    if (i + 1 < columns) reach(at + 1);
    if (j > 0) reach(at - columns);
    if (j + 1 < rows) reach(at + columns);
  }
  return reached;
}

template <class Stored>
PaddingCount fill_padding_of(const DicomSlice& slice, std::span<std::byte> pixels) {
  const std::size_t count = pixels.size() / sizeof(Stored);
  std::vector<Stored> numbers(count);
  std::memcpy(numbers.data(), pixels.data(), count * sizeof(Stored));
  std::vector<bool> is_padding(count);
  const auto [low, high] = *slice.padding;
  std::size_t found = 0;
  for (std::size_t n = 0; n < count; ++n) {
    is_padding[n] = numbers[n] >= low && numbers[n] <= high;
    found += is_padding[n] ? 1 : 0;
  }
  if (found == 0) return {};
  if (*padding_hu(slice) <= kHighestTissue_hu)
    is_padding = from_edge(is_padding, static_cast<std::size_t>(slice.columns), static_cast<std::size_t>(slice.rows));
  const double air = (kPaddingAir_hu - slice.intercept.value_or(0.0)) / slice.slope.value_or(1.0);
  const auto stored_air =
      static_cast<Stored>(std::clamp(std::round(air), static_cast<double>(std::numeric_limits<Stored>::min()),
                                     static_cast<double>(std::numeric_limits<Stored>::max())));
  PaddingCount result;
  for (std::size_t n = 0; n < count; ++n) {
    if (!is_padding[n]) continue;
    numbers[n] = stored_air;
    ++result.filled;
  }
  result.kept = found - result.filled;
  std::memcpy(pixels.data(), numbers.data(), count * sizeof(Stored));
  return result;
}

}  // namespace

std::optional<double> padding_hu(const DicomSlice& slice) {
  if (!slice.padding) return std::nullopt;
  const double slope = slice.slope.value_or(1.0), intercept = slice.intercept.value_or(0.0);
  const double hu = std::max((*slice.padding)[0] * slope, (*slice.padding)[1] * slope) + intercept;
  return hu > kPaddingAir_hu ? std::optional(hu) : std::nullopt;
}

PaddingCount fill_padding(const RawVoxels& voxels, const DicomSlice& slice, std::span<std::byte> pixels) {
  if (!padding_hu(slice) || slice.slope == 0.0) return {};
  switch (voxels.type) {
    case VoxelType::kInt8:
      return fill_padding_of<std::int8_t>(slice, pixels);
    case VoxelType::kUInt8:
      return fill_padding_of<std::uint8_t>(slice, pixels);
    case VoxelType::kInt16:
      return fill_padding_of<std::int16_t>(slice, pixels);
    default:
      return fill_padding_of<std::uint16_t>(slice, pixels);
  }
}

}  // namespace trocar::io::detail
