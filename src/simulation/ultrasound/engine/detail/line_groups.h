#pragma once

#include <algorithm>
#include <functional>

#include "core/parallel.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Ranges of scanlines, and their distribution to threads.
namespace trocar::ultrasound::detail {

inline int group_count(int lines) noexcept {
  return (lines + kGroup - 1) / kGroup;
}

/// Calls body(number of the group, first, last) for groups of at most kGroup scanlines of a range on several threads.
template <class Body>
void for_groups(const LineRange& lines, const Body& body) noexcept {
  const auto part = [&](std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) {
      const int begin = lines.first + static_cast<int>(g) * kGroup;
      body(static_cast<int>(g), begin, std::min(begin + kGroup, lines.last));
    }
  };
  parallel_for(static_cast<std::size_t>(group_count(lines.count())), 1, std::ref(part));
}

/// The range and `margin` scanlines on either side, widened to multiples of four; an empty range: all of `lines`.
inline LineRange widened(const LineRange& range, int margin, int lines) noexcept {
  if (range.is_empty()) return {0, lines};
  const int first = std::clamp(range.first - margin, 0, lines - 1) / kMostStride * kMostStride;
  const int last = std::clamp(range.last + margin, first + 1, lines);
  return {first, std::min(first + (last - first + kMostStride - 1) / kMostStride * kMostStride, lines)};
}

}  // namespace trocar::ultrasound::detail
