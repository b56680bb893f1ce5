#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/image.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/probe/scan_geometry.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {

/// The back end of a scanner: receiver noise and near-field clutter, TGC, envelope, log compression, persistence, gain
/// and gray map, scan conversion (docs/physics.md U10–U11). Buffers are allocated once for a geometry (of scan and
/// beam); show() allocates nothing while the geometry and `is_mirrored` stay the same.
class Scanner {
 public:
  /// Size of the picture: columns >= 16, rows >= 1.
  Scanner(int columns, int rows);
  ~Scanner();
  Scanner(Scanner&&) noexcept;
  Scanner& operator=(Scanner&&) noexcept;

  DisplaySettings settings;  ///< Controls out of range are clamped.
  Artefacts artefacts;       ///< The scanner uses clutter and noise.

  /// Picture of a frame; `seed` is the seed of its noise. Of a frame that renewed some scanlines only, the others stay
  /// as they are, unless settings change. Valid until the next call. Non-finite samples and pixels beyond the scan are
  /// black. The result does not depend on the number of threads.
  const image::GrayImage& show(const BasebandFrame& frame, std::uint64_t seed);
  /// Displays stored levels of a cine loop (see levels()) with the present gain, dynamic range and gray map. Does not
  /// change persistence.
  const image::GrayImage& show_levels(std::span<const std::uint8_t> levels, const ScanGeometry& scan);

  /// The last picture before scan conversion, one gray value per sample, scanline by scanline.
  const std::vector<std::uint8_t>& polar() const noexcept;
  /// The last frame before gain, dynamic range and gray map, one level per sample (level_db); stored by a cine loop.
  const std::vector<std::uint8_t>& levels() const noexcept;
  /// Value of a level, dB after TGC relative to liver's speckle: steps of half a dB from -80, so that a frozen frame
  /// can still be shown darker or brighter by 40 dB.
  static double level_db(std::uint8_t level) noexcept;

  const RasterGeometry& raster() const noexcept;
  /// Clears persistence.
  void reset() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::ultrasound
