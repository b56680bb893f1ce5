#include "ultrasound/engine/b_mode.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/result.h"
#include "ultrasound/engine/detail/aperture_paths.h"
#include "ultrasound/engine/detail/clutter.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/needle_image.h"
#include "ultrasound/engine/detail/point_echo.h"
#include "ultrasound/engine/detail/point_spread.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/scatterer_echo.h"
#include "ultrasound/engine/detail/sound_paths.h"
#include "ultrasound/engine/detail/surface_echo.h"
#include "ultrasound/engine/detail/tissue_texture.h"
#include "ultrasound/engine/detail/tissue_walk.h"

namespace trocar::ultrasound {
using namespace detail;

struct BMode::Impl {
  /// Buffers of one task besides the frame.
  struct Scratch {
    WalkResult walk;
    Texture texture;
    ScattererField scatterers;
    SteeringRows rows;
  };

  std::shared_ptr<const AcousticScene> scene;
  Transducer transducer;
  ScanPlan plan;
  FrameState frame;
  BasebandFrame out;
  NeedleImage needles;
  std::vector<Brick> bricks = make_brick_library();
  std::vector<Scratch> scratch;      ///< One per group of scanlines.
  std::vector<float> aperture_rows;  ///< Of open_aperture.

  bool has_frame = false;  ///< Of this acquisition.

  /// Contact, losses, mirrors and refraction of scanlines.
  void find_paths(const BModeInput& input, const LineRange& lines) noexcept;
  void walk(int group, int first, int last) noexcept;
  /// Call after walking all scanlines: a scanline receives echoes from the space up to the next one.
  void echo(int group, int first, int last) noexcept;
  /// Call after all echoes: the frame's samples.
  void spread(int group, int first, int last) noexcept;
};

void BMode::Impl::walk(int group, int first, int last) noexcept {
  Scratch& s = scratch[static_cast<std::size_t>(group)];
  const auto samples = static_cast<std::size_t>(plan.samples);
  const auto row = static_cast<std::ptrdiff_t>(plan.echo_row(first) - kPad);
  for (auto* echoes : {&frame.re, &frame.im}) std::fill_n(echoes->begin() + row, (last - first) * plan.stride, 0.0F);
  const int central = plan.central();
  for (int line = first; line < last; ++line) {
    const LineWalk& path = frame.walks[static_cast<std::size_t>(line)];
    const float* bend = frame.bend_mm.data() + static_cast<std::size_t>(line) * plan.coarse_samples();
    for (int n = 0; n < plan.samples; n += kCoarse) {
      const auto c = static_cast<std::size_t>(n / kCoarse);
      const float step = (bend[c + 1] - bend[c]) / kCoarse;
      for (int part = 0; part < kCoarse; ++part)
        s.walk.sideways_mm[static_cast<std::size_t>(n + part)] = bend[c] + static_cast<float>(part) * step;
    }
    int& audible = frame.audible[static_cast<std::size_t>(line)];
    audible = 0;
    for (int order = 0; order < plan.planes; ++order) {
      // The central plane first: the others use its layers and delays.
      const int plane = order == 0 ? central : (order <= central ? order - 1 : order);
      if (plan.walked_line(plane, line) != line) continue;
      const float zeta = static_cast<float>(plane - central) * plan.plane_step;
      float* delay = plane == central ? frame.delay.data() + static_cast<std::size_t>(line) * samples : nullptr;
      walk_line(plan, frame, path, zeta, frame.reach[static_cast<std::size_t>(line)], s.walk, delay);
      apply_paths(plan, frame, line, s.walk);
      make_texture(plan, frame, s.walk, line, plane == central, s.texture);
      add_walls(plan, frame, path, s.walk, s.texture);
      const int to = plan.row_of(plane, line);
      pack_gains(s.walk.log_gain.data(), s.texture.added.data(), s.walk.share.data(), plan.samples,
                 frame.gain.data() + static_cast<std::size_t>(to) * samples);
      if (plane == central) {
        std::fill_n(s.texture.added.begin(), samples, 0.0F);
        to_gain(s.walk.path_loss.data(), s.texture.added.data(), plan.samples,
                frame.way_gain.data() + static_cast<std::size_t>(line) * samples);
      }
      audible = std::max(audible, s.walk.audible);
      store_borders(frame, s.walk, to);
    }
  }
}

void BMode::Impl::echo(int group, int first, int last) noexcept {
  add_surface_echoes(plan, frame, first, last);
  for (int line = first; line < last && plan.acquisition.artefacts.reverberation; ++line)
    add_ring_down(plan, frame, line);
  add_needles(plan, frame, needles, first, last);
  add_scatterers(plan, bricks, frame, first, last, scratch[static_cast<std::size_t>(group)].scatterers);
}

void BMode::Impl::spread(int group, int first, int last) noexcept {
  for (int line = first; line < last; ++line) {
    spread_echoes(plan, frame, line, scratch[static_cast<std::size_t>(group)].rows, out);
    if (!plan.acquisition.artefacts.reverberation) continue;
    for (int angle = 0; angle < plan.steering_angles + plan.near_angles; ++angle)
      add_reverberation(plan, frame, angle, line, out);
  }
}

BMode::BMode(std::shared_ptr<const AcousticScene> scene, Transducer transducer, const Acquisition& acquisition)
    : impl_(std::make_unique<Impl>()) {
  impl_->scene = std::move(scene);
  impl_->transducer = std::move(transducer);
  impl_->frame = make_frame_state(*impl_->scene);
  set_acquisition(acquisition);
}
BMode::~BMode() = default;
BMode::BMode(BMode&&) noexcept = default;
BMode& BMode::operator=(BMode&&) noexcept = default;

void BMode::set_acquisition(const Acquisition& acquisition) {
  Impl& impl = *impl_;
  TROCAR_CHECK(acquisition.samples >= 16 && acquisition.samples <= kMaxSamples && acquisition.lines >= 2);
  TROCAR_CHECK(acquisition.steering_angles >= 1 && acquisition.steering_angles <= 5);
  TROCAR_CHECK(acquisition.scatterers >= 1.0 && acquisition.scatterers <= 4.0);
  TROCAR_CHECK(acquisition.planes >= 1 && acquisition.planes <= kMaxPlanes && acquisition.planes % 2 == 1);
  impl.plan = make_scan_plan(*impl.scene, impl.transducer, acquisition);
  fit_frame(impl.frame, impl.plan);
  impl.needles = make_needle_image(impl.plan);
  impl.has_frame = false;
  impl.aperture_rows.assign(aperture_floats(impl.plan), 0.0F);
  impl.scratch.resize(static_cast<std::size_t>(group_count(impl.plan.lines)));
  for (Impl::Scratch& scratch : impl.scratch) {
    scratch.scatterers = make_scatterer_field(impl.plan);
    scratch.rows = SteeringRows(impl.plan);
  }
  impl.out.geometry = impl.plan.geometry;
  impl.out.beam = impl.plan.beam;
  const auto lines = static_cast<std::size_t>(impl.plan.lines);
  impl.out.steering_angles = impl.plan.steering_angles;
  impl.out.near_angles = impl.plan.near_angles;
  impl.out.near_full = impl.plan.near_full;
  impl.out.near_samples = impl.plan.near_samples;
  impl.out.re.assign(static_cast<std::size_t>(impl.plan.steering_angles + impl.plan.near_angles) * lines *
                         static_cast<std::size_t>(impl.plan.samples),
                     0.0F);
  impl.out.im = impl.out.re;
  impl.out.contact.assign(lines, 1.0F);
}

const Acquisition& BMode::acquisition() const noexcept {
  return impl_->plan.acquisition;
}
const ScanGeometry& BMode::geometry() const noexcept {
  return impl_->plan.geometry;
}

void BMode::Impl::find_paths(const BModeInput& input, const LineRange& lines) noexcept {
  const auto first = static_cast<std::size_t>(lines.first), count = static_cast<std::size_t>(lines.count());
  find_contact(scene->skin_distance_mm, plan.geometry, input.X_PT, std::span(frame.contact).subspan(first, count),
               lines.first, input.motion);
  fit_dent(*scene, plan, frame);
  aim_lines(plan, frame, lines.first, lines.last);
  for_groups(lines, [&](int group, int begin, int end) {
    probe_lines(plan, frame, scratch[static_cast<std::size_t>(group)].walk, begin, end);
  });
  place_mirrors(plan, frame, lines.first, lines.last);
  refract_lines(plan, frame, lines.first, lines.last);
  open_aperture(plan, frame, lines.first, lines.last, aperture_rows);
}

const BasebandFrame& BMode::render(const BModeInput& input) noexcept {
  Impl& impl = *impl_;
  ScanPlan& plan = impl.plan;
  FrameState& frame = impl.frame;
  frame.X_PT = input.X_PT;
  frame.motion = input.motion;
  // Fits of surfaces and refraction read the neighbours of a scanline.
  constexpr int kNeighbours = 16;
  const LineRange wanted = impl.has_frame || input.is_alone ? input.renewed : LineRange{};
  const LineRange lines = widened(wanted, 0, plan.lines), near = widened(wanted, kNeighbours, plan.lines);
  if (input.is_alone) silence_outside(plan, frame, lines, near);
  // Not the neighbours' borders on the other planes: those are not walked again.
  clear_borders(plan, frame, lines.first, lines.last);
  impl.find_paths(input, near);
  lay_out_needles(plan, frame, input.needles, impl.needles);
  for_groups(lines, [&](int group, int first, int last) { impl.walk(group, first, last); });
  for_groups(lines, [&](int group, int first, int last) { impl.echo(group, first, last); });
  add_points(plan, frame, lines.first, lines.last);
  if (plan.acquisition.artefacts.clutter) {
    for_groups(lines, [&](int, int first, int last) {
      for (int line = first; line < last; ++line) measure_echoes(plan, frame, line);
    });
    sum_powers(plan, frame);
  }
  for_groups(lines, [&](int, int first, int last) {
    if (plan.acquisition.artefacts.clutter) add_clutter(plan, frame, first, last);
    for (int line = first; line < last; ++line) {
      generate_harmonic(plan, frame, line);
      find_loudest(plan, frame, line);
    }
  });
  for_groups(lines, [&](int group, int first, int last) { impl.spread(group, first, last); });
  for (int line = lines.first; line < lines.last; ++line)
    impl.out.contact[static_cast<std::size_t>(line)] = frame.walks[static_cast<std::size_t>(line)].coupling;
  impl.out.renewed = lines;
  impl.has_frame = !input.is_alone || lines.count() == plan.lines;
  return impl.out;
}

SoundPath BMode::sound_path(int line) const {
  const Impl& impl = *impl_;
  TROCAR_CHECK(line >= 0 && line < impl.plan.lines);
  const auto samples = static_cast<std::size_t>(impl.plan.samples);
  const auto at = static_cast<std::size_t>(line);
  const LineWalk& walk = impl.frame.walks[at];
  return {{impl.frame.way_gain.data() + at * samples, samples},
          walk.pressed_mm,
          {impl.frame.contact_shape.data(), samples},
          walk.mirror_depth_mm};
}

}  // namespace trocar::ultrasound
