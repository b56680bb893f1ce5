#pragma once

#include <cstdint>
#include <span>

namespace trocar::xray {

/// Number of photons behind a signal.
struct PhotonCount {
  double open_beam = 0.0;     ///< Detected photons per pixel and exposure in the open beam (signal 1). > 0.
  double noise_factor = 1.0;  ///< Beam::noise_factor().
};

/// Adds the noise of counted photons: normal, independent from pixel to pixel, with the variance
/// noise_factor * signal / open_beam, and keeps the signal >= 0. The numbers depend on the seed and the pixel only,
/// not on the number of threads. All cores, no allocation. docs/physics.md, X9.
void add_quantum_noise(const PhotonCount& photons, std::uint64_t seed, std::span<float> signal);

}  // namespace trocar::xray
