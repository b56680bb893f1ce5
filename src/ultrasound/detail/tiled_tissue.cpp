#include "ultrasound/detail/tiled_tissue.h"

#include <algorithm>

#include "core/check.h"
#include "core/parallel.h"

namespace trocar::detail {

TiledTissue::TiledTissue(const AcousticScene& scene) {
  const auto& size = scene.geometry.size;
  const auto tiles = [&](std::size_t a) { return static_cast<std::int32_t>((size[a] + 3) / 4); };
  row_ = tiles(0) * kTile;
  slab_ = row_ * tiles(1);
  const std::int64_t voxels = static_cast<std::int64_t>(slab_) * tiles(2);
  TROCAR_CHECK(voxels < std::int64_t{1} << 31);
  const auto count = static_cast<std::size_t>(voxels / kTile);
  tissue_.resize(count);
  if (!scene.texture.empty()) texture_.resize(count);
  parallel_for(static_cast<std::size_t>(tiles(2)), 1, [&](std::size_t first, std::size_t last) {
    for (auto k = static_cast<std::int64_t>(4 * first);
         k < std::min<std::int64_t>(static_cast<std::int64_t>(4 * last), size[2]); ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        const std::size_t from = scene.geometry.offset({0, j, k});
        const std::int32_t row = part_j(static_cast<std::int32_t>(j)) + part_k(static_cast<std::int32_t>(k));
        for (std::int32_t i = 0; i < static_cast<std::int32_t>(size[0]); ++i) {
          const auto to = static_cast<std::size_t>(row + part_i(i));
          tissue_[to / kTile].voxels[to % kTile] = scene.tissue[from + static_cast<std::size_t>(i)];
          if (!texture_.empty())
            texture_[to / kTile].voxels[to % kTile] =
                static_cast<std::uint8_t>(scene.texture[from + static_cast<std::size_t>(i)]);
        }
      }
    }
  });
  whole_.resize(count);
  parallel_for(count, 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t) {
      const auto& of_tile = tissue_[t].voxels;
      const bool is_whole =
          (of_tile[0] & kMixedCell) == 0 &&
          std::all_of(of_tile.begin(), of_tile.end(), [&](std::uint8_t v) { return v == of_tile[0]; });
      whole_[t] = is_whole ? of_tile[0] : kMixedTile;
    }
  });
}

CellCorners corners_at(const TiledTissue& tiles, float i, float j, float k) noexcept {
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

}  // namespace trocar::detail
