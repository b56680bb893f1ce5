#include "views/ultrasound/ultrasound_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace trocar::trainer {
namespace {

/// Steps of the search for the largest image, and of the test whether a box overlaps the scan.
constexpr int kSearchSteps = 12;
constexpr double kOverlapStep_px = 5.0;
constexpr double kClearance_px = 4.0;

bool touches(const QRectF& box, const QRectF& picture, const ultrasound::RasterGeometry& raster,
             const ultrasound::ScanGeometry& scan) {
  if (box.isEmpty()) return false;
  const QRectF wide = box.adjusted(-kClearance_px, -kClearance_px, kClearance_px, kClearance_px);
  const int columns = std::max(2, static_cast<int>(std::ceil(wide.width() / kOverlapStep_px)));
  const int rows = std::max(2, static_cast<int>(std::ceil(wide.height() / kOverlapStep_px)));
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const double x = wide.left() + wide.width() * c / columns - picture.left();
      const double y = wide.top() + wide.height() * r / rows - picture.top();
      const ultrasound::Polar at = scan.to_polar(raster.to_T(x - 0.5, y - 0.5));
      if (at.line >= 0.0 && at.line <= scan.lines - 1 && at.depth_mm >= 0.0 && at.depth_mm <= scan.depth_mm)
        return true;
    }
  return false;
}

}  // namespace

UltrasoundLayout lay_out(const QSizeF& view, const ultrasound::ScanGeometry& scan, const MarginSpace& room) {
  UltrasoundLayout layout;
  layout.scale_x = view.width() - room.scale_width;
  layout.caption = QRectF(QPointF(room.margin, room.margin), room.caption);
  layout.bars = QRectF(QPointF(layout.scale_x - 2.0 * room.margin - room.bars.width(), 3.5 * room.margin), room.bars);
  const double left_most = room.caption.isEmpty() ? 0.0 : room.caption.width() + 1.5 * room.margin;
  const double right_most = room.bars.isEmpty() ? 0.0 : room.bars.width() + 1.5 * room.margin;
  const double marker = scan.is_fan ? 0.0 : room.marker;
  double best_mm_per_pixel = std::numeric_limits<double>::infinity();
  for (int l = 0; l <= kSearchSteps; ++l)
    for (int r = 0; r <= kSearchSteps; ++r) {
      const double left = left_most * l / kSearchSteps, right = right_most * r / kSearchSteps;
      const QRectF picture(left + marker, marker,
                           std::max(16.0, layout.scale_x - room.margin - left - right - 2.0 * marker),
                           std::max(16.0, view.height() - marker));
      const ultrasound::RasterGeometry raster =
          ultrasound::fit_raster(scan, static_cast<int>(picture.width()), static_cast<int>(picture.height()));
      // Of equal sizes, the smallest displacement of the image is preferred.
      const double moved = 1.0 + 1e-4 * (std::abs(l - r) + l + r);
      if (raster.mm_per_pixel * moved >= best_mm_per_pixel) continue;
      if (l < kSearchSteps && touches(layout.caption, picture, raster, scan)) continue;
      if (r < kSearchSteps && touches(layout.bars, picture, raster, scan)) continue;
      best_mm_per_pixel = raster.mm_per_pixel * moved;
      layout.picture = picture;
    }
  return layout;
}

PictureMap::PictureMap(const QRectF& target, const ultrasound::RasterGeometry& raster, const PictureZoom& zoom) noexcept
    : raster_(raster) {
  const double fitting = std::min(target.width() / raster.columns, target.height() / raster.rows);
  const QSizeF size(fitting * raster.columns, fitting * raster.rows);
  area_ = QRectF(target.center() - QPointF(0.5 * size.width(), 0.5 * size.height()), size);
  factor_ = std::clamp(zoom.factor, 1.0, kMostZoom);
  scale_ = factor_ * fitting;
  rect_ = QRectF(area_.topLeft(), factor_ * size);
  if (!is_magnified()) return;
  const QPointF wanted = rect_.topLeft() + area_.center() - to_view(zoom.middle_T);
  // No gap beside the image.
  rect_.moveTo(std::clamp(wanted.x(), area_.right() - rect_.width(), area_.left()),
               std::clamp(wanted.y(), area_.bottom() - rect_.height(), area_.top()));
}

PictureZoom PictureMap::zoomed_at(const QPointF& place, double factor) const noexcept {
  const double held = std::clamp(factor, 1.0, kMostZoom);
  // The middle of the area lies at the same share of the way from the fixed place.
  return {held, to_T(place + (factor_ / held) * (area_.center() - place))};
}

PictureZoom PictureMap::moved_by(const QPointF& by) const noexcept {
  return {factor_, to_T(area_.center() - by)};
}

QPointF PictureMap::pixel_to_view(const ultrasound::Vec2& pixel) const noexcept {
  return rect_.topLeft() + scale_ * QPointF(pixel.x() + 0.5, pixel.y() + 0.5);
}

QPointF PictureMap::to_view(const ultrasound::Vec2& p_T) const noexcept {
  return pixel_to_view(raster_.to_pixel(p_T));
}

ultrasound::Vec2 PictureMap::to_T(const QPointF& place) const noexcept {
  const QPointF pixel = (place - rect_.topLeft()) / scale_;
  return raster_.to_T(pixel.x() - 0.5, pixel.y() - 0.5);
}

}  // namespace trocar::trainer
