#include "ultrasound/engine/detail/multiple_echoes.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::ultrasound::detail {
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
