#include "views/slices/slice_canvas.h"

#include <QPainterPath>
#include <algorithm>
#include <array>
#include <cmath>

#include "report/plot_scale.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr QColor kHalo(0, 0, 0, 150);

QColor faded(QColor color, double share) {
  color.setAlphaF(static_cast<float>(share * color.alphaF()));
  return color;
}

QPen round_pen(const QColor& color, double width) {
  return {color, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin};
}

/// Parts of a line in the plane and off it; adjacent parts of the same kind are joined.
class SplitLine {
 public:
  SplitLine(const SliceCanvas& canvas, std::span<const Vec3> points_P) : canvas_(canvas) {
    for (std::size_t n = 0; n + 1 < points_P.size(); ++n) add({points_P[n], points_P[n + 1]});
  }
  const QPainterPath& in_plane() const { return paths_[1]; }
  const QPainterPath& off_plane() const { return paths_[0]; }

 private:
  void add(const Segment& piece_P) {
    const double from = canvas_.geometry.height_mm(piece_P.a);
    const double rise = canvas_.geometry.height_mm(piece_P.b) - from;
    std::array<double, 4> cuts{0.0, 0.0, 0.0, 1.0};
    if (std::abs(rise) > 1e-9) {
      cuts[1] = std::clamp((-kInPlane_mm - from) / rise, 0.0, 1.0);
      cuts[2] = std::clamp((kInPlane_mm - from) / rise, 0.0, 1.0);
      if (cuts[1] > cuts[2]) std::swap(cuts[1], cuts[2]);
    }
    for (std::size_t n = 0; n < 3; ++n) {
      if (cuts[n + 1] - cuts[n] < 1e-9) continue;
      const bool is_in_plane = std::abs(from + 0.5 * (cuts[n] + cuts[n + 1]) * rise) <= kInPlane_mm;
      append(is_in_plane, canvas_.to_point(piece_P.at(cuts[n])), canvas_.to_point(piece_P.at(cuts[n + 1])));
    }
  }
  void append(bool is_in_plane, const QPointF& from, const QPointF& to) {
    QPainterPath& path = paths_[is_in_plane ? 1 : 0];
    if (path.elementCount() == 0 || path.currentPosition() != from) path.moveTo(from);
    path.lineTo(to);
  }

  const SliceCanvas& canvas_;
  std::array<QPainterPath, 2> paths_;
};

}  // namespace

QPointF SliceCanvas::to_point(const Vec3& p_P) const {
  const Eigen::Vector2d pixel = geometry.to_pixel(p_P);
  return picture.topLeft() + QPointF(pixel.x() + 0.5, pixel.y() + 0.5) / device_pixel_ratio;
}

void draw_text(QPainter& painter, const QPointF& baseline, const QString& text, const QColor& color) {
  QPainterPath path;
  path.addText(baseline, painter.font(), text);
  painter.strokePath(path, round_pen(QColor(0, 0, 0, 190), 2.5));
  painter.fillPath(path, color);
}

void draw_line(const SliceCanvas& canvas, std::span<const Vec3> points_P, const QColor& color, double width) {
  const SplitLine line(canvas, points_P);
  QPainter& painter = canvas.painter;
  QPen dashes(faded(color, 0.55), 0.65 * width, Qt::CustomDashLine, Qt::FlatCap);
  dashes.setDashPattern({4.0, 4.0});
  painter.strokePath(line.off_plane(), dashes);
  painter.strokePath(line.in_plane(), round_pen(kHalo, width + 2.0));
  painter.strokePath(line.in_plane(), round_pen(color, width));
}

void draw_needle(const SliceCanvas& canvas, std::span<const Vec3> shaft_P) {
  constexpr double kTipRadius = 3.5;
  if (shaft_P.empty()) return;
  const QColor color = theme().needle;
  draw_line(canvas, shaft_P, color, 2.2);
  const bool is_in_plane = std::abs(canvas.geometry.height_mm(shaft_P.back())) <= kInPlane_mm;
  const QPointF tip = canvas.to_point(shaft_P.back());
  canvas.painter.setPen(round_pen(is_in_plane ? QColor(0, 0, 0, 200) : faded(color, 0.7), 1.2));
  canvas.painter.setBrush(is_in_plane ? QBrush(color) : QBrush(Qt::NoBrush));
  canvas.painter.drawEllipse(tip, kTipRadius, kTipRadius);
}

void draw_aim(const SliceCanvas& canvas, std::span<const Vec3> shaft_P) {
  constexpr double kAhead_mm = 60.0;
  if (shaft_P.size() < 2) return;
  const Vec3& tip_P = shaft_P.back();
  const Vec3 last_P = tip_P - shaft_P[shaft_P.size() - 2];
  if (!(last_P.norm() > 0.0)) return;
  QPen dots(faded(theme().needle, 0.6), 1.6, Qt::CustomDashLine, Qt::RoundCap);
  dots.setDashPattern({0.1, 4.0});
  canvas.painter.setPen(dots);
  canvas.painter.drawLine(canvas.to_point(tip_P), canvas.to_point(tip_P + kAhead_mm * last_P.normalized()));
}

void draw_path(const SliceCanvas& canvas, const Segment& path_P) {
  const std::array<Vec3, 2> ends_P{path_P.a, path_P.b};
  draw_line(canvas, ends_P, theme().path, 1.8);
  QPainter& painter = canvas.painter;
  painter.setBrush(Qt::NoBrush);
  painter.setPen(round_pen(theme().path, 1.6));
  painter.drawEllipse(canvas.to_point(path_P.a), 4.0, 4.0);
}

void draw_other_path(const SliceCanvas& canvas, const Segment& path_P) {
  const QPointF from = canvas.to_point(path_P.a), to = canvas.to_point(path_P.b);
  for (const QPen& pen : {QPen(faded(kHalo, 0.7), 3.0), QPen(faded(theme().text, 0.8), 1.4, Qt::DashLine)}) {
    canvas.painter.setPen(pen);
    canvas.painter.drawLine(from, to);
  }
}

void draw_target(const SliceCanvas& canvas, const Vec3& p_P) {
  QPainter& painter = canvas.painter;
  painter.setBrush(Qt::NoBrush);
  constexpr double kFar_mm = 5.0;  // the target has a size: it fades at a larger distance than lines
  constexpr double kRing = 5.5, kArm = 10.0;
  const bool is_near = std::abs(canvas.geometry.height_mm(p_P)) <= kFar_mm;
  const QColor color = is_near ? theme().target : faded(theme().target, 0.5);
  const QPointF target = canvas.to_point(p_P);
  for (const QPen& pen : {round_pen(faded(kHalo, is_near ? 1.0 : 0.4), 3.6), round_pen(color, 1.8)}) {
    painter.setPen(pen);
    painter.drawEllipse(target, kRing, kRing);
    for (const QPointF& way : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)})
      painter.drawLine(target + kRing * way, target + kArm * way);
  }
}

void draw_entry_zone(const SliceCanvas& canvas, const tasks::EntryZone& zone) {
  const double away_mm = std::abs(canvas.geometry.height_mm(zone.centre_P));
  if (!(away_mm < zone.radius_mm)) return;
  const double mm_per_point = canvas.geometry.mm_per_px * canvas.device_pixel_ratio;
  const double radius = std::sqrt(zone.radius_mm * zone.radius_mm - away_mm * away_mm) / mm_per_point;
  canvas.painter.setBrush(Qt::NoBrush);
  canvas.painter.setPen(QPen(theme().path, 1.5, Qt::DashLine));
  canvas.painter.drawEllipse(canvas.to_point(zone.centre_P), radius, radius);
}

void draw_crosshair(const SliceCanvas& canvas, const Vec3& p_P, const CrossColors& colors, bool only_ends) {
  constexpr double kGap = 9.0;
  constexpr double kEnd = 14.0;
  const QRectF& r = canvas.picture;
  const QPointF at = canvas.to_point(p_P);
  QPainter& painter = canvas.painter;
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setPen(QPen(faded(colors.vertical, 0.85), 1.0));
  painter.drawLine(QPointF(at.x(), r.top()), QPointF(at.x(), only_ends ? r.top() + kEnd : at.y() - kGap));
  painter.drawLine(QPointF(at.x(), only_ends ? r.bottom() - kEnd : at.y() + kGap), QPointF(at.x(), r.bottom()));
  painter.setPen(QPen(faded(colors.horizontal, 0.85), 1.0));
  painter.drawLine(QPointF(r.left(), at.y()), QPointF(only_ends ? r.left() + kEnd : at.x() - kGap, at.y()));
  painter.drawLine(QPointF(only_ends ? r.right() - kEnd : at.x() + kGap, at.y()), QPointF(r.right(), at.y()));
  painter.setRenderHint(QPainter::Antialiasing, true);
}

void draw_letters(const SliceCanvas& canvas) {
  QPainter& painter = canvas.painter;
  painter.setFont(scaled_font(0.95, true));
  const QFontMetricsF metrics(painter.font());
  const QRectF area = canvas.picture.adjusted(6.0, 4.0, -6.0, -4.0);
  const auto letters = [](const Vec3& way_P) { return QString::fromStdString(slices::direction_letters(way_P)); };
  const auto width = [&](const QString& text) { return metrics.horizontalAdvance(text); };
  const slices::SliceAxes& axes = canvas.geometry.axes;
  const QString right = letters(axes.u_P);
  const QString top = letters(-axes.v_P);
  const QString bottom = letters(axes.v_P);
  const double middle = area.center().y() + 0.5 * metrics.capHeight();
  const QColor color = theme().text;
  draw_text(painter, {area.left(), middle}, letters(-axes.u_P), color);
  draw_text(painter, {area.right() - width(right), middle}, right, color);
  draw_text(painter, {area.center().x() - 0.5 * width(top), area.top() + metrics.capHeight() + 2.0}, top, color);
  draw_text(painter, {area.center().x() - 0.5 * width(bottom), area.bottom() - 2.0}, bottom, color);
}

void draw_scale_bar(const SliceCanvas& canvas) {
  constexpr double kShareOfWidth = 0.4;
  const double mm_per_point = canvas.geometry.mm_per_px * canvas.device_pixel_ratio;
  const double room_mm = kShareOfWidth * canvas.picture.width() * mm_per_point;
  if (!(room_mm > 0.0)) return;
  const double length_mm = report::nice_step({0.0, room_mm}, 3);  // at most 5/6 of the available space
  const double length = length_mm / mm_per_point;
  QPainter& painter = canvas.painter;
  painter.setFont(scaled_font(0.85));
  const QPointF left = canvas.picture.bottomLeft() + QPointF(8.0, -8.0);
  const QPointF right = left + QPointF(length, 0.0);
  for (const QPen& pen : {QPen(QColor(0, 0, 0, 190), 3.6), QPen(theme().text, 1.6)}) {
    painter.setPen(pen);
    painter.drawLine(left, right);
    painter.drawLine(left - QPointF(0.0, 4.0), left);
    painter.drawLine(right - QPointF(0.0, 4.0), right);
  }
  const bool is_in_cm = length_mm >= 10.0;
  const QString text = QStringLiteral("%1 %2").arg(is_in_cm ? length_mm / 10.0 : length_mm).arg(is_in_cm ? "cm" : "mm");
  const double width = QFontMetricsF(painter.font()).horizontalAdvance(text);
  draw_text(painter, {left.x() + std::max(0.0, 0.5 * (length - width)), left.y() - 7.0}, text, theme().text);
}

}  // namespace trocar::trainer
