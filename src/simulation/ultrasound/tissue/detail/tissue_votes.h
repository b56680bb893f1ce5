#pragma once

#include <cstdint>
#include <vector>

#include "volume/grid.h"

namespace trocar::ultrasound::detail {

/// Source voxels of each target voxel along one axis, and their weights: a cubic B-spline as wide as the coarser of the
/// two spacings, so that borders are smooth and every source voxel contributes.
struct AxisTaps {
  int count = 0;                    ///< Number per target voxel.
  std::vector<std::int32_t> first;  ///< Source index of the first one.
  std::vector<float> weights;       ///< `count` weights per target voxel; their sum is 1.
};

/// Target voxel n lies at source index `offset + n * step` (step > 0, in source voxels).
AxisTaps make_taps(std::int64_t source_size, std::int64_t target_size, double offset, double step);

/// Tissue of a target slice by weighted votes of a finer source slice. Voxels of structures with a thickness of one or
/// two voxels have a larger weight, so that a wall keeps its thickness without holes.
class TissueVotes {
 public:
  TissueVotes(std::int64_t width, std::int64_t height, AxisTaps along_u, AxisTaps along_v);

  /// Sets the source slice, row by row; kNoTissue has no vote.
  void set_slice(const std::vector<std::uint8_t>& tissue);
  /// Tissue at a target voxel; kNoTissue without votes.
  std::uint8_t winner(std::size_t target_u, std::size_t target_v) noexcept;

 private:
  void find_uniform();
  void find_thin();
  bool is_thin_structure(std::int64_t u, std::int64_t v) const noexcept;

  std::int64_t width_, height_;
  AxisTaps along_u_, along_v_;
  const std::uint8_t* tissue_ = nullptr;
  std::vector<std::uint8_t> row_mixed_;     ///< Nonzero if `count` voxels from here along u differ.
  std::vector<std::uint8_t> window_mixed_;  ///< The same for windows of along_u_.count x along_v_.count.
  std::vector<std::uint8_t> thin_;          ///< 1 or 2: thickness in voxels; 0: thicker.
  std::vector<std::uint8_t> boost_;         ///< Index into the factors of the votes.
  std::vector<float> votes_;
};

}  // namespace trocar::ultrasound::detail
