#include "ultrasound/engine/detail/clutter.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::ultrasound::detail {
namespace {

/// Echoes brighter than this, relative to liver's speckle after the losses of their way, count as that: the beam is
/// built against strong reflectors (assumed).
constexpr float kBrightest = 2.0F;  // power
/// Scanlines to each side from which clutter comes: the opening of the elements (assumed).
constexpr double kClutterReach_mm = 25.0;
/// Detours in the layers in front, which arrive later: from this far beside the scanline, with this level relative to
/// the echoes at the face, falling by e with this depth of the layers, and over this distance behind them (assumed).
/// They are the haze in the near part of a bladder or gallbladder.
constexpr double kDetourReach_mm = 3.0;
constexpr float kDetour_db = -14.0F;
constexpr double kDetourDepth_mm = 25.0, kDetour_mm = 8.0;

std::size_t block_samples(const ScanPlan& plan, std::size_t block) noexcept {
  const std::size_t begin = block * kLobeBlock;
  return std::min<std::size_t>(kLobeBlock, static_cast<std::size_t>(plan.samples) - begin);
}

int reach_at(const ScanPlan& plan, std::size_t block, double reach_mm) noexcept {
  const double depth_mm = (static_cast<double>(block) + 0.5) * kLobeBlock * plan.geometry.sample_mm();
  const double spacing_mm = std::max(plan.geometry.line_spacing_mm(depth_mm), 0.02);
  return std::clamp(static_cast<int>(reach_mm / spacing_mm), 1, plan.lines);
}

/// Mean power around a block of the echoes of all scanlines within reach.
float mean_around(const ScanPlan& plan, const FrameState& frame, int line, std::size_t block,
                  double reach_mm) noexcept {
  const int reach = reach_at(plan, block, reach_mm);
  const int first = std::max(line - reach, 0), last = std::min(line + reach, plan.lines - 1);
  // Running sums along the scanlines.
  const float* const sums = frame.power_sums.data() + block * static_cast<std::size_t>(plan.lines + 1);
  return (sums[last + 1] - sums[first]) / static_cast<float>(last - first + 1);
}

float power_of(double level_db) noexcept {
  return std::pow(10.0F, static_cast<float>(level_db) / 10.0F);
}

}  // namespace

void measure_echoes(const ScanPlan& plan, FrameState& frame, int line) noexcept {
  const std::size_t row = plan.echo_row(line);
  const float* const way =
      frame.way_gain.data() + static_cast<std::size_t>(line) * static_cast<std::size_t>(plan.samples);
  for (std::size_t block = 0; block * kLobeBlock < static_cast<std::size_t>(plan.samples); ++block) {
    const std::size_t begin = block * kLobeBlock, n = block_samples(plan, block);
    float power = 0.0F, most = 0.0F;
    for (std::size_t s = begin; s < begin + n; ++s) {
      const float re = frame.re[row + s], im = frame.im[row + s];
      power += re * re + im * im;
      most += way[s] * way[s] * plan.echo_power[s];
    }
    frame.power[block * static_cast<std::size_t>(plan.lines) + static_cast<std::size_t>(line)] =
        std::min(power, kBrightest * most) / static_cast<float>(n);
  }
}

void sum_powers(const ScanPlan& plan, FrameState& frame) noexcept {
  const auto lines = static_cast<std::size_t>(plan.lines);
  for (std::size_t block = 0; block < plan.lobe_blocks(); ++block) {
    float* const sums = frame.power_sums.data() + block * (lines + 1);
    float sum = 0.0F;
    for (std::size_t line = 0; line < lines; ++line) {
      sums[line] = sum;
      sum += frame.power[block * lines + line];
    }
    sums[lines] = sum;
  }
}

float clutter_power(const ScanPlan& plan, const FrameState& frame, int line, std::size_t block) noexcept {
  const float share = power_of(clutter_level_db(plan.beam, kClutter_db));
  return share * std::max(mean_around(plan, frame, line, block, kClutterReach_mm), 0.0F);
}

void add_clutter(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  // Noise of every sample is spread by two thirds of the factor that applies to scatterers between scanlines.
  const float share = 1.5F * power_of(clutter_level_db(plan.beam, kClutter_db));
  const float detour_share = 1.5F * power_of(clutter_level_db(plan.beam, kDetour_db));
  const double detour_depth_mm = kDetourDepth_mm / clutter_level_db(plan.beam, 1.0);  // its level falls by dB per mm
  const float keeps = std::exp(-static_cast<float>(kLobeBlock * plan.geometry.sample_mm() / kDetour_mm));
  for (int line = first; line < last; ++line) {
    const std::size_t row = plan.echo_row(line);
    // The pattern belongs to the transducer: scanlines begin at different places of one list of noise.
    const std::size_t place = (static_cast<std::size_t>(line) * 2654435761U) % (ScanPlan::kNoise / 2);
    float detour = 0.0F;
    for (std::size_t block = 0; block * kLobeBlock < static_cast<std::size_t>(plan.samples); ++block) {
      const float around = mean_around(plan, frame, line, block, kClutterReach_mm);
      const double depth_mm = static_cast<double>(block * kLobeBlock) * plan.geometry.sample_mm();
      detour = keeps * detour + (1.0F - keeps) * mean_around(plan, frame, line, block, kDetourReach_mm) *
                                    static_cast<float>(std::exp(-depth_mm / detour_depth_mm));
      const float amplitude = std::sqrt(0.5F * std::max(share * around + detour_share * detour, 0.0F));
      const std::size_t begin = block * kLobeBlock, n = block_samples(plan, block);
      const float* const noise = plan.noise.data() + (place + 2 * begin) % (ScanPlan::kNoise / 2);
      for (std::size_t s = 0; s < n; ++s) {
        frame.re[row + begin + s] += amplitude * noise[s];
        frame.im[row + begin + s] += amplitude * noise[kLobeBlock + s];
      }
    }
  }
}

void generate_harmonic(const ScanPlan& plan, FrameState& frame, int line) noexcept {
  const std::size_t row = plan.echo_row(line);
  for (std::size_t s = 0; s < plan.harmonic_level.size(); ++s) {
    frame.re[row + s] *= plan.harmonic_level[s];
    frame.im[row + s] *= plan.harmonic_level[s];
  }
}

namespace {

/// Reflection of returning echoes at the array's face and the skin (assumed, range 0.05..0.4).
constexpr float kFaceReflection = 0.2F;
/// Weaker reflectors have no relevant second echo.
constexpr float kLeastReverberation = 0.003F;

/// Echoes behind bubbles of gas, relative to the sound that they scatter, and their decay (assumed): everywhere the
/// haze of a dirty shadow, behind some clusters ring-down, whose bands follow each other at this distance.
constexpr float kHaze = 0.7F;
constexpr float kHazeFade_mm = 35.0F;
constexpr float kRing = 1.4F;
constexpr float kRingFade_mm = 28.0F;
constexpr float kRingingFrom = 0.45F;  ///< Of Reflector::bubbles (assumed).
constexpr float kBand_mm = 1.6F, kBandSpread_mm = 0.8F, kBandDepth = 0.3F;

}  // namespace

void add_ring_down(const ScanPlan& plan, FrameState& frame, int line) noexcept {
  const Reflector& reflector = frame.reflectors[static_cast<std::size_t>(line)];
  if (!reflector.is_gas || reflector.rough_amplitude <= 1e-4F) return;
  const auto begin = static_cast<int>(reflector.shown);
  const float loud = std::max(0.0F, (reflector.bubbles - kRingingFrom) / (1.0F - kRingingFrom));
  const float scale = reflector.rough_amplitude /
                      std::sqrt(plan.surface_scale[static_cast<std::size_t>(std::clamp(begin, 0, plan.samples - 1))]);
  const float band_mm = kBand_mm + kBandSpread_mm * reflector.bubbles;
  const float haze_fade = std::exp(-plan.sample_mm / kHazeFade_mm),
              ring_fade = std::exp(-plan.sample_mm / kRingFade_mm);
  float haze = kHaze * scale, ring = kRing * loud * scale;
  const std::uint64_t key = mix64(static_cast<std::uint64_t>(line) << 32);
  const std::size_t row = plan.echo_row(line);
  for (int s = std::max(begin, 0); s < plan.samples; ++s) {
    haze *= haze_fade;
    ring *= ring_fade;
    const float phase = 2.0F * std::numbers::pi_v<float> * static_cast<float>(s - begin) * plan.sample_mm / band_mm;
    const std::uint64_t bits = mix64(key + static_cast<std::uint64_t>(s - begin));
    const float a = static_cast<float>(bits & 0xffffU) / 32767.5F - 1.0F;
    const float b = static_cast<float>((bits >> 16) & 0xffffU) / 32767.5F - 1.0F;
    const float envelope = haze + ring * (1.0F - kBandDepth + kBandDepth * std::cos(phase));
    frame.re[row + static_cast<std::size_t>(s)] += envelope * a;
    frame.im[row + static_cast<std::size_t>(s)] += envelope * b;
  }
}

void add_reverberation(const ScanPlan& plan, const FrameState& frame, int angle, int line,
                       BasebandFrame& out) noexcept {
  const Reflector& reflector = frame.reflectors[static_cast<std::size_t>(line)];
  const float again = kFaceReflection * reflector.amplitude;
  const auto lag = static_cast<int>(reflector.shown + 0.5F);
  if (again < kLeastReverberation || lag < 8) return;
  const std::size_t row = static_cast<std::size_t>(angle * plan.lines + line) * static_cast<std::size_t>(plan.samples);
  // From near to far, so that repeated echoes repeat again: A-lines at 2, 3, 4 … times the depth. Blocks as long as the
  // lag do not overlap with what they read.
  const int samples = angle < plan.steering_angles ? plan.samples : plan.near_samples;
  for (auto* values : {&out.re, &out.im}) {
    float* const line_values = values->data() + row;
    for (int s = lag; s < samples; s += lag) {
      const int n = std::min(lag, samples - s);
      Eigen::Map<Eigen::ArrayXf>(line_values + s, n) +=
          again * Eigen::Map<const Eigen::ArrayXf>(line_values + s - lag, n);
    }
  }
}

}  // namespace trocar::ultrasound::detail
