#include "ultrasound/engine/detail/scatterer_bricks.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace trocar::ultrasound::detail {
namespace {

std::uint64_t hash_of(const BrickIndex& brick) noexcept {
  const auto part = [&](std::size_t a, int shift) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(brick[a]) & 0x1fffffU) << shift;
  };
  return mix64(part(0, 0) | part(1, 21) | part(2, 42));
}

}  // namespace

std::vector<Brick> make_brick_library() {
  constexpr std::uint64_t kSeed = 0x7573;
  Random random(kSeed);
  std::vector<Brick> library(kBricks);
  for (Brick& brick : library) {
    for (std::size_t s = 0; s < kBrickScatterers; ++s) {
      // The first four are in a tetrahedron of octants, the first eight in all octants: any first part of a brick is
      // uniform.
      constexpr std::size_t kOctants[8] = {0, 3, 5, 6, 7, 4, 2, 1};
      const std::size_t octant = kOctants[s & 7U], quarter = s >> 3;
      const std::size_t i = 2 * (octant & 1U) + (quarter & 1U);
      const std::size_t j = 2 * ((octant >> 1) & 1U) + (((quarter >> 1) ^ quarter) & 1U);
      brick.x[s] = static_cast<float>((static_cast<double>(i) + random.uniform()) / 4.0 - 0.5);
      brick.y[s] = static_cast<float>((static_cast<double>(j) + random.uniform()) / 4.0 - 0.5);
      brick.z[s] = static_cast<float>((static_cast<double>(octant >> 2) + random.uniform()) / 2.0 - 0.5);
      const float sign = random.uniform() < 0.5 ? -1.0F : 1.0F;
      brick.rank[s] = sign * (static_cast<float>(s) + static_cast<float>(random.uniform())) / kBrickScatterers;
    }
  }
  return library;
}

PlacedBrick place_brick(const BrickIndex& index, const std::vector<Brick>& library, const Vec3f& middle_T,
                        const Eigen::Matrix3f& side_T) noexcept {
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const std::uint64_t hash = hash_of(index);
  const int* order = kOrders[(hash >> 16) % 6];
  PlacedBrick placed{};
  placed.brick = &library[hash % kBricks];
  float* const columns[3] = {placed.x, placed.y, placed.z};
  for (int c = 0; c < 3; ++c) {
    const float sign = ((hash >> (32 + c)) & 1U) != 0 ? -1.0F : 1.0F;
    for (int a = 0; a < 3; ++a) columns[c][a] = sign * side_T(a, order[c]);
  }
  for (int a = 0; a < 3; ++a) placed.middle[a] = middle_T[a];
  return placed;
}

}  // namespace trocar::ultrasound::detail
