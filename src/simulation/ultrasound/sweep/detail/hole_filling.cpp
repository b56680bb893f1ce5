#include "ultrasound/sweep/detail/hole_filling.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/parallel.h"

namespace trocar::ultrasound::detail {
namespace {

/// The 13 lines through a voxel and its neighbours.
constexpr std::array<std::array<int, 3>, 13> kSticks{{{1, 0, 0},
                                                      {0, 1, 0},
                                                      {0, 0, 1},
                                                      {1, 1, 0},
                                                      {1, 0, 1},
                                                      {0, 1, 1},
                                                      {1, -1, 0},
                                                      {1, 0, -1},
                                                      {0, 1, -1},
                                                      {1, 1, 1},
                                                      {-1, 1, 1},
                                                      {1, -1, 1},
                                                      {-1, -1, 1}}};

/// Known voxels before filling.
struct Known {
  const volume::GridGeometry& grid;
  const std::vector<std::uint8_t>& is_known;
  const std::vector<std::uint8_t>& gray;
};

/// Steps from ijk along a direction that stay in the grid (sign -1: opposite direction).
int room(const volume::GridGeometry& grid, const volume::Index3& ijk, const std::array<int, 3>& direction, int sign) {
  std::int64_t steps = std::numeric_limits<int>::max();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int d = sign * direction[axis];
    if (d != 0) steps = std::min(steps, d > 0 ? grid.size[axis] - 1 - ijk[axis] : ijk[axis]);
  }
  return static_cast<int>(steps);
}

/// Steps to the first known voxel, 0 if there is none among the next `limit`.
int steps_to_known(const Known& known, std::int64_t from, std::int64_t stride, int limit) {
  for (int n = 1; n <= limit; ++n)
    if (known.is_known[static_cast<std::size_t>(from + n * stride)] != 0) return n;
  return 0;
}

struct StickValue {
  int length2 = 0;  ///< Squared length of the stick in voxels, including both ends.
  double gray = 0.0;
};

/// The stick through a hole, if it meets known voxels on both sides and is at most `longest` voxels long.
std::optional<StickValue> find_stick(const Known& known, const volume::Index3& ijk, const std::array<int, 3>& stick,
                                     int longest) {
  const volume::GridGeometry& grid = known.grid;
  const auto from = static_cast<std::int64_t>(grid.offset(ijk));
  const std::int64_t stride = (stick[2] * grid.size[1] + stick[1]) * grid.size[0] + stick[0];
  const int ahead = steps_to_known(known, from, stride, std::min(longest - 2, room(grid, ijk, stick, 1)));
  if (ahead == 0) return std::nullopt;
  const int behind = steps_to_known(known, from, -stride, std::min(longest - 1 - ahead, room(grid, ijk, stick, -1)));
  if (behind == 0) return std::nullopt;
  const double gray_ahead = known.gray[static_cast<std::size_t>(from + ahead * stride)];
  const double gray_behind = known.gray[static_cast<std::size_t>(from - behind * stride)];
  const int length = ahead + behind + 1;
  const int step2 = stick[0] * stick[0] + stick[1] * stick[1] + stick[2] * stick[2];
  return StickValue{length * length * step2, (behind * gray_ahead + ahead * gray_behind) / (ahead + behind)};
}

std::optional<double> fill_by_sticks(const Known& known, const volume::Index3& ijk, const HoleFilling& way) {
  std::array<StickValue, kSticks.size()> found;
  std::size_t count = 0;
  int shortest2 = std::numeric_limits<int>::max();
  for (const auto& stick : kSticks) {
    int longest = way.stick_length_limit;
    const int step2 = stick[0] * stick[0] + stick[1] * stick[1] + stick[2] * stick[2];
    // If only one stick is needed, longer ones than the best so far are not searched.
    if (way.sticks == 1)
      while (longest * longest * step2 > shortest2) --longest;
    const auto value = find_stick(known, ijk, stick, longest);
    if (!value) continue;
    shortest2 = std::min(shortest2, value->length2);
    found[count++] = *value;
  }
  std::stable_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
                   [](const StickValue& a, const StickValue& b) { return a.length2 < b.length2; });
  double sum = 0.0, weights = 0.0;
  for (std::size_t n = 0; n < count; ++n) {
    if (n >= static_cast<std::size_t>(way.sticks) && found[n].length2 != found[n - 1].length2) break;
    const double weight = 1.0 / std::sqrt(found[n].length2);
    sum += weight * found[n].gray;
    weights += weight;
  }
  return weights > 0.0 ? std::optional(sum / weights) : std::nullopt;
}

/// Known voxels of the cube of half edge `radius`: count, weights and weighted gray.
struct CubeSum {
  std::size_t count = 0;
  double weights = 0.0, gray = 0.0;
};

template <class Weight>
CubeSum sum_cube(const Known& known, const volume::Index3& ijk, int radius, Weight weight_of) {
  CubeSum sum;
  volume::Index3 low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::max<std::int64_t>(ijk[axis] - radius, 0);
    high[axis] = std::min<std::int64_t>(ijk[axis] + radius, known.grid.size[axis] - 1);
  }
  for (std::int64_t k = low[2]; k <= high[2]; ++k)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t i = low[0]; i <= high[0]; ++i) {
        const std::size_t n = known.grid.offset({i, j, k});
        if (known.is_known[n] == 0) continue;
        const double weight = weight_of(i - ijk[0], j - ijk[1], k - ijk[2]);
        ++sum.count;
        sum.weights += weight;
        sum.gray += weight * known.gray[n];
      }
  return sum;
}

std::optional<double> fill_by_nearest(const Known& known, const volume::Index3& ijk, const HoleFilling& way) {
  CubeSum sum;
  for (int radius = 1; radius <= (way.size - 1) / 2 && sum.count == 0; ++radius)
    sum = sum_cube(known, ijk, radius, [](auto, auto, auto) { return 1.0; });
  if (sum.count == 0 || static_cast<double>(sum.count) <= way.least_share * std::pow(way.size, 3)) return std::nullopt;
  return sum.gray / sum.weights;
}

std::optional<double> fill_by_gaussian(const Known& known, const volume::Index3& ijk, const HoleFilling& way) {
  const double scale = -0.5 / (way.sigma_voxels * way.sigma_voxels);
  const CubeSum sum = sum_cube(known, ijk, (way.size - 1) / 2, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return std::exp(scale * static_cast<double>(i * i + j * j + k * k));
  });
  if (sum.weights <= 0.0 || static_cast<double>(sum.count) <= way.least_share * std::pow(way.size, 3))
    return std::nullopt;
  return sum.gray / sum.weights;
}

std::optional<double> fill_by(const HoleFilling& way, const Known& known, const volume::Index3& ijk) {
  switch (way.kind) {
    case HoleFilling::Kind::kNearest:
      return fill_by_nearest(known, ijk, way);
    case HoleFilling::Kind::kGaussian:
      return fill_by_gaussian(known, ijk, way);
    case HoleFilling::Kind::kStick:
      break;
  }
  return fill_by_sticks(known, ijk, way);
}

/// Blocks of 4³ voxels with known voxels within reach: most of a sweep's box is empty and needs no search.
class NearBlocks {
 public:
  NearBlocks(const volume::GridGeometry& grid, const std::vector<std::uint8_t>& is_known, std::int64_t reach) {
    for (std::size_t axis = 0; axis < 3; ++axis) blocks_[axis] = (grid.size[axis] + kEdge - 1) / kEdge;
    is_near_.assign(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]), 0);
    std::size_t n = 0;
    for (std::int64_t k = 0; k < grid.size[2]; ++k)
      for (std::int64_t j = 0; j < grid.size[1]; ++j)
        for (std::int64_t i = 0; i < grid.size[0]; ++i, ++n)
          if (is_known[n] != 0) is_near_[block_of({i, j, k})] = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) spread(axis, (reach + kEdge - 1) / kEdge);
  }
  bool is_near(const volume::Index3& ijk) const { return is_near_[block_of(ijk)] != 0; }

 private:
  static constexpr std::int64_t kEdge = 4;

  std::size_t block_of(const volume::Index3& ijk) const {
    return static_cast<std::size_t>((ijk[2] / kEdge * blocks_[1] + ijk[1] / kEdge) * blocks_[0] + ijk[0] / kEdge);
  }
  void spread(std::size_t axis, std::int64_t distance) {
    const std::vector<std::uint8_t> before = is_near_;
    const std::int64_t stride = axis == 0 ? 1 : axis == 1 ? blocks_[0] : blocks_[0] * blocks_[1];
    for (std::size_t n = 0; n < before.size(); ++n) {
      if (before[n] == 0) continue;
      const std::int64_t at = static_cast<std::int64_t>(n) / stride % blocks_[axis];
      const std::int64_t low = std::max<std::int64_t>(at - distance, 0) - at;
      const std::int64_t high = std::min(at + distance, blocks_[axis] - 1) - at;
      for (std::int64_t d = low; d <= high; ++d)
        is_near_[static_cast<std::size_t>(static_cast<std::int64_t>(n) + d * stride)] = 1;
    }
  }

  volume::Index3 blocks_{};
  std::vector<std::uint8_t> is_near_;
};

std::int64_t reach_of(const std::vector<HoleFilling>& ways) {
  int reach = 0;
  for (const HoleFilling& way : ways)
    reach = std::max(reach, way.kind == HoleFilling::Kind::kStick ? way.stick_length_limit - 2 : (way.size - 1) / 2);
  return reach;
}

std::size_t fill_holes_in_slice(const Known& known, const NearBlocks& near_blocks, const std::vector<HoleFilling>& ways,
                                std::int64_t k, std::vector<std::uint8_t>& filled) {
  std::size_t count = 0;
  for (std::int64_t j = 0; j < known.grid.size[1]; ++j) {
    for (std::int64_t i = 0; i < known.grid.size[0]; ++i) {
      const std::size_t n = known.grid.offset({i, j, k});
      if (known.is_known[n] != 0 || !near_blocks.is_near({i, j, k})) continue;
      std::optional<double> value;
      for (std::size_t way = 0; way < ways.size() && !value; ++way) value = fill_by(ways[way], known, {i, j, k});
      if (!value) continue;
      filled[n] = static_cast<std::uint8_t>(*value + 0.5);
      ++count;
    }
  }
  return count;
}

}  // namespace

std::size_t fill_holes(volume::LabelGrid& gray, const std::vector<std::uint8_t>& known,
                       const std::vector<HoleFilling>& ways) {
  if (ways.empty() || gray.empty()) return 0;
  const NearBlocks near_blocks(gray.geometry, known, reach_of(ways));
  std::vector<std::uint8_t> filled = gray.voxels;
  const Known before{gray.geometry, known, gray.voxels};
  std::atomic<std::size_t> count = 0;
  parallel_for(static_cast<std::size_t>(gray.geometry.size[2]), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      count += fill_holes_in_slice(before, near_blocks, ways, static_cast<std::int64_t>(k), filled);
  });
  gray.voxels = std::move(filled);
  return count;
}

}  // namespace trocar::ultrasound::detail
