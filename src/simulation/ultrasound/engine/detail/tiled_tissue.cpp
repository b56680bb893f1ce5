#include "ultrasound/engine/detail/tiled_tissue.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/result.h"

namespace trocar::ultrasound::detail {

namespace {

/// Mean texture of the cell from that voxel to the next along i, j and k: that of the cell's centre.
std::int8_t mean_texture(const AcousticScene& scene, const volume::Index3& voxel) {
  const volume::GridGeometry& grid = scene.geometry;
  int sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    volume::Index3 at = voxel;
    for (std::size_t a = 0; a < 3; ++a) at[a] = std::min(at[a] + ((corner >> a) & 1), grid.size[a] - 1);
    sum += scene.texture[grid.offset(at)];
  }
  return static_cast<std::int8_t>((sum + (sum < 0 ? -4 : 4)) / 8);
}

}  // namespace

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
            texture_[to / kTile].voxels[to % kTile] = static_cast<std::uint8_t>(mean_texture(scene, {i, j, k}));
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

}  // namespace trocar::ultrasound::detail
