#pragma once

#include <cstdint>
#include <vector>

#include "ultrasound/tissue/detail/tissue_volume.h"

namespace trocar::ultrasound::detail {

/// Interpolates tissue between two slices of a CT. Where both slices have the same tissue, it continues between them.
/// Elsewhere a border crosses the pixel at the height given by the distances to the borders in both slices (shape-based
/// interpolation, Raya and Udupa 1990, doi 10.1109/42.52980). A slanted surface becomes a slope, where votes alone
/// would leave terraces. A layer that moves by more than its own thickness stays in between.
class SliceBlend {
 public:
  explicit SliceBlend(const TissueVolume& volume);

  /// Selects slices w and w + 1 (the last slice: itself).
  void set_slices(std::int64_t w);
  /// Tissues at `fraction` 0..1 of the way from slice w to the next, row by row.
  void blend(double fraction, std::vector<std::uint8_t>& out) const;

 private:
  struct Offset {
    std::int32_t u, v;
    float mm;
  };
  /// A pixel whose tissue changes: fractions at which it leaves the lower slice's tissue and reaches the upper slice's.
  struct Change {
    std::uint32_t pixel;
    float leave, arrive;
    std::uint8_t between, upper;
  };

  /// Depth of a pixel in its tissue in the lower slice and in the upper one; distance in the lower slice to the upper
  /// slice's tissue and the reverse, up to the reach, mm; and the tissues nearest to it.
  struct Borders {
    float lower_depth, upper_depth, lower_away, upper_away;
    std::uint8_t beside_lower, beside_upper;
  };

  Change find_change(std::int64_t u, std::int64_t v, std::size_t pixel) const;
  Borders find_borders(std::int64_t u, std::int64_t v, std::uint8_t lower, std::uint8_t upper) const;
  float thickness_mm(const std::uint8_t* tissue, std::int64_t u, std::int64_t v) const;

  const TissueVolume& volume_;
  float half_pixel_mm_;
  float reach_mm_;
  std::vector<Offset> offsets_;  ///< By increasing distance, up to reach_mm_.
  const std::uint8_t* lower_ = nullptr;
  const std::uint8_t* upper_ = nullptr;
  std::vector<Change> changes_;
};

}  // namespace trocar::ultrasound::detail
