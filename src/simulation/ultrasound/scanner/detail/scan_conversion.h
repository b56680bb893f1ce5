#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound::detail {

/// Scan conversion by a table (docs/physics.md U11). For every block of pixels that the scan touches, the table holds
/// the sources of the pixels' values. Pixels beyond the scan are not written, or are black where a block extends over
/// the edge.
class ScanConversion {
 public:
  /// Allocates the table for the largest scan. columns >= 16, rows >= 1.
  ScanConversion(int columns, int rows);

  /// Computes the table. Reallocates the samples' buffer if lines or samples have increased.
  void set_geometry(const ScanGeometry& scan, const RasterGeometry& raster);

  /// Sets one scanline's samples for `convert_rows`. Smooths them as far as pixels are coarser than samples, so that
  /// speckle is not sampled at random. Threads may set different lines. Real-time safe.
  void set_line(std::size_t line, const std::uint8_t* gray) noexcept;
  /// Computes the pixels of the rows [first, last) from the lines that were set. Threads may convert different rows.
  /// Real-time safe.
  void convert_rows(std::size_t first, std::size_t last, std::uint8_t* pixels) const noexcept;

 private:
  void set_block(std::size_t block, int column, int row, const ScanGeometry& scan, const RasterGeometry& raster);

  int columns_;
  int rows_;
  int lines_ = 0;
  int samples_ = 0;
  unsigned neighbour_weight_ = 0;           ///< Weight of each neighbour on the line, in 1/256. 0..64.
  std::vector<std::uint8_t> line_samples_;  ///< Samples of the lines, then black.
  std::vector<std::size_t> row_blocks_;     ///< First block of each row, and the total number.
  std::vector<std::int32_t> block_start_;
  std::vector<std::int32_t> sample_;
  std::vector<std::uint8_t> along_line_;
  std::vector<std::uint8_t> across_lines_;
};

}  // namespace trocar::ultrasound::detail
