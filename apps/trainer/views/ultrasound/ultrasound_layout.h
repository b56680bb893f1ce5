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

/// Maps image pixels to widget pixels and back: the raster is as large as fits into the layout's picture rectangle.
class PictureMap {
 public:
  PictureMap(const QRectF& target, const ultrasound::RasterGeometry& raster) noexcept;
  QPointF to_view(const ultrasound::Vec2& p_T) const noexcept;
  ultrasound::Vec2 to_T(const QPointF& place) const noexcept;
  /// Maps a position in raster pixels.
  QPointF pixel_to_view(const ultrasound::Vec2& pixel) const noexcept;
  QRectF rect() const noexcept { return rect_; }
  double pixels_per_mm() const noexcept { return scale_ / raster_.mm_per_pixel; }

 private:
  ultrasound::RasterGeometry raster_;
  QRectF rect_;
  double scale_ = 1.0;  ///< Widget pixels per raster pixel.
};

}  // namespace trocar::trainer
