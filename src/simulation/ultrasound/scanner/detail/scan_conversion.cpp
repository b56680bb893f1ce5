#include "ultrasound/scanner/detail/scan_conversion.h"

#include <algorithm>
#include <cmath>

#include "core/result.h"
#include "ultrasound/scanner/detail/scanner_kernels.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr int kPixelBlock = static_cast<int>(kMostLanes);
/// Tolerance for rounding at the outermost scanline.
constexpr double kLineTolerance = 1e-6;

bool is_inside(const Polar& place, const ScanGeometry& scan) {
  return place.depth_mm >= 0.0 && place.depth_mm <= scan.depth_mm && place.line >= -kLineTolerance &&
         place.line <= scan.lines - 1 + kLineTolerance;
}

struct Split {
  int first;
  std::uint8_t weight;  ///< Weight of the next value, of 255.
};
/// The pair of values around a position among `count`; positions beyond the ends are clamped.
Split split(double place, int count) {
  const double clamped = std::clamp(place, 0.0, static_cast<double>(count - 1));
  const int first = std::min(static_cast<int>(clamped), count - 2);
  return {first, static_cast<std::uint8_t>(std::lround(255.0 * (clamped - first)))};
}

}  // namespace

ScanConversion::ScanConversion(int columns, int rows) : columns_(columns), rows_(rows) {
  TROCAR_CHECK(columns >= kPixelBlock && rows >= 1);
  const auto blocks =
      static_cast<std::size_t>((columns + kPixelBlock - 1) / kPixelBlock) * static_cast<std::size_t>(rows);
  row_blocks_.resize(static_cast<std::size_t>(rows) + 1);
  block_start_.resize(blocks);
  sample_.resize(blocks * kMostLanes);
  along_line_.resize(blocks * kMostLanes);
  across_lines_.resize(blocks * kMostLanes);
}

void ScanConversion::set_geometry(const ScanGeometry& scan, const RasterGeometry& raster) {
  TROCAR_CHECK(scan.lines >= 2 && scan.samples >= 2 && raster.columns == columns_ && raster.rows == rows_);
  lines_ = scan.lines;
  samples_ = scan.samples;
  // The last line is followed by black, for both lines of a pixel beyond the scan and for the width of the gathers.
  const auto black = 2 * static_cast<std::size_t>(samples_) + sizeof(std::int32_t);
  line_samples_.assign(static_cast<std::size_t>(lines_) * static_cast<std::size_t>(samples_) + black, 0);
  const double coarseness = raster.mm_per_pixel / scan.sample_mm();
  neighbour_weight_ = static_cast<unsigned>(std::lround(64.0 * std::clamp(coarseness - 1.0, 0.0, 1.0)));

  std::size_t block = 0;
  for (int row = 0; row < rows_; ++row) {
    row_blocks_[static_cast<std::size_t>(row)] = block;
    for (int column = 0; column < columns_; column += kPixelBlock) {
      const int first = std::min(column, columns_ - kPixelBlock);  // the last one may overlap the previous one
      bool touches = false;
      for (int c = first; c < first + kPixelBlock && !touches; ++c) {
        touches = is_inside(scan.to_polar(raster.to_T(c, row)), scan);
      }
      if (touches) set_block(block++, first, row, scan, raster);
    }
  }
  row_blocks_.back() = block;
}

void ScanConversion::set_block(std::size_t block, int column, int row, const ScanGeometry& scan,
                               const RasterGeometry& raster) {
  block_start_[block] = row * columns_ + column;
  for (int i = 0; i < kPixelBlock; ++i) {
    const std::size_t entry = block * kMostLanes + static_cast<std::size_t>(i);
    const Polar place = scan.to_polar(raster.to_T(column + i, row));
    if (!is_inside(place, scan)) {
      sample_[entry] = lines_ * samples_;
      along_line_[entry] = across_lines_[entry] = 0;
      continue;
    }
    const Split line = split(place.line, lines_);
    const Split sample = split(place.depth_mm / scan.sample_mm() - 0.5, samples_);
    sample_[entry] = line.first * samples_ + sample.first;
    along_line_[entry] = sample.weight;
    across_lines_[entry] = line.weight;
  }
}

void ScanConversion::set_line(std::size_t line, const std::uint8_t* gray) noexcept {
  const auto n = static_cast<std::size_t>(samples_);
  std::uint8_t* const target = line_samples_.data() + line * n;
  if (neighbour_weight_ == 0) {
    std::copy_n(gray, n, target);
    return;
  }
  // 16 bits suffice for the sum, so that the compiler processes eight samples at a time.
  const auto side = static_cast<std::uint16_t>(neighbour_weight_);
  const auto middle = static_cast<std::uint16_t>(256 - 2 * neighbour_weight_);
  target[0] = gray[0];
  for (std::size_t s = 1; s + 1 < n; ++s) {
    const auto sum = static_cast<std::uint16_t>(gray[s] * middle + (gray[s - 1] + gray[s + 1]) * side + 128);
    target[s] = static_cast<std::uint8_t>(sum >> 8);
  }
  target[n - 1] = gray[n - 1];
}

void ScanConversion::convert_rows(std::size_t first, std::size_t last, std::uint8_t* pixels) const noexcept {
  const std::size_t begin = row_blocks_[first];
  const std::size_t end = row_blocks_[last];
  const std::size_t entry = begin * kMostLanes;
  const PixelSources sources{sample_.data() + entry, along_line_.data() + entry, across_lines_.data() + entry,
                             samples_};
  interpolate_pixels(sources, line_samples_.data(), block_start_.data() + begin, end - begin, pixels);
}

}  // namespace trocar::ultrasound::detail
