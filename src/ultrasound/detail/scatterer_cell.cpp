#include "ultrasound/detail/scatterer_cell.h"

#include <algorithm>
#include <cmath>

namespace trocar::detail {
namespace {

std::size_t sample_near(const ScanPlan& plan, float s) noexcept {
  return static_cast<std::size_t>(std::clamp(s, 0.0F, static_cast<float>(plan.samples - 1)));
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

Cell make_cell(const ScanPlan& plan, const FrameState& frame, int first, int last, float first_rest,
               float last_rest) noexcept {
  Cell cell{};
  cell.first_line = first;
  cell.last_line = last;
  cell.first_rest = first_rest;
  cell.last_rest = last_rest;
  const std::size_t near = sample_near(plan, first_rest), far = sample_near(plan, last_rest);
  cell.half_thickness_mm = kBeamEdge * std::max(plan.elevation_sigma_mm[near], plan.elevation_sigma_mm[far]);
  cell.most_rank = std::max(plan.most_rank[near], plan.most_rank[far]);
  const auto line_through = [&](const std::vector<float>& values, float(&line)[2]) {
    line[1] = far > near ? (values[far] - values[near]) / static_cast<float>(far - near) : 0.0F;
    line[0] = values[near] - line[1] * static_cast<float>(near);
  };
  line_through(plan.speckle_scale, cell.speckle_scale);
  line_through(plan.most_rank, cell.rank);
  const ScanGeometry& g = plan.geometry;
  set_lines(plan, frame, near, far, cell);
  const double low_mm = (static_cast<double>(first_rest) + 0.4) * g.sample_mm(),
               high_mm = (static_cast<double>(last_rest) + 0.6) * g.sample_mm();
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

CellBox box_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept {
  CellBox box{};
  Vec3 low = Vec3::Constant(1e30), high = Vec3::Constant(-1e30);
  for (const double line : {cell.low_line, 0.5 * (cell.low_line + cell.high_line), cell.high_line}) {
    for (const float rest : {cell.first_rest, cell.last_rest}) {
      const Vec2 p = plan.geometry.to_cartesian({line, (static_cast<double>(rest) + 0.5) * plan.geometry.sample_mm()});
      for (const float z : {-cell.half_thickness_mm, cell.half_thickness_mm}) {
        const Vec3 p_P = frame.X_PT * Vec3(p.x(), p.y(), static_cast<double>(z));
        low = low.cwiseMin(p_P);
        high = high.cwiseMax(p_P);
      }
    }
  }
  const double reach_mm = frame.drag.reach_mm > 0.0F ? static_cast<double>(frame.drag.shift_T.norm()) : 0.0;
  const auto brick_of = [&](double mm) {
    return static_cast<std::int32_t>(std::floor(mm / static_cast<double>(plan.brick_mm)));
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    box.low[a] = brick_of(low[axis] - reach_mm);
    box.high[a] = brick_of(high[axis] + reach_mm);
  }
  return box;
}

void stay_in_beam(float start, float step, float half_mm, int& first, int& last) noexcept {
  if (std::abs(step) < 1e-4F) {
    if (std::abs(start) > half_mm) last = first - 1;
    return;
  }
  const float a = (-half_mm - start) / step, b = (half_mm - start) / step;
  first = std::max(first, static_cast<int>(std::ceil(std::min(a, b))));
  last = std::min(last, static_cast<int>(std::floor(std::max(a, b))));
}

bool comes_near(const ScanPlan& plan, const Cell& cell, const Vec3f& middle_T, float radius_mm) noexcept {
  if (std::abs(middle_T.z()) > cell.half_thickness_mm + radius_mm) return false;
  const bool is_fan = plan.geometry.is_fan;
  const float y = middle_T.y() + (is_fan ? static_cast<float>(plan.geometry.radius_mm) : 0.0F);
  for (int side = 0; side < 2; ++side)
    if (middle_T.x() * cell.side_x[side] + y * cell.side_y[side] + cell.side_d[side] > radius_mm) return false;
  if (!is_fan) return y > cell.low - radius_mm && y < cell.high + radius_mm;
  const float far = std::sqrt(middle_T.x() * middle_T.x() + y * y);
  return far > std::sqrt(cell.low) - radius_mm && far < std::sqrt(cell.high) + radius_mm;
}

}  // namespace trocar::detail
