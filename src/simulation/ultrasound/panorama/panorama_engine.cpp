#include "ultrasound/panorama/panorama_engine.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/result.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/detail/aperture_paths.h"
#include "ultrasound/engine/detail/clutter.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/needle_image.h"
#include "ultrasound/engine/detail/point_spread.h"
#include "ultrasound/panorama/detail/hard_shadows.h"
#include "ultrasound/panorama/detail/panorama_blend.h"
#include "ultrasound/panorama/detail/panorama_sampler.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {
namespace {

using namespace detail;

/// The scanlines on which needles have echoes or shadows; empty: none.
LineRange needle_lines(const ScanPlan& plan, const NeedleImage& image) noexcept {
  constexpr float kShadowReach = 3.0F;  // sigmas
  float low = static_cast<float>(plan.lines), high = -1.0F;
  const auto include = [&](float line, float reach) {
    low = std::min(low, line - reach);
    high = std::max(high, line + reach);
  };
  for (std::size_t n = 0; n < image.count; ++n) {
    const NeedleImage::Part& part = image.parts[n];
    for (std::size_t p = part.first_piece; p < part.last_piece; ++p)
      include(image.pieces[p].line, std::max(kShadowReach / image.pieces[p].line_sigmas, 2.0F));
    for (std::size_t g = part.first_grain; g < part.last_grain; ++g) include(image.grains[g].line, 2.0F);
  }
  const auto lines = static_cast<float>(plan.lines);
  if (!(low <= high) || high < 0.0F || low >= lines) return {};
  return {static_cast<int>(std::max(low, 0.0F)), static_cast<int>(std::min(high + 1.0F, lines - 1.0F)) + 1};
}

/// Separate ranges of scanlines.
struct Runs {
  static constexpr int kMost = 4;
  /// Neighbouring runs are joined: each has a margin that is probed again.
  static constexpr int kLeastGap = 32;
  std::array<LineRange, kMost> runs{};
  int count = 0;

  void include(int line) noexcept {
    if (count > 0 && (line < runs[static_cast<std::size_t>(count - 1)].last + kLeastGap || count == kMost))
      runs[static_cast<std::size_t>(count - 1)].last = line + 1;
    else
      runs[static_cast<std::size_t>(count++)] = {line, line + 1};
  }
};

LineRange both(const LineRange& a, const LineRange& b) noexcept {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

}  // namespace

struct PanoramaEngine::Impl {
  /// Buffers of one task besides the frame.
  struct Scratch {
    SteeringRows rows;
    std::vector<float> logs, rest_mm;
    PanoramaSamples samples;
  };

  Impl(std::shared_ptr<const AcousticScene> scene_of, std::shared_ptr<const Panorama> panorama_of,
       Transducer transducer_of, const Acquisition& acquisition)
      : scene(std::move(scene_of)),
        panorama(std::move(panorama_of)),
        transducer(std::move(transducer_of)),
        ray_cast(scene, transducer, acquisition),
        frame(make_frame_state(*scene)) {
    fit(acquisition);
  }

  void fit(const Acquisition& acquisition);
  void sample(int group, int first, int last) noexcept;
  /// Scanlines of a range that need BMode.
  Runs uncovered(const LineRange& lines) const noexcept;
  /// Adds needles to `frame`: echoes before the point spread, and shadows in way_gain.
  void draw_needles(std::span<const NeedleEcho> list, const LineRange& lines) noexcept;
  /// Amplitudes of the panorama, and their powers for the clutter.
  void measure(int line) noexcept;
  /// Needles and clutter over the panorama: the samples of all angles.
  void begin_line(int group, int line) noexcept;
  /// Joins the panorama's echoes with those of BMode, or of none (nullptr).
  void join(int line, const BasebandFrame* casting) noexcept;
  int angles() const noexcept { return plan.steering_angles + plan.near_angles; }
  int samples_of(int angle) const noexcept { return angle < plan.steering_angles ? plan.samples : plan.near_samples; }
  bool has_needle(int line) const noexcept { return line >= needled.first && line < needled.last; }
  std::size_t row(int angle, int line) const noexcept {
    return static_cast<std::size_t>(angle * plan.lines + line) * static_cast<std::size_t>(plan.samples);
  }

  std::shared_ptr<const AcousticScene> scene;
  std::shared_ptr<const Panorama> panorama;
  Transducer transducer;
  BMode ray_cast;
  ScanPlan plan;  ///< Of hard tissues alone.
  FrameState frame;
  NeedleImage needles;
  BeamPlanes planes;
  PanoramaMap map;
  BasebandFrame out;
  std::vector<Scratch> scratch;  ///< One per group of scanlines.
  std::vector<WalkResult> walks;
  std::vector<float> aperture_rows;
  int stride = 1;                        ///< Samples per sample of the panorama.
  double step_mm = 0.0;                  ///< Their distance.
  std::vector<float> sigma_mm;           ///< Thickness of the beam at these.
  std::vector<float> gain;               ///< Per sample, neper: what the scanner's TGC adds to the panorama's levels.
  std::vector<float> area;               ///< Per sample: its share of the picture's area, times scanlines.
  std::vector<float> amplitude, weight;  ///< line * samples.
  std::vector<float> power;              ///< line * samples.
  std::vector<float> least_weight, most_weight, share;  ///< Per scanline.
  int share_reach = 1;                                  ///< Scanlines of kShareReach_mm near the face.
  std::vector<NearEnd> near_ends;                       ///< Per scanline.
  std::vector<float> near_shares, near_working;         ///< Per scanline.
  HazePattern haze;
  std::vector<float> most_power;  ///< Per block of kLobeBlock samples: power of liver's echoes.
  LineRange needled;              ///< Scanlines with needles in the last frame.
  bool has_frame = false;
  int cast_lines = 0;
};

void PanoramaEngine::Impl::fit(const Acquisition& acquisition) {
  plan = make_shadow_plan(*scene, transducer, acquisition);
  fit_frame(frame, plan);
  needles = make_needle_image(plan);
  planes = make_beam_planes(plan.planes);
  const BasebandFrame& like = ray_cast.render({Pose::translation(Vec3::Zero()), {}, 0.0, {0, kMostStride}, true});
  out = like;
  std::fill(out.re.begin(), out.re.end(), 0.0F);
  std::fill(out.im.begin(), out.im.end(), 0.0F);
  const auto lines = static_cast<std::size_t>(plan.lines), samples = static_cast<std::size_t>(plan.samples);
  aperture_rows.assign(aperture_floats(plan), 0.0F);
  walks.resize(static_cast<std::size_t>(group_count(plan.lines)) + 1);
  scratch.resize(walks.size());
  for (Scratch& s : scratch) {
    s.rows = SteeringRows(plan);
    s.logs.assign(samples + kReadAhead, 0.0F);
    s.rest_mm.assign(samples + kReadAhead, 0.0F);
    s.samples.fit(plan.samples);
  }
  stride = sample_stride(*panorama, plan.geometry.sample_mm());
  step_mm = stride * plan.geometry.sample_mm();
  sigma_mm.assign(samples + kReadAhead, plan.elevation_sigma_mm[samples - 1]);
  for (std::size_t n = 0; n * static_cast<std::size_t>(stride) < samples; ++n)
    sigma_mm[n] = plan.elevation_sigma_mm[n * static_cast<std::size_t>(stride)];
  gain.assign(samples + kReadAhead, 0.0F);
  area.assign(samples, 0.0F);
  most_power.clear();
  double sum_mm = 0.0;
  for (std::size_t s = 0; s < samples; ++s) {
    constexpr double kNeperPerDb = std::numbers::ln10 / 20.0;
    const double depth_mm = (static_cast<double>(s) + 0.5) * plan.geometry.sample_mm();
    gain[s] = static_cast<float>(
        kNeperPerDb * (panorama->tissue_db -
                       tgc_gain_db(DisplaySettings{}, depth_mm, plan.geometry.depth_mm, plan.beam.frequency_mhz)));
    sum_mm += plan.geometry.line_spacing_mm(depth_mm);
  }
  for (std::size_t s = 0; s < samples; ++s)
    area[s] = static_cast<float>(
        plan.geometry.line_spacing_mm((static_cast<double>(s) + 0.5) * plan.geometry.sample_mm()) / sum_mm);
  for (auto* values : {&amplitude, &weight, &power}) values->assign(lines * samples, 0.0F);
  for (auto* values : {&least_weight, &most_weight, &share, &near_shares, &near_working}) values->assign(lines, 0.0F);
  near_ends.assign(lines, {});
  share_reach =
      std::clamp(static_cast<int>(kShareReach_mm / plan.geometry.line_spacing_mm(kNearGap_mm)), 1, plan.lines);
  for (std::size_t block = 0; block < plan.lobe_blocks(); ++block) {
    const float loss = gain[std::min(block * kLobeBlock + kLobeBlock / 2, samples - 1)];
    most_power.push_back(std::exp(2.0F * loss));
  }
  haze = make_haze_pattern(plan, frame, scratch[0].rows, out);
  has_frame = false;
  needled = {};
}

/// Slices, shadows and weights of scanlines.
void PanoramaEngine::Impl::sample(int group, int first, int last) noexcept {
  Scratch& s = scratch[static_cast<std::size_t>(group)];
  const auto samples = static_cast<std::size_t>(plan.samples);
  for (int l = first; l < last; ++l) {
    const auto at = static_cast<std::size_t>(l);
    fill_way_gain(plan, frame, l, gain, s.logs);
    const LineWalk& walk = frame.walks[at];
    const auto step = static_cast<std::size_t>(stride);
    for (std::size_t n = 0, from = 0; from < samples + step; ++n, from += step)
      s.rest_mm[n] = (static_cast<float>(from) + 0.5F) * plan.sample_mm -
                     walk.pressed_mm * frame.contact_shape[std::min(from, samples - 1)];
    const Vec2 origin = plan.geometry.line_origin(l), along = plan.geometry.line_direction(l);
    PanoramaLine line;
    line.origin_T = {static_cast<float>(origin.x()), static_cast<float>(origin.y())};
    line.along_T = {static_cast<float>(along.x()), static_cast<float>(along.y())};
    line.rest_mm = s.rest_mm.data();
    line.sigma_mm = sigma_mm.data();
    line.samples = plan.samples / stride + 1;
    line.weight_step = weight_step(step_mm);
    sample_panorama(map, frame.motion, planes, line, s.samples);
    expand_samples(s.samples.power, stride, plan.samples, power.data() + at * samples);
    expand_samples(s.samples.weight, stride, plan.samples, weight.data() + at * samples);
    const double sample_mm = plan.geometry.sample_mm();
    near_ends[at] =
        find_near_end(weight.data() + at * samples, std::min(static_cast<int>(kNearGap_mm / sample_mm), plan.samples),
                      std::min(static_cast<int>(kFarGap_mm / sample_mm), plan.samples));
    out.contact[at] = walk.coupling;
  }
}

Runs PanoramaEngine::Impl::uncovered(const LineRange& lines) const noexcept {
  Runs found;
  for (int l = lines.first; l < lines.last; ++l)
    if (least_weight[static_cast<std::size_t>(l)] < kWholeWeight) found.include(l);
  for (int n = 0; n < found.count; ++n) {
    LineRange& run = found.runs[static_cast<std::size_t>(n)];
    run = widened(run, 0, plan.lines);
  }
  return found;
}

void PanoramaEngine::Impl::draw_needles(std::span<const NeedleEcho> list, const LineRange& lines) noexcept {
  const LineRange before = needled;
  lay_out_needles(plan, frame, list, needles);
  const LineRange touched = needle_lines(plan, needles);
  needled = touched.is_empty() ? LineRange{} : widened(touched, plan.lateral_reach, plan.lines);
  const LineRange old = both(before, lines), drawn = both(needled, lines);
  for (const LineRange& range : {old, drawn})
    for (int l = range.first; l < range.last; ++l)
      for (auto* echoes : {&frame.re, &frame.im})
        std::fill_n(echoes->data() + plan.echo_row(l) - kPad, plan.stride, 0.0F);
  for_groups(drawn, [&](int, int first, int last) { add_needles(plan, frame, needles, first, last); });
  for (const LineRange& range : {old, drawn})
    for (int l = range.first; l < range.last; ++l) find_loudest(plan, frame, l);
}

void PanoramaEngine::Impl::measure(int line) noexcept {
  const auto at = static_cast<std::size_t>(line), samples = static_cast<std::size_t>(plan.samples);
  float* const echo = amplitude.data() + at * samples;
  const float* const its_weight = weight.data() + at * samples;
  continue_to_face(near_ends[at], near_shares[at], plan.samples, power.data() + at * samples,
                   weight.data() + at * samples);
  to_amplitude(power.data() + at * samples, frame.way_gain.data() + at * samples, out.contact[at], plan.samples, echo,
               weight.data() + at * samples);
  using Values = Eigen::Map<const Eigen::ArrayXf>;
  const Values weights(its_weight, plan.samples);
  share[at] = (weights * Values(area.data(), plan.samples)).sum();
  least_weight[at] = weights.minCoeff();
  most_weight[at] = weights.maxCoeff();
  if (!plan.acquisition.artefacts.clutter) return;
  for (std::size_t block = 0; block < plan.lobe_blocks(); ++block) {
    const std::size_t begin = block * kLobeBlock, end = std::min(begin + kLobeBlock, samples);
    const auto count = static_cast<Eigen::Index>(end - std::min(begin, end));
    const float squares = (Values(its_weight + begin, count) * Values(echo + begin, count).square()).sum();
    // A reflector counts as liver: the beam is built against strong reflectors.
    frame.power[block * static_cast<std::size_t>(plan.lines) + at] =
        std::min(squares / static_cast<float>(kLobeBlock), most_power[block]);
  }
}

void PanoramaEngine::Impl::begin_line(int group, int line) noexcept {
  if (has_needle(line)) {
    spread_echoes(plan, frame, line, scratch[static_cast<std::size_t>(group)].rows, out);
  } else {
    for (auto* values : {&out.re, &out.im}) std::fill_n(values->data() + row(0, line), plan.samples, 0.0F);
  }
  if (!plan.acquisition.artefacts.clutter) return;
  const auto at = static_cast<std::size_t>(line), samples = static_cast<std::size_t>(plan.samples);
  const float *const re = haze.re.data() + at * samples, *const im = haze.im.data() + at * samples;
  for (int angle = 0; angle < (has_needle(line) ? angles() : 1); ++angle) {
    float *const to_re = out.re.data() + row(angle, line), *const to_im = out.im.data() + row(angle, line);
    const auto end = static_cast<std::size_t>(samples_of(angle));
    for (std::size_t begin = 0; begin < end; begin += kLobeBlock) {
      const float level = std::sqrt(clutter_power(plan, frame, line, begin / kLobeBlock));
      const std::size_t stop = std::min(begin + kLobeBlock, end);
      for (std::size_t s = begin; s < stop; ++s) to_re[s] += level * re[s];
      for (std::size_t s = begin; s < stop; ++s) to_im[s] += level * im[s];
    }
  }
}

void PanoramaEngine::Impl::join(int line, const BasebandFrame* casting) noexcept {
  const auto at = static_cast<std::size_t>(line), samples = static_cast<std::size_t>(plan.samples);
  const auto copy = [&](const BasebandFrame& frame_of, int from, int to) {
    const std::size_t source = row(from, line), target = row(to, line);
    std::copy_n(frame_of.re.data() + source, samples_of(to), out.re.data() + target);
    std::copy_n(frame_of.im.data() + source, samples_of(to), out.im.data() + target);
  };
  if (casting != nullptr && most_weight[at] == 0.0F) {
    for (int angle = 0; angle < angles(); ++angle) copy(*casting, angle, angle);
    return;
  }
  const auto blend_angle = [&](int angle) {
    const std::size_t to = row(angle, line);
    BlendLine part;
    part.amplitude = amplitude.data() + at * samples;
    part.weight = weight.data() + at * samples;
    part.phase_re = haze.phase_re.data() + at * samples;
    part.phase_im = haze.phase_im.data() + at * samples;
    part.re = out.re.data() + to;
    part.im = out.im.data() + to;
    part.samples = samples_of(angle);
    if (casting != nullptr) {
      part.cast_re = casting->re.data() + to;
      part.cast_im = casting->im.data() + to;
    }
    blend(part);
  };
  // The panorama is the same on all angles, ray-cast echoes and needles are not.
  if (casting == nullptr && !has_needle(line)) {
    blend_angle(0);
    for (int angle = 1; angle < angles(); ++angle) copy(out, 0, angle);
    return;
  }
  if (!has_needle(line))
    for (int angle = 1; angle < angles(); ++angle) copy(out, 0, angle);
  for (int angle = 0; angle < angles(); ++angle) blend_angle(angle);
}

PanoramaEngine::PanoramaEngine(std::shared_ptr<const AcousticScene> scene, std::shared_ptr<const Panorama> panorama,
                               Transducer transducer, const Acquisition& acquisition) {
  TROCAR_CHECK(scene != nullptr && panorama != nullptr);
  impl_ = std::make_unique<Impl>(std::move(scene), std::move(panorama), std::move(transducer), acquisition);
}
PanoramaEngine::~PanoramaEngine() = default;
PanoramaEngine::PanoramaEngine(PanoramaEngine&&) noexcept = default;
PanoramaEngine& PanoramaEngine::operator=(PanoramaEngine&&) noexcept = default;

void PanoramaEngine::set_acquisition(const Acquisition& acquisition) {
  impl_->ray_cast.set_acquisition(acquisition);
  impl_->fit(acquisition);
}
const Acquisition& PanoramaEngine::acquisition() const noexcept {
  return impl_->plan.acquisition;
}
const ScanGeometry& PanoramaEngine::geometry() const noexcept {
  return impl_->plan.geometry;
}

const BasebandFrame& PanoramaEngine::render(const BModeInput& input) noexcept {
  Impl& impl = *impl_;
  constexpr int kNeighbours = 16;
  const LineRange wanted = impl.has_frame || input.is_alone ? input.renewed : LineRange{};
  const LineRange lines = widened(wanted, 0, impl.plan.lines), probed = widened(wanted, kNeighbours, impl.plan.lines);
  impl.frame.X_PT = input.X_PT;
  impl.frame.motion = input.motion;
  if (input.is_alone) {
    silence_outside(impl.plan, impl.frame, lines, probed);
    std::fill(impl.near_ends.begin(), impl.near_ends.end(), NearEnd{});
  }
  impl.map = make_panorama_map(*impl.panorama, input.X_PT);
  find_hard_shadows(*impl.scene, impl.plan, impl.frame, probed, lines, impl.walks, impl.aperture_rows);
  for_groups(lines, [&](int group, int first, int last) { impl.sample(group, first, last); });

  smooth_shares(impl.near_ends, impl.share_reach, impl.near_working, impl.near_shares);
  impl.draw_needles(input.needles, lines);
  for_groups(lines, [&](int, int first, int last) {
    for (int l = first; l < last; ++l) impl.measure(l);
  });
  if (impl.plan.acquisition.artefacts.clutter) sum_powers(impl.plan, impl.frame);
  const Runs cast = impl.uncovered(lines);
  const auto is_cast = [&](int line) {
    return std::any_of(cast.runs.begin(), cast.runs.begin() + cast.count,
                       [&](const LineRange& run) { return line >= run.first && line < run.last; });
  };
  for_groups(lines, [&](int group, int first, int last) {
    for (int l = first; l < last; ++l) {
      impl.begin_line(group, l);
      if (!is_cast(l)) impl.join(l, nullptr);
    }
  });
  impl.cast_lines = 0;
  for (int n = 0; n < cast.count; ++n) {
    const LineRange& run = cast.runs[static_cast<std::size_t>(n)];
    const bool is_part = run.count() < impl.plan.lines;
    const BasebandFrame& casting =
        impl.ray_cast.render({input.X_PT, input.needles, input.time_s, run, is_part, input.motion});
    for_groups(run, [&](int, int first, int last) {
      for (int l = first; l < last; ++l) impl.join(l, &casting);
    });
    impl.cast_lines += run.count();
  }
  impl.out.renewed = lines;
  impl.has_frame = !input.is_alone || lines.count() == impl.plan.lines;
  return impl.out;
}

SoundPath PanoramaEngine::sound_path(int line) const {
  const Impl& impl = *impl_;
  TROCAR_CHECK(line >= 0 && line < impl.plan.lines);
  const auto samples = static_cast<std::size_t>(impl.plan.samples), at = static_cast<std::size_t>(line);
  SoundPath path;
  path.gain = {impl.frame.way_gain.data() + at * samples, samples};
  path.pressed_mm = impl.frame.walks[at].pressed_mm;
  path.dent_share = {impl.frame.contact_shape.data(), samples};
  return path;
}

double PanoramaEngine::panorama_share() const noexcept {
  double sum = 0.0;
  for (const float share : impl_->share) sum += static_cast<double>(share);
  return sum / static_cast<double>(impl_->share.size());
}

int PanoramaEngine::ray_cast_lines() const noexcept {
  return impl_->cast_lines;
}

}  // namespace trocar::ultrasound
