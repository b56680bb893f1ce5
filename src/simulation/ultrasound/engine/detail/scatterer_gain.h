#pragma once

#include <array>
#include <cstdint>

namespace trocar::ultrasound::detail {

/// Gain of scatterers at a position: logarithm of their amplitude and the share that is present, in 16 bits. Many
/// scatterers read gains at scattered positions, and half a float's size fits the cache.
using ScattererGain = std::uint16_t;

inline constexpr int kShareBits = 3;
/// Shares of scatterers; a tissue gets the nearest.
inline constexpr std::array<float, 1 << kShareBits> kShares{1.0F, 0.8F, 0.5F, 0.3F, 0.1F, 0.05F, 0.02F, 0.0F};
inline constexpr float kLeastLogGain = -30.0F;  ///< Neper; a negligible amplitude.
inline constexpr float kLogGainStep = 36.0F / 8191.0F;

/// Class of a share, index into kShares.
std::uint8_t share_class(double share) noexcept;

/// gain[s] of log_gain[s] + added[s] neper and the share's class; inputs must extend 16 values beyond n.
void pack_gains(const float* log_gain, const float* added, const std::uint8_t* share_classes, int n,
                ScattererGain* gains) noexcept;

/// The gain reduced by `neper`.
constexpr ScattererGain attenuate(ScattererGain gain, float neper) noexcept {
  const auto steps = static_cast<int>(neper / kLogGainStep + 0.5F);
  const int level = (gain >> kShareBits) - steps;
  return static_cast<ScattererGain>((level > 0 ? level : 0) << kShareBits | (gain & ((1 << kShareBits) - 1)));
}

}  // namespace trocar::ultrasound::detail
