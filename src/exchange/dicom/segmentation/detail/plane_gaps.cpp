#include "dicom/segmentation/detail/plane_gaps.h"

#include <algorithm>
#include <optional>
#include <span>

namespace trocar::dicom::detail {
namespace {

constexpr std::size_t kMostEmptyPlanes = 3;

bool share_a_pixel(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, std::uint8_t value) {
  for (std::size_t n = 0; n < a.size(); ++n)
    if (a[n] == value && b[n] == value) return true;
  return false;
}

}  // namespace

std::vector<PlaneGaps> find_plane_gaps(const LabelLayers::Layer& layer, const SliceStack& stack) {
  std::vector<PlaneGaps> gaps(layer.segments.size());
  std::vector<std::optional<std::size_t>> last(layer.segments.size());
  const auto plane_size = static_cast<std::size_t>(stack.columns * stack.rows);
  const auto pixels_of = [&](std::size_t plane) {
    return std::span(layer.voxels).subspan(plane * plane_size, plane_size);
  };
  for (std::size_t plane = 0; plane < stack.origins_P.size(); ++plane) {
    std::vector<bool> is_here(kMostValues + 1, false);
    for (const std::uint8_t value : pixels_of(plane)) is_here[value] = true;
    for (std::size_t n = 0; n < gaps.size(); ++n) {
      if (!is_here[n + 1]) continue;
      ++gaps[n].drawn;
      if (last[n] && plane - *last[n] > 1 && plane - *last[n] <= kMostEmptyPlanes + 1 &&
          share_a_pixel(pixels_of(*last[n]), pixels_of(plane), static_cast<std::uint8_t>(n + 1))) {
        ++gaps[n].count;
        gaps[n].widest_mm = std::max(gaps[n].widest_mm, stack.along_mm(plane) - stack.along_mm(*last[n]));
      }
      last[n] = plane;
    }
  }
  return gaps;
}

}  // namespace trocar::dicom::detail
