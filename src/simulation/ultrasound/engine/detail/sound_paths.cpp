#include "ultrasound/engine/detail/sound_paths.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/parallel.h"
#include "ultrasound/engine/detail/border_fit.h"
#include "ultrasound/engine/detail/tissue_texture.h"
#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound::detail {
namespace {

/// A border with a larger reflection (amplitude) from a tissue far lighter than water is gas and can act as a mirror.
constexpr float kMirrorReflection = 0.6F;
/// Amplitude share of two reflections at a slightly rough mirror (assumed).
constexpr float kMirrorShare = 0.5F;

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Slope of a surface across the image, mean over scanlines around `line`: only the central plane was sampled, and the
/// volume's gradient on one scanline contains the voxels' steps.
float slope_across(const ScanPlan& plan, const FrameState& frame, int line) noexcept {
  constexpr int kReach = 8;
  float sum = 0.0F;
  int count = 0;
  for (int l = std::max(0, line - kReach); l <= std::min(plan.lines - 1, line + kReach); ++l) {
    const GasBorder& gas = frame.gas[static_cast<std::size_t>(l)];
    if (!gas.is_there) continue;
    sum += gas.slope_across;
    ++count;
  }
  return count > 0 ? sum / static_cast<float>(count) : 0.0F;
}

/// Sets the mirror at the first gas of a scanline; behind it the image shows the structures in front of it.
void set_mirror(const ScanPlan& plan, FrameState& frame, int l) noexcept {
  LineWalk& line = frame.walks[static_cast<std::size_t>(l)];
  const Border& border = frame.gas[static_cast<std::size_t>(l)].border;
  const SurfaceFit fit = fit_in_plane(plan, frame, plan.central(), l, border);
  const Vec3 spacing = frame.scene->geometry.spacing_mm;
  const auto in_mm = [&](const std::array<float, 3>& v) { return Vec3(Vec3(v[0], v[1], v[2]).cwiseProduct(spacing)); };
  const Vec3 along = in_mm(line.along), lateral = in_mm(line.lateral), elevation = in_mm(frame.elevation);
  const Vec3 normal = (along - static_cast<double>(fit.lateral) * lateral -
                       static_cast<double>(slope_across(plan, frame, l)) * elevation)
                          .normalized();
  constexpr double kLeastFacing = 0.35;
  if (!(normal.dot(along) > kLeastFacing)) return;
  const double walk_mm = (static_cast<double>(fit.walk) + 0.5) * static_cast<double>(plan.sample_mm);
  const auto at = static_cast<std::size_t>(std::clamp(fit.walk, 0.0F, static_cast<float>(plan.samples - 1)));
  const Vec3 place =
      in_mm(line.origin) + (walk_mm - static_cast<double>(line.pressed_mm * frame.contact_shape[at])) * along;
  line.mirror = {static_cast<float>((in_mm(line.origin) - place).dot(normal)), static_cast<float>(along.dot(normal)),
                 static_cast<float>(elevation.dot(normal)), static_cast<float>(lateral.dot(normal))};
  line.mirror_normal = floats(2.0 * normal.cwiseQuotient(spacing));
  line.mirror_depth_mm = static_cast<float>(walk_mm);
  line.mirror_reflection = border.reflection;
  line.mirror_before = border.before;
  line.mirror_behind = border.behind;
  line.mirror_gain = kMirrorShare * (1.0F - plan.roughness[border.behind]) * std::abs(border.reflection);
}

/// Records the first gas on a scanline.
void note_gas(const ScanPlan& plan, FrameState& frame, const WalkResult& walk, int line) noexcept {
  GasBorder& gas = frame.gas[static_cast<std::size_t>(line)];
  gas = {};
  for (int b = 0; b < walk.border_count; ++b) {
    const Border& border = walk.borders[static_cast<std::size_t>(b)];
    if (border.reflection > -kMirrorReflection) continue;
    gas.is_there = true;
    gas.border = border;
    const Vec3 spacing = frame.scene->geometry.spacing_mm;
    const LineWalk& path = frame.walks[static_cast<std::size_t>(line)];
    const auto in_mm = [&](const std::array<float, 3>& v) {
      return Vec3(Vec3(v[0], v[1], v[2]).cwiseProduct(spacing));
    };
    const Vec3 slope = impedance_slope(frame, plan.rows, Vec3(border.index[0], border.index[1], border.index[2]));
    const double towards = slope.dot(in_mm(path.along));
    constexpr double kMostSlope = 2.0;
    if (std::abs(towards) > 1e-9)
      gas.slope_across =
          static_cast<float>(std::clamp(-slope.dot(in_mm(frame.elevation)) / towards, -kMostSlope, kMostSlope));
    return;
  }
}

}  // namespace

void fit_dent(const AcousticScene& scene, const ScanPlan& plan, FrameState& frame) noexcept {
  const double sample_mm = plan.geometry.sample_mm();
  const double reach_mm = find_dent_reach_mm(scene, plan.geometry, frame.X_PT, frame.motion);
  frame.dent_reach = static_cast<float>(reach_mm / sample_mm);
  for (std::size_t s = 0; s < static_cast<std::size_t>(plan.samples); ++s)
    frame.contact_shape[s] = static_cast<float>(dent_share((static_cast<double>(s) + 0.5) * sample_mm, reach_mm));
}

void aim_lines(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  const volume::GridGeometry& grid = frame.scene->geometry;
  const Mat3 index_of_T = grid.spacing_mm.cwiseInverse().asDiagonal() * Mat3(grid.R_PV.transpose() * frame.X_PT.R());
  const Vec3 index_of_origin = grid.to_index(frame.X_PT.p());
  frame.elevation = floats(index_of_T.col(2));
  for (int l = first; l < last; ++l) {
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
  }
  frame.deepest_dent_mm =
      plan.sample_mm * *std::max_element(frame.pressed_samples.begin(), frame.pressed_samples.end());
}

namespace {

/// Layers are computed on every fourth scanline: they vary over centimetres.
constexpr int kLayerLines = 4;

/// Slowness, losses, borders, gas and layers of one scanline.
void probe_line(const ScanPlan& plan, FrameState& frame, WalkResult& scratch, int l) noexcept {
  const auto coarse = plan.coarse_samples();
  LineWalk& line = frame.walks[static_cast<std::size_t>(l)];
  walk_line(plan, frame, line, 0.0F, plan.samples, scratch,
            frame.delay.data() + static_cast<std::ptrdiff_t>(l) * plan.samples);
  float* way = frame.probed_way.data() + static_cast<std::size_t>(l) * coarse;
  float* slowness = frame.slowness.data() + static_cast<std::size_t>(l) * coarse;
  float* absorbed = frame.absorbed.data() + static_cast<std::size_t>(l) * coarse;
  for (std::size_t c = 0; c < coarse; ++c) {
    const std::size_t s = std::min(c * kCoarse, static_cast<std::size_t>(plan.samples - 1));
    constexpr float kBendable = 0.15F;  // nothing behind gas and bone is visible
    way[c] = scratch.path_loss[s];
    // Not the gel at the face and the losses at borders.
    const std::uint8_t tissue = scratch.tissue[s];
    const float loss = c == 0 ? 0.0F : std::clamp(way[c - 1] - way[c], 0.0F, kCoarse * plan.rows[tissue].loss);
    absorbed[c] = (c == 0 ? 0.0F : absorbed[c - 1]) + plan.loss_exponent[tissue] * loss;
    const float slow = plan.slowness[tissue];
    slowness[c] = std::abs(slow) < kBendable ? slow : 0.0F;
  }
  store_borders(frame, scratch, plan.row_of(plan.central(), l));
  note_gas(plan, frame, scratch, l);
  if (l % kLayerLines == 0) note_layers(plan, frame, scratch, l);
}

/// A scanline between two probed ones: their mean.
void fill_between(const ScanPlan& plan, FrameState& frame, int l, int last) noexcept {
  const auto coarse = plan.coarse_samples();
  const std::size_t row = static_cast<std::size_t>(l) * coarse, before = row - coarse;
  const int next = l + 1 < last ? l + 1 : l - 1;
  const std::size_t after = static_cast<std::size_t>(next) * coarse;
  for (auto* values : {&frame.probed_way, &frame.slowness, &frame.absorbed})
    for (std::size_t c = 0; c < coarse; ++c) (*values)[row + c] = 0.5F * ((*values)[before + c] + (*values)[after + c]);
  fill_layers_between(plan, frame, l, l - 1, next);
  store_borders_between(frame, plan.row_of(plan.central(), l - 1), plan.row_of(plan.central(), next),
                        plan.row_of(plan.central(), l));
  frame.gas[static_cast<std::size_t>(l)] = frame.gas[static_cast<std::size_t>(l - 1)];
}

}  // namespace

void probe_lines(const ScanPlan& plan, FrameState& frame, WalkResult& scratch, int first, int last) noexcept {
  std::fill_n(scratch.sideways_mm.begin(), plan.samples + kCoarse, 0.0F);
  for (int l = first; l < last; l += 2) probe_line(plan, frame, scratch, l);
  const int begin = (first + kLayerLines - 1) / kLayerLines * kLayerLines;
  for (int l = begin + 2; l < last; l += kLayerLines)
    fill_layers_between(plan, frame, l, l - 2, l + 2 < last ? l + 2 : l - 2);
  for (int l = first + 1; l < last; l += 2) fill_between(plan, frame, l, last);
}

void place_mirrors(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  if (!plan.acquisition.artefacts.mirror) return;
  for (int l = first; l < last; ++l)
    if (frame.gas[static_cast<std::size_t>(l)].is_there) set_mirror(plan, frame, l);
}

namespace {

/// A beam is as wide as its aperture near the face and narrow at its focus: smaller structures hardly refract or shadow
/// it. Scanlines to each side over which a depth is averaged; `share` of the beam's width there.
int half_width(const ScanPlan& plan, std::size_t c, double share) noexcept {
  const double depth_mm = static_cast<double>(c) * kCoarse * static_cast<double>(plan.sample_mm);
  const double width_mm = share * plan.beam.aperture_mm * std::abs(1.0 - depth_mm / plan.beam.focus_mm);
  constexpr double kLeast_mm = 1.2, kMost_mm = 10.0;
  return std::clamp(
      static_cast<int>(std::clamp(width_mm, kLeast_mm, kMost_mm) / static_cast<double>(plan.coarse_spacing_mm[c])), 1,
      64);
}
constexpr double kBendingShare = 0.5;
constexpr double kShadingShare = 0.2;  // the echo's own aperture is apodised (assumed)

/// Means over scanlines l - half .. l + half at one depth, from running sums, for each l of a range.
template <class Value, class Take>
void average_lines(const ScanPlan& plan, const LineRange& range, int half, const Value& value,
                   const Take& take) noexcept {
  const int lines = plan.lines;
  float sum = 0.0F;
  for (int l = std::max(range.first - half - 1, 0); l < std::min(range.first + half, lines); ++l) sum += value(l);
  for (int l = range.first; l < range.last; ++l) {
    if (l + half < lines) sum += value(l + half);
    if (l - half - 1 >= 0) sum -= value(l - half - 1);
    const int count = std::min(l + half, lines - 1) - std::max(l - half, 0) + 1;
    take(l, sum / static_cast<float>(count));
  }
}

/// Edge shadows: a scanline nearly tangential to a border between tissues of different speed is deflected by (n - 1)
/// tan(tilt); a deflection beyond the beam's opening returns no echo. The tilt is that in the image plane: the other
/// planes are not computed yet. Losses behind the borders of scanline `l`.
void note_edges(const ScanPlan& plan, FrameState& frame, int l) noexcept {
  constexpr float kOpening_rad = 0.13F;  // assumed, about 1 / (2 f-number)
  constexpr float kMostTangent = 3.0F, kMostLoss = 2.3F, kBendable = 0.15F;
  const auto coarse = plan.coarse_samples();
  const auto first = static_cast<std::size_t>(plan.row_of(plan.central(), l));
  float loss = 0.0F;
  std::size_t c = 0;
  float* losses = frame.edge_loss.data() + static_cast<std::size_t>(l) * coarse;
  for (std::size_t b = 0; b < frame.border_counts[first]; ++b) {
    const Border& border = frame.borders[first * kMaxBorders + b];
    const float before = plan.slowness[border.before & 127U], behind = plan.slowness[border.behind & 127U];
    if (std::abs(before) > kBendable || std::abs(behind) > kBendable || std::abs(before - behind) < 2e-3F) continue;
    const SurfaceFit fit = fit_in_plane(plan, frame, plan.central(), l, border);
    const float tangent = std::min(std::abs(fit.lateral), kMostTangent);
    const float turned = (before - behind) * tangent / kOpening_rad;
    for (const auto end = static_cast<std::size_t>(std::max(border.walk, 0.0F)) / kCoarse; c <= end && c < coarse; ++c)
      losses[c] = loss;
    loss = std::min(loss + turned * turned, kMostLoss);  // half of its square, for both ways
  }
  for (; c < coarse; ++c) losses[c] = loss;
}

/// The losses at edges of scanlines between two probed ones, at one depth.
void fill_between_edges(const ScanPlan& plan, FrameState& frame, const LineRange& lines, std::size_t c) noexcept {
  const auto at = [&](int l) -> float& {
    return frame.edge_loss[static_cast<std::size_t>(l) * plan.coarse_samples() + c];
  };
  for (int l = lines.first + 1; l < lines.last; l += 2)
    at(l) = l + 1 < lines.last ? 0.5F * (at(l - 1) + at(l + 1)) : at(l - 1);
}

/// Averages the losses at edges over the beam; adds to path_log at one depth.
void shade_edges(const ScanPlan& plan, FrameState& frame, const LineRange& lines, std::size_t c) noexcept {
  const auto coarse = plan.coarse_samples();
  const auto at = [&](int l) { return static_cast<std::size_t>(l) * coarse + c; };
  average_lines(
      plan, lines, half_width(plan, c, kShadingShare), [&](int l) { return frame.edge_loss[at(l)]; },
      [&](int l, float mean) { frame.path_log[at(l)] -= mean; });
}

/// A ray bends towards the slower side: slope += -d(ln c)/dx * dr; ln c = -ln(1 + slowness). Stores the change of slope
/// at one depth in bend_mm.
void bend_at(const ScanPlan& plan, FrameState& frame, const LineRange& lines, std::size_t c) noexcept {
  const auto coarse = plan.coarse_samples();
  const int half = half_width(plan, c, kBendingShare);
  const auto at = [&](int l) { return static_cast<std::size_t>(l) * coarse + c; };
  average_lines(
      plan, lines, half, [&](int l) { return frame.slowness[at(l)]; },
      [&](int l, float mean) { frame.smooth_slowness[at(l)] = mean; });
  const float per_spacing = kCoarse * plan.sample_mm / plan.coarse_spacing_mm[c];
  float before = lines.first > 0 ? frame.smooth_slowness[at(lines.first - 1)] : 0.0F;
  average_lines(
      plan, lines, half, [&](int l) { return frame.smooth_slowness[at(l)]; },
      [&](int l, float mean) {
        frame.bend_mm[at(l)] = l > 0 ? (mean - before) * per_spacing : 0.0F;
        before = mean;
      });
}

/// Follows the ray of scanline `l`: displacement from the changes of its slope.
void follow_ray(const ScanPlan& plan, FrameState& frame, std::size_t l) noexcept {
  const auto coarse = plan.coarse_samples();
  const float step_mm = kCoarse * plan.sample_mm;
  float slope = 0.0F, bend = 0.0F;
  for (std::size_t at = l * coarse; at < (l + 1) * coarse; ++at) {
    slope = std::clamp(slope + frame.bend_mm[at], -0.15F, 0.15F);
    bend += slope * step_mm;
    frame.bend_mm[at] = bend;
  }
}

/// Intensity is inversely proportional to the width of the ray tube, both ways.
void focus_ray(const ScanPlan& plan, FrameState& frame, std::size_t l) noexcept {
  const auto coarse = plan.coarse_samples();
  const std::size_t low = l >= 2 ? l - 2 : 0, high = std::min(l + 2, static_cast<std::size_t>(plan.lines - 1));
  for (std::size_t c = 0; c < coarse; ++c) {
    const float parting = (frame.bend_mm[high * coarse + c] - frame.bend_mm[low * coarse + c]) /
                          (static_cast<float>(high - low) * plan.coarse_spacing_mm[c]);
    frame.path_log[l * coarse + c] -= std::log(std::clamp(1.0F + parting, 0.4F, 2.5F));
  }
}

float widest_warp(const ScanPlan& plan, const FrameState& frame) noexcept {
  constexpr float kMostLines = 12.0F;
  const auto coarse = plan.coarse_samples();
  float most = 0.0F;
  for (std::size_t l = 0; l < static_cast<std::size_t>(plan.lines); ++l)
    for (std::size_t c = 0; c < coarse; ++c)
      most = std::max(most, std::abs(frame.bend_mm[l * coarse + c]) * plan.inverse_coarse_spacing[c]);
  return std::min(most, kMostLines);
}

/// Calls body(n) for first <= n < last on several threads, without allocation.
template <class Body>
void for_each(std::size_t first, std::size_t last, const Body& body) noexcept {
  const auto part = [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) body(first + n);
  };
  constexpr std::size_t kGrain = 16;
  parallel_for(last - first, kGrain, std::ref(part));
}

}  // namespace

void refract_lines(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  const auto coarse = plan.coarse_samples();
  const LineRange lines{first, last};
  const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last);
  const bool refracts = plan.acquisition.artefacts.refraction;
  for_each(begin, end, [&](std::size_t l) {
    std::fill_n(frame.path_log.begin() + static_cast<std::ptrdiff_t>(l * coarse), coarse, 0.0F);
    if (refracts && (l - begin) % 2 == 0) note_edges(plan, frame, static_cast<int>(l));
  });
  if (refracts) {
    for_each(0, coarse, [&](std::size_t c) {
      fill_between_edges(plan, frame, lines, c);
      shade_edges(plan, frame, lines, c);
      bend_at(plan, frame, lines, c);
    });
    for_each(begin, end, [&](std::size_t l) { follow_ray(plan, frame, l); });
    for_each(begin, end, [&](std::size_t l) { focus_ray(plan, frame, l); });
  }
  frame.widest_warp = widest_warp(plan, frame);
}

}  // namespace trocar::ultrasound::detail
