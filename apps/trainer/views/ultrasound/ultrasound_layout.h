#pragma once

#include <QPointF>
#include <QRectF>
#include <QSizeF>

#include "ultrasound/live/scan_picture.h"

namespace trocar::trainer {

/// Space for texts and bars beside the scan, in the widget's pixels.
struct MarginSpace {
  QSizeF caption;             ///< At the top left.
  QSizeF bars;                ///< At the right, below the orientation marker; beside the depth scale.
  double scale_width = 34.0;  ///< Depth scale and its numbers, at the right edge.
  double margin = 8.0;
  double marker = 14.0;  ///< Margin of a linear array's image above and at both sides, for its marker.
};

/// Layout of an ultrasound view without items on the scan: the image is as large as fits beside them, and extends
/// between them if the fan leaves its corners empty.
struct UltrasoundLayout {
  QRectF picture;  ///< Rectangle of the whole raster.
  QRectF caption;
  QRectF bars;
  double scale_x = 0.0;  ///< x of the depth scale's line.
};
UltrasoundLayout lay_out(const QSizeF& view, const ultrasound::ScanGeometry& scan, const MarginSpace& room);

/// Magnification of the image on the screen.
struct PictureZoom {
  double factor = 1.0;                  ///< Range 1..kMostZoom; 1: the whole image.
  ultrasound::Vec2 middle_T{0.0, 0.0};  ///< Point of the image plane in the middle of the view's picture area.

  bool operator==(const PictureZoom&) const = default;
};
inline constexpr double kMostZoom = 6.0;

/// Maps image pixels to widget pixels and back: the raster is as large as fits into the layout's picture rectangle, or
/// magnified about a point; then only the part within area() is visible, which is always filled.
class PictureMap {
 public:
  PictureMap(const QRectF& target, const ultrasound::RasterGeometry& raster, const PictureZoom& zoom = {}) noexcept;
  QPointF to_view(const ultrasound::Vec2& p_T) const noexcept;
  ultrasound::Vec2 to_T(const QPointF& place) const noexcept;
  /// Maps a position in raster pixels.
  QPointF pixel_to_view(const ultrasound::Vec2& pixel) const noexcept;
  /// Rectangle of the whole raster.
  QRectF rect() const noexcept { return rect_; }
  /// Its visible part.
  QRectF area() const noexcept { return area_; }
  bool is_magnified() const noexcept { return factor_ > 1.0; }
  double pixels_per_mm() const noexcept { return scale_ / raster_.mm_per_pixel; }
  /// The zoom with another factor (clamped to its range) that leaves the point at `place` where it is, as far as the
  /// image reaches; and the one that moves the image by some widget pixels.
  PictureZoom zoomed_at(const QPointF& place, double factor) const noexcept;
  PictureZoom moved_by(const QPointF& by) const noexcept;

 private:
  ultrasound::RasterGeometry raster_;
  QRectF rect_, area_;
  double scale_ = 1.0;  ///< Widget pixels per raster pixel.
  double factor_ = 1.0;
};

}  // namespace trocar::trainer
