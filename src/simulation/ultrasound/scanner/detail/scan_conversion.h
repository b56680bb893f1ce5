#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound::detail {

/// From scanlines to pixels by a table (docs/physics.md U11): for every block of pixels that the scan touches, where
/// its values come from. Pixels beyond the scan are left alone, or black where a block reaches over the edge.
class ScanConversion {
 public:
  /// Takes the table for the largest scan. columns >= 16, rows >= 1.
  ScanConversion(int columns, int rows);

  /// Makes the table. Takes the samples' buffer anew where lines or samples have become more.
  void set_geometry(const ScanGeometry& scan, const RasterGeometry& raster);

  /// One scanline's samples on their way to `convert_rows`; smoothed as far as pixels are coarser than samples, so that
  /// speckle is not picked at random. Threads may set different lines. Real-time safe.
  void set_line(std::size_t line, const std::uint8_t* gray) noexcept;
  /// Pixels of the rows [first, last) from the lines that were set. Threads may convert different rows. Real-time safe.
  void convert_rows(std::size_t first, std::size_t last, std::uint8_t* pixels) const noexcept;

 private:
  void set_block(std::size_t block, int column, int row, const ScanGeometry& scan, const RasterGeometry& raster);

  int columns_;
  int rows_;
  int lines_ = 0;
  int samples_ = 0;
  unsigned neighbour_weight_ = 0;           ///< Of 256, of each neighbour on the line. 0..64.
  std::vector<std::uint8_t> line_samples_;  ///< The lines, then black.
  std::vector<std::size_t> row_blocks_;     ///< First block of each row, and the number of all.
  std::vector<std::int32_t> block_start_;
  std::vector<std::int32_t> sample_;
  std::vector<std::uint8_t> along_line_;
  std::vector<std::uint8_t> across_lines_;
};

}  // namespace trocar::ultrasound::detail
