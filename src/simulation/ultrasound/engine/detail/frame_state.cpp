#include "ultrasound/engine/detail/frame_state.h"

#include <algorithm>

#include "ultrasound/engine/detail/point_echo.h"

namespace trocar::ultrasound::detail {

FrameState make_frame_state(const AcousticScene& scene) {
  FrameState frame;
  frame.scene = &scene;
  frame.tiles = TiledTissue(scene);
  frame.point_groups = group_points(scene);
  return frame;
}

void fit_frame(FrameState& frame, const ScanPlan& plan) {
  const auto lines = static_cast<std::size_t>(plan.lines), samples = static_cast<std::size_t>(plan.samples);
  frame.contact.resize(lines);
  frame.walks.resize(lines);
  frame.audible.assign(lines, plan.samples);
  frame.reach.assign(lines, 0);
  frame.pressed_samples.assign(lines, 0.0F);
  frame.reflectors.resize(lines);
  frame.gas.resize(lines);
  const auto rows = static_cast<std::size_t>(plan.walked_rows());
  frame.borders.resize(rows * kMaxBorders);
  frame.border_keys.resize(frame.borders.size());
  frame.border_counts.assign(rows, 0);
  frame.contact_shape.assign(samples + 16, 0.0F);
  for (auto* coarse : {&frame.bend_mm, &frame.path_log, &frame.slowness, &frame.smooth_slowness, &frame.probed_way,
                       &frame.open_way, &frame.absorbed, &frame.edge_loss})
    coarse->assign(lines * plan.coarse_samples(), 0.0F);
  frame.layers.assign(lines * plan.layer_steps(), {});
  frame.delay.assign(lines * samples + 16, 0.0F);
  frame.way_gain.assign(lines * samples + 16, 0.0F);
  frame.gain.assign(rows * samples + 2, 0);
  for (auto* echoes : {&frame.re, &frame.im}) echoes->assign(plan.echo_row(plan.lines + plan.lateral_reach), 0.0F);
  frame.power.assign(plan.lobe_blocks() * lines, 0.0F);
  frame.power_sums.assign(plan.lobe_blocks() * (lines + 1), 0.0F);
  frame.loudest.assign(plan.lobe_blocks() * (lines + 2 * static_cast<std::size_t>(plan.lateral_reach)), 0.0F);
}

void clear_borders(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  for (int plane = 0; plane < plan.planes; ++plane)
    for (int line = first; line < last; ++line)
      frame.border_counts[static_cast<std::size_t>(plan.row_of(plane, line))] = 0;
}

namespace {

/// Scanlines beside a range whose gains the scatterers of its outermost scanlines may read.
constexpr int kRead = 2 * kMostStride;

/// Clears everything of a scanline that others read.
void silence_line(const ScanPlan& plan, FrameState& frame, int line, bool is_probed, bool is_near) noexcept {
  const auto at = static_cast<std::size_t>(line), samples = static_cast<std::size_t>(plan.samples);
  for (auto* echoes : {&frame.re, &frame.im})
    std::fill_n(echoes->data() + plan.echo_row(line) - kPad, plan.stride, 0.0F);
  const auto lines = static_cast<std::size_t>(plan.lines), reach = static_cast<std::size_t>(plan.lateral_reach);
  for (std::size_t block = 0; block < plan.lobe_blocks(); ++block) {
    frame.power[block * lines + at] = 0.0F;
    frame.loudest[block * (lines + 2 * reach) + reach + at] = 0.0F;
  }
  if (is_near) {
    std::fill_n(frame.way_gain.data() + at * samples, samples, 0.0F);
    std::fill_n(frame.delay.data() + at * samples, samples, 0.0F);
    for (int plane = 0; plane < plan.planes; ++plane)
      if (plan.walked_line(plane, line) == line)
        std::fill_n(frame.gain.data() + static_cast<std::size_t>(plan.row_of(plane, line)) * samples, samples,
                    ScattererGain{});
  }
  if (is_probed) return;
  for (auto* coarse : {&frame.bend_mm, &frame.path_log, &frame.slowness, &frame.smooth_slowness, &frame.probed_way,
                       &frame.open_way, &frame.absorbed, &frame.edge_loss})
    std::fill_n(coarse->data() + at * plan.coarse_samples(), plan.coarse_samples(), 0.0F);
  frame.pressed_samples[at] = 0.0F;
  frame.gas[at] = {};
  frame.walks[at] = {};
  frame.reflectors[at] = {};
}

}  // namespace

void silence_outside(const ScanPlan& plan, FrameState& frame, const LineRange& lines,
                     const LineRange& probed) noexcept {
  for (int line = 0; line < plan.lines; ++line) {
    if (line >= lines.first && line < lines.last) continue;
    const bool is_probed = line >= probed.first && line < probed.last;
    silence_line(plan, frame, line, is_probed, line >= lines.first - kRead && line < lines.last + kRead);
  }
  clear_borders(plan, frame, 0, plan.lines);
}

}  // namespace trocar::ultrasound::detail
