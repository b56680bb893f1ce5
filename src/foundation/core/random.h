#pragma once

#include <cstdint>

namespace trocar {
inline namespace core {

/// Mixes 64 bits (SplitMix64 finaliser): the same on every machine. Real-time safe.
constexpr std::uint64_t mix64(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Counter-based uniform number in [0, 1): a pure function of seed and counter. Real-time safe.
constexpr double uniform01(std::uint64_t seed, std::uint64_t counter) noexcept {
  return static_cast<double>(mix64(mix64(seed) ^ counter) >> 11) * 0x1.0p-53;
}

/// Seeded random numbers, the same sequence on every machine (unlike std's distributions). Real-time safe.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : seed_(seed) {}
  std::uint64_t next() noexcept { return mix64(mix64(seed_) ^ counter_++); }
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1.0p-53; }  ///< [0, 1)
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  double normal() noexcept;  ///< Mean 0, standard deviation 1 (Box-Muller).

 private:
  std::uint64_t seed_;
  std::uint64_t counter_ = 0;
};

}  // namespace core
}  // namespace trocar
