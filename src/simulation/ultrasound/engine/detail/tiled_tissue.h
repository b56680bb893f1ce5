#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound::detail {

/// A scene's voxels in cubes of 4 x 4 x 4, one cache line each: a scan plane crosses the rows of a plain volume and
/// would read a cache line for every voxel. The offset of a voxel is the sum of three parts, one per axis.
class TiledTissue {
 public:
  TiledTissue() = default;
  explicit TiledTissue(const AcousticScene& scene);

  std::int32_t part_i(std::int32_t i) const noexcept { return (i >> 2) * kTile + (i & 3); }
  std::int32_t part_j(std::int32_t j) const noexcept { return (j >> 2) * row_ + ((j & 3) << 2); }
  std::int32_t part_k(std::int32_t k) const noexcept { return (k >> 2) * slab_ + ((k & 3) << 4); }
  std::int32_t row() const noexcept { return row_; }
  std::int32_t slab() const noexcept { return slab_; }

  /// Tissue and kMixedCell of the voxel at an offset.
  std::uint8_t tissue(std::int32_t offset) const noexcept {
    return tissue_.data()->voxels.data()[offset];  // tiles lie end to end
  }
  /// Loads the tile of an offset, which may be negative, into the cache.
  void prefetch(std::int32_t offset) const noexcept {
    if (offset >= 0) __builtin_prefetch(tissue_.data()->voxels.data() + offset);
  }
  /// Texture in the middle of the cell from that voxel to the next.
  std::int8_t texture(std::int32_t offset) const noexcept {
    return static_cast<std::int8_t>(texture_.data()->voxels.data()[offset]);
  }
  /// Tissue of the whole tile around an offset; kMixedTile if the tile contains a border.
  std::uint8_t tile_tissue(std::int32_t offset) const noexcept { return whole_[static_cast<std::size_t>(offset >> 6)]; }
  bool has_texture() const noexcept { return !texture_.empty(); }

  static constexpr std::int32_t kTile = 64;
  static constexpr std::uint8_t kMixedTile = 0xff;

 private:
  struct alignas(64) Tile {
    std::array<std::uint8_t, kTile> voxels{};
  };
  std::int32_t row_ = 0, slab_ = 0;
  std::vector<Tile> tissue_, texture_;
  std::vector<std::uint8_t> whole_;
};

/// The eight voxels around a fractional index, and their weights.
struct CellCorners {
  std::array<std::int32_t, 8> offset;
  std::array<float, 8> weight;
  std::size_t nearest;
};
/// The index must lie in [0, size - 1).
inline CellCorners corners_at(const TiledTissue& tiles, float i, float j, float k) noexcept {
  const auto a = static_cast<std::int32_t>(i), b = static_cast<std::int32_t>(j), c = static_cast<std::int32_t>(k);
  const float u = i - static_cast<float>(a), v = j - static_cast<float>(b), w = k - static_cast<float>(c);
  const std::int32_t i_parts[2] = {tiles.part_i(a), tiles.part_i(a + 1)};
  const std::int32_t j_parts[2] = {tiles.part_j(b), tiles.part_j(b + 1)};
  const std::int32_t k_parts[2] = {tiles.part_k(c), tiles.part_k(c + 1)};
  const float i_weights[2] = {1.0F - u, u}, j_weights[2] = {1.0F - v, v}, k_weights[2] = {1.0F - w, w};
  CellCorners corners;
  for (std::size_t n = 0; n < 8; ++n) {
    corners.offset[n] = i_parts[n & 1U] + j_parts[(n >> 1) & 1U] + k_parts[n >> 2];
    corners.weight[n] = i_weights[n & 1U] * j_weights[(n >> 1) & 1U] * k_weights[n >> 2];
  }
  corners.nearest = (u > 0.5F ? 1U : 0U) | (v > 0.5F ? 2U : 0U) | (w > 0.5F ? 4U : 0U);
  return corners;
}

}  // namespace trocar::ultrasound::detail
