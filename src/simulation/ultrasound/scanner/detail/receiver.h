#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ultrasound/engine/beam.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound::detail {

inline constexpr std::size_t kNoiseLength = std::size_t{1} << 16;
inline constexpr std::size_t kMostSamples = 4096;  ///< Per scanline, see Acquisition.

/// Amplitude of the receiver's noise (root mean square of |re + i im|), before TGC, relative to liver's speckle without
/// attenuation. Assumed, range -70..-45: at this value liver of 0.5 dB/cm/MHz equals the noise at 180 mm and 3.5 MHz
/// (the depth of penetration of IEC 61391-2), and at 70 mm and 9 MHz.
inline constexpr double kReceiverNoise_db = -63.0;

/// Signals that a receiver adds (docs/physics.md U10): noise, and the clutter of its own face. Buffers are allocated by
/// the constructor and, for the clutter, by set_geometry.
class Receiver {
 public:
  Receiver();

  /// Computes noise and clutter with that beam's bandwidth for scanlines of that geometry.
  void set_geometry(const ScanGeometry& scan, const Beam& beam);

  /// Noise of one scanline, real and imaginary part: kMostSamples values of mean 0 and variance 1/2, with the pulse's
  /// correlation along depth. A function of seed and line. Real-time safe.
  struct Noise {
    const float* re;
    const float* im;
  };
  Noise noise(std::uint64_t seed, std::size_t line) const noexcept;

  /// Number of samples with clutter on each scanline: all, or enough that both parts fill a vector (kMostLanes).
  std::size_t clutter_samples() const noexcept { return clutter_samples_; }
  Noise clutter(std::size_t line) const noexcept {
    return {clutter_re_.data() + line * clutter_samples_, clutter_im_.data() + line * clutter_samples_};
  }

 private:
  void filter_noise(double sigma_samples);
  void add_haze(const ScanGeometry& scan, const Beam& beam);
  void add_bands(const ScanGeometry& scan, const Beam& beam);

  std::vector<float> white_;  ///< kNoiseLength, circular.
  std::vector<float> noise_;  ///< The same within the pulse's band, followed by a copy of its beginning.
  std::size_t clutter_samples_ = 0;
  std::vector<float> clutter_re_, clutter_im_;
};

}  // namespace trocar::ultrasound::detail
