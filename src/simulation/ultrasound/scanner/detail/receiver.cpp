#include "ultrasound/scanner/detail/receiver.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "ultrasound/engine/beam.h"
#include "ultrasound/scanner/detail/scanner_kernels.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr std::uint64_t kTableSeed = 0x5eed0001;
constexpr std::uint64_t kHazeSeed = 0x5eed0002;
constexpr std::uint64_t kBandSeed = 0x5eed0003;

/// Haze: reverberation between face, skin and the layers below. Its power falls by e every 5 mm (mean of the
/// exponential distribution of clutter along depth, Byram and Shu 2016); at the face -17 dB against liver (assumed;
/// -30..0 dB were measured in bladders, Lediju et al. 2008).
constexpr double kHaze_db = -17.0;
constexpr double kHazeDecay_mm = 5.0;
/// Depth at which it ends: it fades out from half of that depth on, since TGC would make a sudden end visible. Assumed.
constexpr double kClutterDepth_mm = 25.0;
/// Width of the haze's speckle, which is out of focus so close to the face. Assumed, range 1..3.
constexpr double kHazeWidth_mm = 1.5;

/// Bands: the pulse's end and the echoes between the two sides of lens and skin. Assumed: first +4 dB (0..15), each
/// further one 4 dB (3..10) less, 1.7 mm apart (skin of 1.5..2.5 mm), uneven by 30 % over 8 mm along the face.
constexpr int kBands = 6;
constexpr double kFirstBand_db = 4.0;
constexpr double kBandDecay_db = 4.0;
constexpr double kBandSpacing_mm = 1.7;
constexpr double kBandUnevenness = 0.3;
constexpr double kUnevenness_mm = 8.0;
/// Length of a band relative to that of the pulse: layers ring longer than a point. Assumed, range 1..2.
constexpr double kBandLength = 1.5;

double amplitude_of_db(double db) {
  return std::pow(10.0, db / 20.0);
}

/// Half of a Gaussian kernel, from its centre; its squares sum to `power` over the whole kernel.
std::vector<float> gaussian(double sigma, double power) {
  const auto reach = static_cast<std::size_t>(std::ceil(4.0 * sigma));
  std::vector<float> kernel(reach + 1);
  double sum = 0.0;
  for (std::size_t i = 0; i <= reach; ++i) {
    const double u = sigma > 0.0 ? static_cast<double>(i) / sigma : 0.0;
    const double value = std::exp(-0.5 * u * u);
    kernel[i] = static_cast<float>(value);
    sum += (i == 0 ? 1.0 : 2.0) * value * value;
  }
  for (float& value : kernel) value *= static_cast<float>(std::sqrt(power / sum));
  return kernel;
}

std::size_t place_in_table(std::uint64_t seed, std::uint64_t counter) noexcept {
  return static_cast<std::size_t>(mix64(mix64(seed) ^ counter) % kNoiseLength);
}

std::size_t distance(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

}  // namespace

Receiver::Receiver() : white_(kNoiseLength), noise_(kNoiseLength + 2 * kMostSamples) {
  Random random(kTableSeed);
  for (float& value : white_) value = static_cast<float>(random.normal());
}

void Receiver::filter_noise(double sigma_samples) {
  const std::vector<float> kernel = gaussian(sigma_samples, 0.5);
  for (std::size_t i = 0; i < kNoiseLength; ++i) {
    float sum = kernel[0] * white_[i];
    for (std::size_t k = 1; k < kernel.size(); ++k) {
      sum += kernel[k] * (white_[(i + k) % kNoiseLength] + white_[(i + kNoiseLength - k) % kNoiseLength]);
    }
    noise_[i] = sum;
  }
  std::copy_n(noise_.begin(), 2 * kMostSamples, noise_.begin() + kNoiseLength);
}

Receiver::Noise Receiver::noise(std::uint64_t seed, std::size_t line) const noexcept {
  return {noise_.data() + place_in_table(seed, 2 * line), noise_.data() + place_in_table(seed, 2 * line + 1)};
}

void Receiver::set_geometry(const ScanGeometry& scan, const Beam& beam) {
  // Limits the filter's length; a longer pulse is not useful.
  filter_noise(std::clamp(beam.axial_sigma_mm / scan.sample_mm(), 0.0, 64.0));
  const auto reached = static_cast<std::size_t>(std::ceil(kClutterDepth_mm / scan.sample_mm()));
  clutter_samples_ = std::max(reached, kMostLanes);
  const auto samples = static_cast<std::size_t>(scan.samples);
  if (clutter_samples_ + kMostLanes > samples) clutter_samples_ = samples;
  const std::size_t count = clutter_samples_ * static_cast<std::size_t>(scan.lines);
  clutter_re_.assign(count, 0.0F);
  clutter_im_.assign(count, 0.0F);
  add_haze(scan, beam);
  add_bands(scan, beam);
  if (!beam.is_harmonic) return;
  // The face and the skin reverberate before there is a harmonic.
  const std::vector<float> levels = harmonic_levels(beam, scan);
  for (std::size_t line = 0; line < static_cast<std::size_t>(scan.lines); ++line)
    for (std::size_t s = 0; s < clutter_samples_; ++s) {
      clutter_re_[line * clutter_samples_ + s] *= levels[s];
      clutter_im_[line * clutter_samples_ + s] *= levels[s];
    }
}

void Receiver::add_haze(const ScanGeometry& scan, const Beam& beam) {
  const std::vector<float> across = gaussian(kHazeWidth_mm / scan.line_spacing_mm(kHazeDecay_mm), 1.0);
  const auto lines = static_cast<std::size_t>(scan.lines);
  std::vector<float> level(clutter_samples_);
  for (std::size_t s = 0; s < clutter_samples_; ++s) {
    const double depth_mm = (static_cast<double>(s) + 0.5) * scan.sample_mm();
    const double end = std::clamp(2.0 * depth_mm / kClutterDepth_mm - 1.0, 0.0, 1.0);
    const double fade = 0.5 + 0.5 * std::cos(std::numbers::pi * end);
    level[s] = static_cast<float>(fade * amplitude_of_db(clutter_level_db(beam, kHaze_db)) *
                                  std::exp(-0.5 * depth_mm / kHazeDecay_mm));
  }
  // Sources are also on lines beyond the ends: source j is line j - reach.
  const std::size_t reach = across.size() - 1;
  for (std::size_t source = 0; source < lines + 2 * reach; ++source) {
    const Noise noise = this->noise(kHazeSeed, source);
    const std::size_t first = source > 2 * reach ? source - 2 * reach : 0;
    for (std::size_t line = first; line < std::min(lines, source + 1); ++line) {
      const float weight = across[distance(line + reach, source)];
      float* const re = clutter_re_.data() + line * clutter_samples_;
      float* const im = clutter_im_.data() + line * clutter_samples_;
      for (std::size_t s = 0; s < clutter_samples_; ++s) {
        re[s] += weight * level[s] * noise.re[s];
        im[s] += weight * level[s] * noise.im[s];
      }
    }
  }
}

void Receiver::add_bands(const ScanGeometry& scan, const Beam& beam) {
  const double sigma_mm = kBandLength * beam.axial_sigma_mm;
  const double step_rad = scan.line_spacing_mm(0.0) / kUnevenness_mm * 2.0 * std::numbers::pi;
  for (int band = 0; band < kBands; ++band) {
    const double level = amplitude_of_db(clutter_level_db(beam, kFirstBand_db - band * kBandDecay_db));
    const double phase = 2.0 * std::numbers::pi * uniform01(kBandSeed, static_cast<std::uint64_t>(band));
    for (std::size_t line = 0; line < static_cast<std::size_t>(scan.lines); ++line) {
      // Two incommensurate waves along the face have no visible pattern.
      const double along = static_cast<double>(line) * step_rad;
      const double wave = 0.5 * (std::sin(along + 2.0 * phase) + std::sin(0.618 * along + 3.0 * phase));
      const double here = level * (1.0 + kBandUnevenness * wave);
      for (std::size_t s = 0; s < clutter_samples_; ++s) {
        const double away = ((static_cast<double>(s) + 0.5) * scan.sample_mm() - band * kBandSpacing_mm) / sigma_mm;
        if (std::abs(away) > 5.0) continue;
        const double value = here * std::exp(-0.5 * away * away);
        clutter_re_[line * clutter_samples_ + s] += static_cast<float>(value * std::cos(phase + wave));
        clutter_im_[line * clutter_samples_ + s] += static_cast<float>(value * std::sin(phase + wave));
      }
    }
  }
}

}  // namespace trocar::ultrasound::detail
