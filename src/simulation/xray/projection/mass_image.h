#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trocar::xray {

/// Basis materials: the matter on a ray is a mass per area of each. Body tissues are mixtures of the first two, which
/// have the same attenuation at all energies of a tube (no body tissue has an edge there).
enum class Basis : std::uint8_t { kWater, kBone, kIodine, kSteel };
inline constexpr std::size_t kBases = 4;

/// Mass per area (g/cm²) of the basis materials along the ray of each pixel, row by row. An empty image is zero
/// everywhere.
struct MassImage {
  int columns = 0, rows = 0;
  std::array<std::vector<float>, kBases> g_per_cm2;

  std::vector<float>& of(Basis basis) noexcept { return g_per_cm2[static_cast<std::size_t>(basis)]; }
  const std::vector<float>& of(Basis basis) const noexcept { return g_per_cm2[static_cast<std::size_t>(basis)]; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

}  // namespace trocar::xray
