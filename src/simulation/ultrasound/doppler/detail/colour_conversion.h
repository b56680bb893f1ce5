#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/doppler/colour_doppler.h"

namespace trocar::ultrasound::detail {

bool is_same_scan(const ScanGeometry& a, const ScanGeometry& b) noexcept;

/// Draws the colours of cells over the gray picture's pixels. The autocorrelation is interpolated between cells, not
/// the velocity, so that aliasing changes from red to blue without colours in between. Tables are made for a geometry.
class ColourConversion {
 public:
  ColourConversion() : image_() {}
  /// Discards the tables.
  void forget() noexcept { is_made_ = false; }
  const image::RgbImage& convert(const image::GrayImage& image, const RasterGeometry& raster, const ScanGeometry& scan,
                                 const DopplerFrame& frame, const DopplerSettings& settings);

 private:
  /// A pixel within the box: its cell (lower line and gate), and its distances to the next line and gate in 1/255 of a
  /// cell.
  struct Place {
    std::int32_t pixel;
    std::int32_t cell;
    std::uint8_t across, along;
  };
  static constexpr std::size_t kColours = 512;

  void make_tables(const image::GrayImage& image, const RasterGeometry& raster, const ScanGeometry& scan,
                   const DopplerFrame& frame);
  void set_colours(const DopplerSettings& settings) noexcept;

  bool is_made_ = false;
  RasterGeometry raster_;
  image::RgbImage image_;
  std::vector<Place> places_;
  std::vector<std::int32_t> outline_;
  std::array<image::Rgb, kColours> colours_{};  ///< From -1 to 1 in fractions of the scale.
};

}  // namespace trocar::ultrasound::detail
