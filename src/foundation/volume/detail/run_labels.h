#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace trocar::volume::detail {

/// A box of voxels to be labelled, i running fastest.
struct Block {
  std::size_t columns = 0;  ///< Along i.
  std::size_t rows = 0;     ///< Along j.
  std::size_t planes = 0;   ///< Along k.
};

/// A run of equal voxels along i.
struct Run {
  std::uint32_t first;
  std::uint32_t last;       ///< Inclusive.
  std::uint32_t component;  ///< 0-based, in order of first appearance.

  std::size_t length() const noexcept { return std::size_t{last} - first + 1; }
};

/// The 6-connected components of a block as runs, which are much fewer than voxels.
struct RunLabels {
  Block block;
  std::vector<Run> runs;               ///< Row by row.
  std::vector<std::size_t> row_begin;  ///< Runs of row r (= k * rows + j): row_begin[r] .. row_begin[r + 1].
  std::size_t component_count = 0;

  std::span<const Run> row(std::size_t r) const {
    return {runs.data() + row_begin[r], row_begin[r + 1] - row_begin[r]};
  }
};

/// Labels the voxels that are set (`of_set`) or the voxels that are not set.
RunLabels label_runs(std::span<const std::uint8_t> voxels, const Block& block, bool of_set);

}  // namespace trocar::volume::detail
