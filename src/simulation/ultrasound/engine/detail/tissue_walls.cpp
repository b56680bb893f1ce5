#include "ultrasound/engine/detail/tissue_walls.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::ultrasound::detail {
namespace {

constexpr float kLeastFacing = 0.05F;

/// Share of a tissue in the eight voxels around a fractional index, 0..1.
float tissue_share_at(const FrameState& frame, std::uint8_t tissue, const Vec3& index) noexcept {
  std::array<float, 3> at{};
  for (std::size_t a = 0; a < 3; ++a)
    at[a] = std::clamp(static_cast<float>(index[static_cast<Eigen::Index>(a)]), 0.0F,
                       static_cast<float>(frame.scene->geometry.size[a] - 1) - 1e-3F);
  const CellCorners corners = corners_at(frame.tiles, at[0], at[1], at[2]);
  float share = 0.0F;
  for (std::size_t n = 0; n < 8; ++n)
    if ((frame.tiles.tissue(corners.offset[n]) & ~kMixedCell) == tissue) share += corners.weight[n];
  return share;
}

/// Cosine between the scanline and the normal of the surface of `inside`, at least kLeastFacing.
float facing(const FrameState& frame, const LineWalk& line, std::uint8_t inside, const Border& border) noexcept {
  constexpr double kReach = 0.87;  // voxels along each axis, 1.5 from the border
  const Vec3 corners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const Vec3 spacing_mm = frame.scene->geometry.spacing_mm;
  const Vec3 along = Vec3(line.along[0], line.along[1], line.along[2]).cwiseProduct(spacing_mm);
  Vec3 slope = Vec3::Zero();
  for (const Vec3& corner : corners)
    slope += static_cast<double>(tissue_share_at(
                 frame, inside, Vec3(border.index[0], border.index[1], border.index[2]) + kReach * corner)) *
             corner;
  slope = slope.cwiseQuotient(spacing_mm);
  const double size = slope.norm();
  if (!(size > 1e-6)) return 1.0F;
  return static_cast<float>(std::max(static_cast<double>(kLeastFacing), std::abs(slope.dot(along)) / size));
}

/// Logarithm of the wall's amplitude at a distance from the border, in thicknesses: even, with a soft edge.
float log_profile(float share) noexcept {
  constexpr float kEven = 0.7F;
  const float t = (share - kEven) / (1.0F - kEven);
  return t <= 0.0F ? 0.0F : -8.0F * t * t;
}

}  // namespace

void add_walls(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, WalkResult& walk,
               const Texture& texture) noexcept {
  for (int b = 0; b < walk.border_count; ++b) {
    const Border& border = walk.borders[static_cast<std::size_t>(b)];
    const std::uint8_t number =
        plan.wall_at[static_cast<std::size_t>(border.before & 127U) * kTissues + (border.behind & 127U)];
    if (number == 0) continue;
    const WallRow& wall = plan.walls[number - 1U];
    constexpr float kMostOblique = 0.35F;  // a wall is at most that much longer along the scanline
    const float cosine = facing(frame, line, wall.is_behind ? border.before : border.behind, border);
    const float samples = wall.thickness_mm / (std::max(cosine, kMostOblique) * plan.sample_mm);
    const float log_wall = border.log_gain + wall.log_b + std::log(cosine);
    const float begin = wall.is_behind ? border.walk : border.walk - samples;
    const int first = std::max(0, static_cast<int>(std::ceil(begin)));
    const int last = std::min(plan.samples - 1, static_cast<int>(std::floor(begin + samples)));
    for (int n = first; n <= last; ++n) {
      const auto s = static_cast<std::size_t>(n);
      const float log_gain = log_wall + log_profile(std::abs(static_cast<float>(n) - border.walk) / samples);
      if (log_gain <= walk.log_gain[s] + texture.added[s]) continue;
      walk.log_gain[s] = log_gain - texture.added[s];
      walk.share[s] = 0;  // fully developed
    }
  }
}

}  // namespace trocar::ultrasound::detail
