#include "volume/detail/near_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/parallel.h"

namespace trocar::volume::detail {
namespace {

constexpr std::size_t kMostRows = 150;    ///< Beyond it the distance transform is about as fast.
constexpr std::uint8_t kMostReach = 255;  ///< Voxels along a row.

/// A row of the ball: the voxels -reach..reach, j and k rows away.
struct BallRow {
  std::int64_t j = 0, k = 0;
  std::uint8_t reach = 0;
};

std::optional<std::vector<BallRow>> rows_of_ball(const Vec3& spacing_mm, double radius_mm) {
  const Vec3 reach = radius_mm * spacing_mm.cwiseInverse();
  if (reach.x() >= kMostReach || reach.y() * reach.z() > static_cast<double>(kMostRows)) return std::nullopt;
  std::vector<BallRow> rows;
  const auto last_j = static_cast<std::int64_t>(reach.y()), last_k = static_cast<std::int64_t>(reach.z());
  for (std::int64_t k = -last_k; k <= last_k; ++k)
    for (std::int64_t j = -last_j; j <= last_j; ++j) {
      const double across_mm =
          std::hypot(static_cast<double>(j) * spacing_mm.y(), static_cast<double>(k) * spacing_mm.z());
      if (across_mm > radius_mm) continue;
      const double along_mm = std::sqrt(radius_mm * radius_mm - across_mm * across_mm);
      rows.push_back({j, k, static_cast<std::uint8_t>(along_mm / spacing_mm.x())});
    }
  if (rows.size() > kMostRows) return std::nullopt;
  return rows;
}

/// Replaces a row of a mask by the distances to its nearest set voxel, at most kMostReach. False if none is set.
bool to_distances(std::span<std::uint8_t> row) {
  std::uint8_t last = kMostReach;
  for (std::uint8_t& voxel : row) {
    last = voxel != 0 ? 0 : static_cast<std::uint8_t>(std::min<int>(last + 1, kMostReach));
    voxel = last;
  }
  last = kMostReach;
  bool has_set = false;
  for (auto voxel = row.rbegin(); voxel != row.rend(); ++voxel) {
    last = static_cast<std::uint8_t>(std::min<int>(last + 1, *voxel));
    *voxel = last;
    has_set = has_set || last == 0;
  }
  return has_set;
}

}  // namespace

std::optional<MaskGrid> find_near(const MaskGrid& mask, double radius_mm) {
  const std::optional<std::vector<BallRow>> ball = rows_of_ball(mask.geometry.spacing_mm, radius_mm);
  if (!ball) return std::nullopt;
  const auto& size = mask.geometry.size;
  const auto length = static_cast<std::size_t>(size[0]);
  const auto rows = static_cast<std::size_t>(size[1] * size[2]);
  MaskGrid distances = mask;
  std::vector<std::uint8_t> has_set(rows);
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r)
      has_set[r] = to_distances(std::span(distances.voxels).subspan(r * length, length)) ? 1 : 0;
  });
  MaskGrid near(mask.geometry);
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      const Index3 at = mask.geometry.index_of(r * length);
      for (const BallRow& row : *ball) {
        const std::int64_t j = at[1] + row.j, k = at[2] + row.k;
        if (j < 0 || j >= size[1] || k < 0 || k >= size[2]) continue;
        const auto other = static_cast<std::size_t>(k * size[1] + j);
        if (has_set[other] == 0) continue;
        const std::uint8_t* from = distances.voxels.data() + other * length;
        std::uint8_t* to = near.voxels.data() + r * length;
        for (std::size_t i = 0; i < length; ++i) to[i] |= from[i] <= row.reach ? std::uint8_t{1} : std::uint8_t{0};
      }
    }
  });
  return near;
}

}  // namespace trocar::volume::detail
