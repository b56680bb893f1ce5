#pragma once

#include <QColor>
#include <QPainter>
#include <span>

#include "geometry/shapes.h"
#include "slices/slice_geometry.h"
#include "tasks/task.h"

namespace trocar::trainer {

/// Canvas to draw over a slice on the screen. The geometry is in device pixels, the painter in points.
struct SliceCanvas {
  QPainter& painter;
  const slices::SliceGeometry& geometry;
  QRectF picture;  ///< Points of the widget.
  double device_pixel_ratio = 1.0;

  QPointF to_point(const Vec3& p_P) const;
};

/// Objects within this distance of the plane are drawn as in the plane.
inline constexpr double kInPlane_mm = 1.5;

/// A line in P: solid within the plane, dashed and faint elsewhere, on a dark halo.
void draw_line(const SliceCanvas& canvas, std::span<const Vec3> points_P, const QColor& color, double width);
/// The shaft and a dot at its last point, the tip: filled in the plane, a ring elsewhere.
void draw_needle(const SliceCanvas& canvas, std::span<const Vec3> shaft_P);
/// Dots ahead of the tip, along the needle's axis.
void draw_aim(const SliceCanvas& canvas, std::span<const Vec3> shaft_P);
/// The line of an expert path, with a ring at its entry.
void draw_path(const SliceCanvas& canvas, const Segment& path_P);
/// Another expert path: faint, without a ring.
void draw_other_path(const SliceCanvas& canvas, const Segment& path_P);
/// Cross-hairs on the target, faint if it is off the plane.
void draw_target(const SliceCanvas& canvas, const Vec3& p_P);
/// The circle in which the plane cuts the zone's sphere; draws nothing if it does not.
void draw_entry_zone(const SliceCanvas& canvas, const tasks::EntryZone& zone);

struct CrossColors {
  QColor vertical, horizontal;
};
/// The traces of two other planes through a point, with a gap about the point; `only_ends`: draws them at the borders
/// only.
void draw_crosshair(const SliceCanvas& canvas, const Vec3& p_P, const CrossColors& colors, bool only_ends);
/// Text with a dark rim, readable on any gray.
void draw_text(QPainter& painter, const QPointF& baseline, const QString& text, const QColor& color);
/// Orientation letters at the four borders.
void draw_letters(const SliceCanvas& canvas);
/// A bar of 1, 2 or 5 times a power of ten mm at the lower left.
void draw_scale_bar(const SliceCanvas& canvas);

}  // namespace trocar::trainer
