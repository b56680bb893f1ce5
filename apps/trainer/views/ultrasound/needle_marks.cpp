#include "views/ultrasound/needle_marks.h"

#include <QPolygonF>
#include <algorithm>
#include <cmath>

#include "ui_kit/theme.h"
#include "views/ultrasound/ultrasound_painter.h"

namespace trocar::trainer {
namespace {

constexpr double kAhead_mm = 250.0, kAxisStep_mm = 1.0;

/// The part of a line near the plane, in the view.
QPolygonF part_near_plane(const PictureMap& map, const ultrasound::ScanPicture& picture, const Segment& line_P) {
  const Pose X_TP = picture.X_PT.inverse();
  const double length_mm = line_P.length_mm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length_mm / kAxisStep_mm)));
  QPolygonF part;
  for (int n = 0; n <= steps; ++n) {
    const Vec3 p_P = line_P.a + static_cast<double>(n) / steps * (line_P.b - line_P.a);
    if (std::abs((X_TP * p_P).z()) <= kNearPlane_mm) part << map.to_view(ultrasound::shown_place_T(picture, p_P));
  }
  return part;
}

}  // namespace

void draw_guide(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Vec2> line_T) {
  painter.setBrush(theme().path);
  painter.setPen(Qt::NoPen);
  double along_mm = 0.0, next_mm = 0.0;
  constexpr double kDot_mm = 2.5;
  constexpr int kDotsPerCm = 4;
  int dots = 0;
  for (std::size_t n = 1; n < line_T.size(); ++n) {
    const double length_mm = (line_T[n] - line_T[n - 1]).norm();
    for (; length_mm > 0.0 && next_mm <= along_mm + length_mm; next_mm += kDot_mm, ++dots) {
      const ultrasound::Vec2 at_T = line_T[n - 1] + (next_mm - along_mm) / length_mm * (line_T[n] - line_T[n - 1]);
      painter.drawEllipse(map.to_view(at_T), dots % kDotsPerCm == 0 ? 2.2 : 1.0, dots % kDotsPerCm == 0 ? 2.2 : 1.0);
    }
    along_mm += length_mm;
  }
  painter.setBrush(Qt::NoBrush);
}

void draw_needle_axis(QPainter& painter, const PictureMap& map, const ultrasound::ScanPicture& picture,
                      std::span<const Vec3> shaft_P) {
  if (shaft_P.size() < 2) return;
  const Vec3 tip_P = shaft_P.back();
  const Vec3 along_P = (tip_P - shaft_P[shaft_P.size() - 2]).normalized();
  if (!along_P.allFinite()) return;
  const Pose X_TP = picture.X_PT.inverse();
  const Vec3 tip_T = X_TP * tip_P;
  const Vec3 along_T = X_TP.R() * along_P;
  QPolygonF near;
  for (double s = 0.0; s <= kAhead_mm; s += kAxisStep_mm)
    if (std::abs(tip_T.z() + s * along_T.z()) <= kNearPlane_mm)
      near << map.to_view(ultrasound::shown_place_T(picture, tip_P + s * along_P));
  painter.setBrush(Qt::NoBrush);
  painter.setPen(dotted_pen(theme().path, 2.0));
  painter.drawPolyline(near);
  // An axis nearly parallel to the plane has no well-defined intersection.
  constexpr double kLeastSlope = 0.05;
  if (std::abs(along_T.z()) < kLeastSlope) return;
  const double pierce_mm = -tip_T.z() / along_T.z();
  const QPointF at = map.to_view(ultrasound::shown_place_T(picture, tip_P + pierce_mm * along_P));
  painter.setPen(QPen(QColor(0, 0, 0, 200), 4.0));
  draw_cross(painter, at, 8.0);
  painter.setPen(QPen(theme().path, 2.0));
  draw_cross(painter, at, 8.0);
}

void draw_throw(QPainter& painter, const PictureMap& map, const ultrasound::ScanPicture& picture,
                const Segment& throw_P, const std::optional<Segment>& notch_P) {
  constexpr double kThrow_px = 1.5, kNotch_px = 3.0, kHalfBar_px = 5.0;
  const QPolygonF way = part_near_plane(map, picture, throw_P);
  if (way.size() < 2) return;
  const QColor shade(0, 0, 0, 160);  // legible on bright tissue
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(shade, kThrow_px + 2.0));
  painter.drawPolyline(way);
  painter.setPen(QPen(theme().needle, kThrow_px, Qt::DashLine, Qt::FlatCap));
  painter.drawPolyline(way);
  if (notch_P) {
    painter.setPen(QPen(theme().needle, kNotch_px, Qt::DotLine, Qt::FlatCap));
    painter.drawPolyline(part_near_plane(map, picture, *notch_P));
  }
  if (std::abs((picture.X_PT.inverse() * throw_P.b).z()) > kNearPlane_mm) return;
  const QPointF along = way.last() - way.first();
  const double length_px = std::hypot(along.x(), along.y());
  if (length_px < 1.0) return;
  const QPointF across = kHalfBar_px / length_px * QPointF(-along.y(), along.x());
  painter.setPen(QPen(theme().needle, 2.0));
  painter.drawLine(way.last() - across, way.last() + across);
}

}  // namespace trocar::trainer
