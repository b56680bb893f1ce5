#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "ultrasound/artefacts.h"
#include "ultrasound/b_mode.h"
#include "ultrasound/scan_geometry.h"
#include "volume/image.h"

namespace trocar {

inline constexpr int kTgcSliders = 8;

enum class GrayMap { kLinear, kSoft, kHighContrast };

/// The knobs behind the receiver: they change the picture of echoes that are there already.
struct DisplaySettings {
  double gain_db = 0.0;                      ///< Range -40..40.
  std::array<double, kTgcSliders> tgc_db{};  ///< From near to far, beside the automatic part. Range -20..20.
  double automatic_tgc_db_per_cm_mhz = 0.5;  ///< Two-way loss that is made good. Range 0..1.5 (one way).
  double dynamic_range_db = 60.0;            ///< Range 20..100.
  double persistence = 0.0;                  ///< Part of the last picture that stays. Range 0..0.95.
  GrayMap gray_map = GrayMap::kSoft;
  bool is_mirrored = false;  ///< Left and right swapped, as the orientation marker says.
};

/// A gray picture, row by row from the top left.
struct GrayImage {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;
};

/// The back end of a scanner: receiver noise and near-field clutter, gain and TGC, envelope, log compression,
/// persistence, gray map, scan conversion (docs/physics.md U9–U11). Buffers are taken once for a geometry; show
/// allocates nothing while that stays.
class Scanner {
 public:
  Scanner(int columns, int rows);
  ~Scanner();
  Scanner(Scanner&&) noexcept;
  Scanner& operator=(Scanner&&) noexcept;

  DisplaySettings settings;
  Artefacts artefacts;  ///< Of these: clutter, noise.

  /// The picture of a frame; `seed` makes its noise. Valid until the next call.
  const GrayImage& show(const BasebandFrame& frame, std::uint64_t seed) noexcept;
  /// The same before scan conversion, gray value a sample, scanline by scanline: what a cine loop keeps.
  const std::vector<std::uint8_t>& polar() const noexcept;
  const RasterGeometry& raster() const noexcept;
  /// Forgets the pictures that persist.
  void reset() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar
