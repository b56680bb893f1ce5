#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ultrasound/figures/image_statistics.h"
#include "ultrasound/figures/speckle_statistics.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// A gray picture with its fan.
struct FanPicture {
  RasterGeometry raster;
  ScanGeometry scan;
  std::span<const std::uint8_t> pixels;  ///< raster.rows * raster.columns, row by row.
};

/// The picture as the beam saw it: gray, bilinear, on `lines` scanlines. Beyond the picture is 0.
EchoPatch polar_picture(const FanPicture& picture, int lines, double sample_mm);

/// How gray pictures look, in figures that recorded and simulated ones are held together by. They are taken from the
/// picture after scan conversion, from both alike.
struct PictureFigures {
  GrayHistogram histogram{};  ///< Of all samples of the fan, in polar coordinates.
  struct Level {
    double depth_mm, mean, median, p99;
  };
  std::vector<Level> levels;  ///< Gray of the middle two thirds of the scanlines, in bands of depth.
  struct Speckle {
    double depth_mm = 0.0;
    int patches = 0;
    double mean = 0.0, standard_deviation = 0.0;        ///< Gray. This and the following: medians over patches.
    double axial_fwhm_mm = 0.0, lateral_fwhm_mm = 0.0;  ///< Of the autocovariance without trend.
    double skewness = 0.0;
  };
  std::vector<Speckle> speckle;  ///< Of homogeneous patches; bands without enough of them are left out.
};

/// Gathers figures over pictures of one kind.
class PictureStatistics {
 public:
  void add(const FanPicture& picture);
  PictureFigures figures() const;

 private:
  struct Patch {
    double depth_mm, mean, standard_deviation, skewness, axial_fwhm_mm, lateral_fwhm_mm;
  };
  void add_patches(const EchoPatch& polar, const ScanGeometry& scan);

  std::array<std::size_t, 256> counts_{};
  std::vector<std::array<std::size_t, 256>> band_counts_;
  std::vector<Patch> patches_;
};

}  // namespace trocar::ultrasound
