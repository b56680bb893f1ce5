#pragma once

#include <optional>
#include <vector>

#include "anatomy/derive/detail/derived_labels.h"
#include "anatomy/derive/detail/spine_labels.h"

namespace trocar::anatomy::detail {

/// The vertebral canal in one axial slice. Fractional voxel indices.
struct CanalSlice {
  double i = 0.0, j = 0.0;     ///< Its centre.
  double half_width_mm = 0.0;  ///< To the left and right.
  bool is_found = false;
};

/// The vertebral canal slice by slice, from feet to head.
struct Canal {
  std::int64_t first_k = 0;
  std::vector<CanalSlice> slices;
  std::uint8_t cord = 0;  ///< Label that it was found from ("spinal_cord", "spinal_canal"); 0: from the vertebrae.

  /// nullptr: no canal in this slice.
  const CanalSlice* at(std::int64_t k) const noexcept;
  std::int64_t last_k() const noexcept { return first_k + static_cast<std::int64_t>(slices.size()) - 1; }
};

/// Finds the canal from a label of cord or canal; without one from the rings that the vertebrae form in axial slices,
/// interpolated between them. Empty: fewer than two vertebrae, or neither a cord nor a closed ring.
std::optional<Canal> find_canal(const DerivedLabels& labels, const SpineLabels& spine);

}  // namespace trocar::anatomy::detail
