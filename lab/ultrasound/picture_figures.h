#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lab/ultrasound/image_statistics.h"
#include "lab/ultrasound/oblique_border.h"
#include "lab/ultrasound/speckle_statistics.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// A gray picture with its fan.
struct FanPicture {
  RasterGeometry raster;
  ScanGeometry scan;
  std::span<const std::uint8_t> pixels;  ///< raster.rows * raster.columns, row by row.
};

/// The picture in scanline coordinates: gray, bilinear, on `lines` scanlines. 0 outside the picture.
EchoPatch polar_picture(const FanPicture& picture, int lines, double sample_mm);

/// Statistics of gray pictures for the comparison of recorded with simulated ones. Computed in both cases from the
/// picture after scan conversion.
struct PictureFigures {
  GrayHistogram histogram{};  ///< Histogram of all samples of the fan, in polar coordinates.
  struct Level {
    double depth_mm, mean, median, p99;
  };
  std::vector<Level> levels;  ///< Gray values of the middle two thirds of the scanlines, in bands of depth.
  struct Speckle {
    double depth_mm = 0.0;
    int patches = 0;
    double mean = 0.0, standard_deviation = 0.0;        ///< Gray. This and the following: medians over patches.
    double axial_fwhm_mm = 0.0, lateral_fwhm_mm = 0.0;  ///< Widths of the autocovariance without trend.
    double skewness = 0.0;
  };
  std::vector<Speckle> speckle;  ///< Speckle of homogeneous patches; bands with too few patches are left out.
  /// Gray values of the organ in the middle of the fan, 40 to 100 mm deep, without trend, in units of the standard
  /// deviation of their depth: vessels, walls and streaks included, organ borders excluded.
  struct Texture {
    std::size_t pixels = 0;
    double skewness = 0.0, kurtosis = 0.0;
    double bright_permille = 0.0;  ///< Share beyond four standard deviations.
  };
  Texture texture;
  /// The brightest oblique border deeper than 60 mm (the diaphragm in a liver sweep): medians over scanlines where it
  /// is met at 25 to 45 degrees.
  struct Border {
    int scanlines = 0;
    double above_gray = 0.0;    ///< Above the organ in front of it.
    double thickness_mm = 0.0;  ///< Across the border, at half of that.
  };
  Border border;
};

/// Accumulates statistics over pictures of one kind.
class PictureStatistics {
 public:
  void add(const FanPicture& picture);
  PictureFigures figures() const;

 private:
  struct Patch {
    double depth_mm, mean, standard_deviation, skewness, axial_fwhm_mm, lateral_fwhm_mm;
  };
  void add_patches(const EchoPatch& polar, const ScanGeometry& scan);
  void add_texture(const EchoPatch& patch, const EchoPatch& flat);

  std::array<std::size_t, 256> counts_{};
  std::vector<std::array<std::size_t, 256>> band_counts_;
  std::vector<Patch> patches_;
  std::vector<std::vector<float>> textures_;  ///< Per band of depth: gray values without trend.
  std::vector<ObliqueBorder> borders_;
};

}  // namespace trocar::ultrasound
