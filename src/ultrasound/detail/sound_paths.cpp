#include "ultrasound/detail/sound_paths.h"

#include <algorithm>
#include <cmath>

namespace trocar::detail {
namespace {

/// A border that reflects more than this (amplitude) from a tissue far lighter than water is gas: it can mirror.
constexpr float kMirrorReflection = 0.6F;
/// What a mirror gives back of what falls on it, twice over a surface that is never quite smooth (assumed).
constexpr float kMirrorShare = 0.5F;

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Outward normal of the impedance's change, unit, in voxel-mm axes of the scene; zero where nothing changes.
Vec3 normal_at(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, const Vec3& index) noexcept {
  constexpr float kReach = 1.5F;  // voxels
  Vec3 slope = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    Vec3 step = Vec3::Zero();
    step[a] = kReach;
    const Vec3 high = index + step, low = index - step;
    const auto z_at = [&](const Vec3& p) {
      return blend_at(frame, rows, static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()))
          .row.log_z;
    };
    slope[a] = static_cast<double>(z_at(high) - z_at(low)) / frame.scene->geometry.spacing_mm[a];
  }
  const double size = slope.norm();
  return size > 1e-6 ? Vec3(slope / size) : Vec3(Vec3::Zero());
}

/// The mirror that stands where a scanline meets gas; its side away from the transducer shows what lies before it.
void set_mirror(const ScanPlan& plan, FrameState& frame, LineWalk& line, const WalkResult& walk,
                const Border& border) noexcept {
  const AcousticScene& scene = *frame.scene;
  const auto at = static_cast<std::size_t>(std::clamp(border.walk, 0.0F, static_cast<float>(plan.samples - 1)));
  const Vec3 index(walk.index[0][at], walk.index[1][at], walk.index[2][at]);
  const Vec3 spacing = scene.geometry.spacing_mm;
  const auto in_mm = [&](const std::array<float, 3>& v) { return Vec3(Vec3(v[0], v[1], v[2]).cwiseProduct(spacing)); };
  const Vec3 along = in_mm(line.along);
  Vec3 normal = -normal_at(frame, plan.rows, index);  // impedance falls into gas: along the sound
  const double facing = normal.dot(along);
  if (facing < 0.2) return;
  const Vec3 origin = in_mm(line.origin), place = index.cwiseProduct(spacing);
  line.mirror = {static_cast<float>((origin - place).dot(normal)), static_cast<float>(along.dot(normal)),
                 static_cast<float>(in_mm(frame.elevation).dot(normal)),
                 static_cast<float>(in_mm(line.lateral).dot(normal))};
  line.mirror_normal = floats(2.0 * normal.cwiseQuotient(spacing));
  line.mirror_depth_mm = (border.walk + 0.5F) * plan.sample_mm;
  line.mirror_reflection = border.reflection;
  line.mirror_before = border.before;
  line.mirror_behind = border.behind;
  const float rough = plan.roughness[border.behind];
  line.mirror_gain = kMirrorShare * (1.0F - rough) * std::abs(border.reflection);
}

}  // namespace

void aim_lines(const ScanPlan& plan, FrameState& frame) noexcept {
  const GridGeometry& grid = frame.scene->geometry;
  const Mat3 index_of_T = grid.spacing_mm.cwiseInverse().asDiagonal() * Mat3(grid.R_PV.transpose() * frame.X_PT.R());
  const Vec3 index_of_origin = grid.to_index(frame.X_PT.p());
  frame.elevation = floats(index_of_T.col(2));
  frame.deepest_dent_mm = 0.0F;
  for (int l = 0; l < plan.lines; ++l) {
    const Vec2 origin = plan.geometry.line_origin(l), along = plan.geometry.line_direction(l);
    const auto at = static_cast<std::size_t>(l);
    const LineContact& contact = frame.contact[at];
    LineWalk line;
    line.origin = floats(index_of_origin + index_of_T * Vec3(origin.x(), origin.y(), 0.0));
    line.along = floats(index_of_T * Vec3(along.x(), along.y(), 0.0));
    line.lateral = floats(index_of_T * Vec3(along.y(), -along.x(), 0.0));
    line.pressed_mm = contact.pressed_mm;
    line.coupling = plan.acquisition.artefacts.contact_loss ? contact.coupling : 1.0F;
    frame.walks[at] = line;
    frame.pressed_samples[at] = contact.pressed_mm / plan.sample_mm;
    frame.deepest_dent_mm = std::max(frame.deepest_dent_mm, contact.pressed_mm);
  }
}

void probe_lines(const ScanPlan& plan, FrameState& frame, WalkResult& scratch, int first, int last) noexcept {
  const auto coarse = plan.coarse_samples();
  std::fill_n(scratch.sideways_mm.begin(), plan.samples + kCoarse, 0.0F);
  for (int l = first; l < last; ++l) {
    LineWalk& line = frame.walks[static_cast<std::size_t>(l)];
    walk_line(plan, frame, line, 0.0F, scratch, frame.delay.data() + static_cast<std::ptrdiff_t>(l) * plan.samples);
    float* way = frame.probed_way.data() + static_cast<std::size_t>(l) * coarse;
    float* slowness = frame.slowness.data() + static_cast<std::size_t>(l) * coarse;
    for (std::size_t c = 0; c < coarse; ++c) {
      const std::size_t s = std::min(c * kCoarse, static_cast<std::size_t>(plan.samples - 1));
      const auto& row = plan.rows[scratch.tissue[s]];
      constexpr float kBendable = 0.15F;  // gas and bone let nothing through that could be seen
      way[c] = scratch.log_way[s];
      slowness[c] = std::abs(row.delay) < kBendable ? row.delay : 0.0F;
    }
    if (!plan.acquisition.artefacts.mirror) continue;
    for (int b = 0; b < scratch.border_count; ++b) {
      const Border& border = scratch.borders[static_cast<std::size_t>(b)];
      if (border.reflection > -kMirrorReflection) continue;
      set_mirror(plan, frame, line, scratch, border);
      break;
    }
  }
}

namespace {

/// A beam is as wide as its aperture near the face and narrow at its focus: what is smaller than that hardly bends or
/// shades it. Scanlines to either side over which a depth is averaged; `share` of the beam's width there.
int half_width(const ScanPlan& plan, std::size_t c, double share) noexcept {
  const double depth_mm = static_cast<double>(c) * kCoarse * static_cast<double>(plan.sample_mm);
  const double width_mm = share * plan.beam.aperture_mm * std::abs(1.0 - depth_mm / plan.beam.focus_mm);
  constexpr double kLeast_mm = 1.2, kMost_mm = 10.0;
  const double spacing_mm = plan.geometry.line_spacing_mm(depth_mm);
  return std::clamp(static_cast<int>(std::clamp(width_mm, kLeast_mm, kMost_mm) / spacing_mm), 1, 64);
}
constexpr double kBendingShare = 0.5;
constexpr double kShadingShare = 0.2;  // the echo's own aperture is apodised (assumed)

/// Means over scanlines l - half .. l + half at one depth, from running sums.
template <class Value, class Take>
void average_lines(const ScanPlan& plan, int half, const Value& value, const Take& take) noexcept {
  const int lines = plan.lines;
  float sum = 0.0F;
  for (int l = 0; l < std::min(half, lines); ++l) sum += value(l);
  for (int l = 0; l < lines; ++l) {
    if (l + half < lines) sum += value(l + half);
    if (l - half - 1 >= 0) sum -= value(l - half - 1);
    const int count = std::min(l + half, lines - 1) - std::max(l - half, 0) + 1;
    take(l, sum / static_cast<float>(count));
  }
}

/// Shadows have soft edges: sound comes past a small obstacle. Adds to focus_log.
void soften_shadows(const ScanPlan& plan, FrameState& frame) noexcept {
  const auto coarse = plan.coarse_samples();
  constexpr float kMostChange = 1.5F;  // neper
  for (std::size_t c = 0; c < coarse; ++c) {
    const auto way = [&](int l) { return frame.probed_way[static_cast<std::size_t>(l) * coarse + c]; };
    average_lines(
        plan, half_width(plan, c, kShadingShare), [&](int l) { return std::exp(std::max(way(l), -40.0F)); },
        [&](int l, float mean) {
          const LineWalk& line = frame.walks[static_cast<std::size_t>(l)];
          const float depth_mm = static_cast<float>(c) * kCoarse * plan.sample_mm;
          if (depth_mm > line.mirror_depth_mm) return;
          const float change = std::log(std::max(mean, 1e-18F)) - std::max(way(l), -40.0F);
          frame.focus_log[static_cast<std::size_t>(l) * coarse + c] += std::clamp(change, -kMostChange, kMostChange);
        });
  }
}

}  // namespace

void bend_lines(const ScanPlan& plan, FrameState& frame) noexcept {
  const auto coarse = plan.coarse_samples();
  const auto lines = static_cast<std::size_t>(plan.lines);
  frame.widest_warp = 0.0F;
  std::fill(frame.bend_mm.begin(), frame.bend_mm.end(), 0.0F);
  std::fill(frame.focus_log.begin(), frame.focus_log.end(), 0.0F);
  if (plan.acquisition.artefacts.attenuation) soften_shadows(plan, frame);
  if (!plan.acquisition.artefacts.refraction) return;
  const float step_mm = kCoarse * plan.sample_mm;
  // A ray turns towards the slower side: slope += -d(ln c)/dx * dr; ln c = -ln(1 + slowness). The change is kept in
  // bend_mm first.
  for (std::size_t c = 0; c < coarse; ++c) {
    const int half = half_width(plan, c, kBendingShare);
    const auto spacing =
        static_cast<float>(plan.geometry.line_spacing_mm(static_cast<double>(c) * static_cast<double>(step_mm)));
    const auto at = [&](int l) { return static_cast<std::size_t>(l) * coarse + c; };
    average_lines(
        plan, half, [&](int l) { return frame.slowness[at(l)]; },
        [&](int l, float mean) { frame.smooth_slowness[at(l)] = mean; });
    float before = 0.0F;
    average_lines(
        plan, half, [&](int l) { return frame.smooth_slowness[at(l)]; },
        [&](int l, float mean) {
          frame.bend_mm[at(l)] = l > 0 ? (mean - before) / spacing * step_mm : 0.0F;
          before = mean;
        });
  }
  for (std::size_t l = 0; l < lines; ++l) {
    float slope = 0.0F, bend = 0.0F;
    for (std::size_t c = 0; c < coarse; ++c) {
      const auto spacing = static_cast<float>(plan.geometry.line_spacing_mm(static_cast<double>(c) * step_mm));
      slope = std::clamp(slope + frame.bend_mm[l * coarse + c], -0.15F, 0.15F);
      bend += slope * step_mm;
      frame.bend_mm[l * coarse + c] = bend;
      frame.widest_warp = std::max(frame.widest_warp, std::abs(bend) / std::max(spacing, 0.02F));
    }
  }
  for (std::size_t l = 0; l < lines; ++l) {
    const std::size_t low = l >= 2 ? l - 2 : 0, high = std::min(l + 2, lines - 1);
    for (std::size_t c = 0; c < coarse; ++c) {
      const auto spacing = static_cast<float>(plan.geometry.line_spacing_mm(static_cast<double>(c) * step_mm));
      const float parting = (frame.bend_mm[high * coarse + c] - frame.bend_mm[low * coarse + c]) /
                            (static_cast<float>(high - low) * spacing);
      // Intensity goes with the inverse of the width of the tube of rays, there and back.
      frame.focus_log[l * coarse + c] -= std::log(std::clamp(1.0F + parting, 0.4F, 2.5F));
    }
  }
  constexpr float kMostLines = 12.0F;
  frame.widest_warp = std::min(frame.widest_warp, kMostLines);
}

}  // namespace trocar::detail
