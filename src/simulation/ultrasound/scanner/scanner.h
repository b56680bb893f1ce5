#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ultrasound/engine/artefacts.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/probe/scan_geometry.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {

/// A gray picture, row by row from the top left.
struct GrayImage {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;
};

/// The back end of a scanner: receiver noise and near-field clutter, TGC, envelope, log compression, persistence, gain
/// and gray map, scan conversion (docs/physics.md U10–U11). Buffers are taken once for a geometry (of scan and beam);
/// show allocates nothing while that and `is_mirrored` stay.
class Scanner {
 public:
  /// Of the picture: columns >= 16, rows >= 1.
  Scanner(int columns, int rows);
  ~Scanner();
  Scanner(Scanner&&) noexcept;
  Scanner& operator=(Scanner&&) noexcept;

  DisplaySettings settings;  ///< Controls beyond their range are held in it.
  Artefacts artefacts;       ///< Of these: clutter, noise.

  /// The picture of a frame; `seed` makes its noise. Valid until the next call. Samples that are no number are black,
  /// as is what is beyond the scan. The same whatever the number of threads.
  const GrayImage& show(const BasebandFrame& frame, std::uint64_t seed) noexcept;
  /// Displays stored levels of a cine loop (see levels()) with the present gain, dynamic range and gray map. Does not
  /// change persistence.
  const GrayImage& show_levels(std::span<const std::uint8_t> levels, const ScanGeometry& scan) noexcept;

  /// The last picture before scan conversion, gray value a sample, scanline by scanline.
  const std::vector<std::uint8_t>& polar() const noexcept;
  /// The last frame shown before gain, dynamic range and gray map, a level a sample (level_db): what a cine loop keeps.
  const std::vector<std::uint8_t>& levels() const noexcept;
  /// What a level stands for, dB after TGC against liver's speckle: steps of half a dB from -80, so that a frozen frame
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
