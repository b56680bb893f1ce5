#pragma once

#include <fmt/format.h>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::case_builder::detail {

/// Error: a point outside the box of a grid's voxels. `what`: "landmark"; `advice`: "click inside the ultrasound".
inline Status check_in_volume(const volume::GridGeometry& grid, const Vec3& p, const char* what, const char* advice) {
  const Vec3 index = grid.to_index(p);
  for (int a = 0; a < 3; ++a)
    if (!(index[a] >= -0.5 && index[a] <= static_cast<double>(grid.size[static_cast<std::size_t>(a)]) - 0.5))
      return fail(fmt::format("the {} is outside the volume", what),
                  fmt::format("({:.0f}, {:.0f}, {:.0f}) mm", p.x(), p.y(), p.z()), advice);
  return {};
}

}  // namespace trocar::case_builder::detail
