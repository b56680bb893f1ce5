#include "ultrasound/engine/detail/scatterer_cell.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace trocar::ultrasound::detail {
namespace {

std::size_t sample_near(const ScanPlan& plan, float s) noexcept {
  return static_cast<std::size_t>(std::clamp(s, 0.0F, static_cast<float>(plan.samples - 1)));
}

/// Through the values at both ends and the middle.
void fit_parabola(const std::vector<float>& values, std::size_t first, std::size_t last,
                  float (&parabola)[3]) noexcept {
  const std::size_t middle = (first + last) / 2;
  const auto a = static_cast<float>(first), b = static_cast<float>(middle), c = static_cast<float>(last);
  const float slope = middle > first ? (values[middle] - values[first]) / (b - a) : 0.0F;
  const float next_slope = last > middle ? (values[last] - values[middle]) / (c - b) : slope;
  parabola[2] = last > first ? (next_slope - slope) / (c - a) : 0.0F;
  parabola[1] = slope - parabola[2] * (a + b);
  parabola[0] = values[first] - (parabola[1] + parabola[2] * a) * a;
}

void set_lines(const ScanPlan& plan, const FrameState& frame, std::size_t near, std::size_t far, Cell& cell) noexcept {
  float least = 0.0F, most = 0.0F;
  if (frame.widest_warp > 0.0F) {
    for (int line = std::max(cell.first_line - 1, 0); line <= std::min(cell.last_line, plan.lines - 1); ++line) {
      const float* bend = frame.bend_mm.data() + static_cast<std::size_t>(line) * plan.coarse_samples();
      for (std::size_t c = near / kCoarse; c <= far / kCoarse + 1; ++c) {
        least = std::min(least, bend[c]);
        most = std::max(most, bend[c]);
      }
    }
  }
  const double depth_mm = (static_cast<double>(near) + 0.5) * plan.geometry.sample_mm();
  const double spacing_mm = std::max(plan.geometry.line_spacing_mm(depth_mm), 0.02);
  cell.low_line = cell.first_line - 1.0 + static_cast<double>(least) / spacing_mm;
  cell.high_line = cell.last_line + 1.0 + static_cast<double>(most) / spacing_mm;
}

}  // namespace

Cell make_cell(const ScanPlan& plan, const FrameState& frame, int first, int last, float first_rest, float last_rest,
               float reach) noexcept {
  Cell cell{};
  cell.first_line = first;
  cell.last_line = last;
  cell.near_rest = first_rest - reach;
  cell.far_rest = last_rest + reach;
  const std::size_t near = sample_near(plan, cell.near_rest), far = sample_near(plan, cell.far_rest);
  cell.half_thickness_mm = kBeamEdge * std::max(plan.elevation_sigma_mm[near], plan.elevation_sigma_mm[far]);
  cell.most_rank = std::max(plan.most_rank[near], plan.most_rank[far]);
  cell.yields = frame.deepest_dent_mm > 0.0F && cell.near_rest < frame.dent_reach;
  fit_parabola(plan.speckle_scale, near, far, cell.speckle_scale);
  fit_parabola(plan.most_rank, near, far, cell.rank);
  fit_parabola(plan.inverse_elevation_sigma, near, far, cell.inverse_elevation_sigma);
  const ScanGeometry& g = plan.geometry;
  set_lines(plan, frame, near, far, cell);
  const double low_mm = (static_cast<double>(first_rest) + 0.5) * g.sample_mm(),
               high_mm = (static_cast<double>(last_rest) + 0.5) * g.sample_mm();
  const double lines[2] = {cell.low_line, cell.high_line};
  for (int side = 0; side < 2; ++side) {
    const double outwards = side == 0 ? -1.0 : 1.0;
    const double angle = (lines[side] - g.middle_line()) * g.line_step;
    cell.side_x[side] = static_cast<float>(outwards * (g.is_fan ? std::cos(angle) : 1.0));
    cell.side_y[side] = static_cast<float>(outwards * (g.is_fan ? -std::sin(angle) : 0.0));
    cell.side_d[side] = static_cast<float>(g.is_fan ? 0.0 : -outwards * angle);
  }
  const auto bound = [&](double mm) {
    return static_cast<float>(g.is_fan ? std::pow(std::max(g.radius_mm + mm, 0.0), 2) : mm);
  };
  cell.low = bound(low_mm);
  cell.high = bound(high_mm);
  return cell;
}

namespace {

CellBox bricks_of(const ScanPlan& plan, const FrameState& frame, const Eigen::AlignedBox3d& bounds) noexcept {
  const double reach_mm = frame.drag.reach_mm > 0.0F ? static_cast<double>(frame.drag.shift_T.norm()) : 0.0;
  const auto brick_of = [&](double mm) {
    return static_cast<std::int32_t>(std::floor(mm / static_cast<double>(plan.brick_mm)));
  };
  CellBox box{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    box.low[a] = brick_of(bounds.min()[axis] - reach_mm);
    box.high[a] = brick_of(bounds.max()[axis] + reach_mm);
  }
  return box;
}

}  // namespace

CellBox box_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept {
  Eigen::AlignedBox3d bounds_P;
  for (const double line : {cell.low_line, 0.5 * (cell.low_line + cell.high_line), cell.high_line}) {
    for (const float rest : {cell.near_rest, cell.far_rest}) {
      const Vec2 p = plan.geometry.to_cartesian({line, (static_cast<double>(rest) + 0.5) * plan.geometry.sample_mm()});
      for (const float z : {-cell.half_thickness_mm, cell.half_thickness_mm}) {
        bounds_P.extend(frame.X_PT * Vec3(p.x(), p.y(), static_cast<double>(z)));
      }
    }
  }
  return bricks_of(plan, frame, bounds_P);
}

CellAtRest rest_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept {
  constexpr int kPlaces = 5, kAcross = 3;
  const auto place_P = [&](int line, int depth, int across) -> Vec3 {
    const double share = static_cast<double>(line) / (kPlaces - 1);
    const double rest = std::lerp(static_cast<double>(cell.near_rest), static_cast<double>(cell.far_rest),
                                  static_cast<double>(depth) / (kPlaces - 1));
    const Vec2 p = plan.geometry.to_cartesian(
        {std::lerp(cell.low_line, cell.high_line, share), (rest + 0.5) * plan.geometry.sample_mm()});
    return frame.X_PT * Vec3(p.x(), p.y(), static_cast<double>(cell.half_thickness_mm) * (across - 1));
  };
  CellAtRest at_rest;
  at_rest.middle_P = place_P(kPlaces / 2, kPlaces / 2, kAcross / 2);
  at_rest.middle_A = frame.motion.to_rest(at_rest.middle_P);
  at_rest.jacobian = frame.motion.jacobian(at_rest.middle_A);
  Eigen::AlignedBox3d bounds_A;
  for (int line = 0; line < kPlaces; ++line) {
    for (int depth = 0; depth < kPlaces; ++depth) {
      for (int across = 0; across < kAcross; ++across) {
        const Vec3 p_P = place_P(line, depth, across), p_A = frame.motion.to_rest(p_P);
        bounds_A.extend(p_A);
        at_rest.slack_mm = std::max(at_rest.slack_mm, (at_rest.now_P(p_A) - p_P).norm());
      }
    }
  }
  at_rest.box = bricks_of(plan, frame, bounds_A);
  for (std::size_t a = 0; a < 3; ++a) {  // between the places
    --at_rest.box.low[a];
    ++at_rest.box.high[a];
  }
  return at_rest;
}

namespace {

/// Narrows first..last to the steps n with start + step * n <= most.
void stay_below(float start, float step, float most, int& first, int& last) noexcept {
  constexpr float kLevel = 1e-4F;
  if (std::abs(step) < kLevel) {
    if (start > most) last = first - 1;
    return;
  }
  const float end = std::clamp((most - start) / step, -1e6F, 1e6F);
  if (step > 0.0F)
    last = std::min(last, static_cast<int>(std::floor(end)));
  else
    first = std::max(first, static_cast<int>(std::ceil(end)));
}

float from_apex(const ScanPlan& plan, float y) noexcept {
  return y + (plan.geometry.is_fan ? static_cast<float>(plan.geometry.radius_mm) : 0.0F);
}

}  // namespace

BrickReach reach_of(const Cell& cell, const Eigen::Matrix3f& side_T, float more_mm) noexcept {
  BrickReach reach{};
  reach.across_mm = 0.5F * side_T.row(2).lpNorm<1>() + more_mm;
  for (int side = 0; side < 2; ++side)
    reach.side_mm[side] =
        0.5F * (cell.side_x[side] * side_T.row(0) + cell.side_y[side] * side_T.row(1)).lpNorm<1>() + more_mm;
  return reach;
}

void stay_in_cell(const ScanPlan& plan, const Cell& cell, const BrickReach& reach, const Vec3f& start_T,
                  const Vec3f& step_T, int& first, int& last) noexcept {
  const float half_mm = cell.half_thickness_mm + reach.across_mm;
  stay_below(start_T.z(), step_T.z(), half_mm, first, last);
  stay_below(-start_T.z(), -step_T.z(), half_mm, first, last);
  if (first > last) return;
  const float y = from_apex(plan, start_T.y());
  for (int side = 0; side < 2; ++side) {
    const float x_part = cell.side_x[side], y_part = cell.side_y[side];
    stay_below(start_T.x() * x_part + y * y_part + cell.side_d[side], step_T.x() * x_part + step_T.y() * y_part,
               reach.side_mm[side], first, last);
  }
}

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
