#pragma once

#include <Eigen/Core>

#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

using Vec2 = Eigen::Vector2d;

/// A point of the image plane in scanline coordinates.
struct Polar {
  double line = 0.0;      ///< Scanline, fractional; 0 is at the most negative x.
  double depth_mm = 0.0;  ///< Along the scanline, from the face.
};

/// Positions of scanlines and samples in the image plane (x, y) of T. Scanlines are radii of a circle of `radius_mm`
/// (convex; 0 for a phased array, whose apex is the middle of its face) or parallel (linear). Samples lie at depth (s +
/// 1/2) * sample_mm.
struct ScanGeometry {
  bool is_fan = true;
  double radius_mm = 60.0;  ///< Radius of the face; fans only.
  double line_step = 0.0;   ///< Step between scanlines: rad (fan) or mm (parallel).
  int lines = 256;
  int samples = 1024;
  double depth_mm = 160.0;

  double sample_mm() const noexcept { return depth_mm / samples; }
  double middle_line() const noexcept { return 0.5 * (lines - 1); }
  /// Origin of a scanline on the face, and its unit direction; in (x, y) of T.
  Vec2 line_origin(double line) const noexcept;
  Vec2 line_direction(double line) const noexcept;
  /// Distance between neighbouring scanlines at a depth, mm.
  double line_spacing_mm(double depth_mm) const noexcept;
  /// Exact inverses of each other for |angle| < pi/2 and, on a fan, depth > -radius. Real-time safe.
  Vec2 to_cartesian(const Polar& place) const noexcept;
  Polar to_polar(const Vec2& p_T) const noexcept;
  /// Smallest rectangle of (x, y) in T that holds all samples: from (x0, y0) to (x1, y1).
  struct Extent {
    double x0, y0, x1, y1;
  };
  Extent extent() const noexcept;
};

/// The scan of a transducer to a depth. lines >= 2, samples >= 2.
ScanGeometry make_scan_geometry(const Transducer& transducer, double depth_mm, int lines, int samples);

/// Pixels of the picture: square, `mm_per_pixel` wide, the fan centred and as large as fits. Pixel centres at integers;
/// column along +x of T (mirrored: -x), row along +y.
struct RasterGeometry {
  int columns = 640;
  int rows = 480;
  double mm_per_pixel = 0.4;
  Vec2 first_T{0.0, 0.0};  ///< (x, y) of the middle of pixel (0, 0).
  bool is_mirrored = false;

  Vec2 to_T(double column, double row) const noexcept;
  /// (column, row), fractional.
  Vec2 to_pixel(const Vec2& p_T) const noexcept;
};
RasterGeometry fit_raster(const ScanGeometry& scan, int columns, int rows, bool is_mirrored = false);

}  // namespace trocar::ultrasound
