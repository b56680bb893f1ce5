#include "views/plots/time_track.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "report/plot_scale.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kSide = 10.0;      ///< Space for the handle at both ends.
constexpr double kPhaseHigh = 5.0;  ///< Height of the phase strip below the curve.
constexpr double kMarkHigh = 12.0;  ///< Height of the row of marks above the curve.
constexpr double kNear = 6.0;       ///< Maximum distance in points for selecting a mark.

QColor color_of(TimeMark kind) {
  const Theme& t = theme();
  switch (kind) {
    case TimeMark::kEnter:
      return t.accent;
    case TimeMark::kPuncture:
      return t.warning;
    case TimeMark::kFire:
      return t.target;
    case TimeMark::kRisk:
      return t.bad;
    case TimeMark::kWorst:
      return t.text;
    case TimeMark::kOther:
      break;
  }
  return t.dim;
}

/// Draws "!" in the centre of a mark.
void draw_exclamation(QPainter& painter, const QPointF& at) {
  painter.setPen(QPen(theme().ground, 2.0));
  painter.drawLine(at - QPointF(0.0, 3.0), at + QPointF(0.0, 0.5));
  painter.drawPoint(at + QPointF(0.0, 3.5));
}

/// Marks differ in shape and colour: triangle pointing down, diamond, square, disc, and a warning triangle for risk
/// structures.
void draw_mark(QPainter& painter, const QPointF& at, TimeMark kind) {
  constexpr double kSize = 5.0;
  painter.setPen(QPen(theme().panel, 1.0));
  painter.setBrush(color_of(kind));
  const double x = at.x(), y = at.y();
  switch (kind) {
    case TimeMark::kEnter:
      painter.drawPolygon(QPolygonF({{x - kSize, y - kSize}, {x + kSize, y - kSize}, {x, y + kSize}}));
      return;
    case TimeMark::kWorst:
      painter.drawEllipse(at, kSize + 1.0, kSize + 1.0);
      return draw_exclamation(painter, at);
    case TimeMark::kRisk:
      painter.drawPolygon(
          QPolygonF({{x, y - kSize - 2.0}, {x + kSize + 2.0, y + kSize}, {x - kSize - 2.0, y + kSize}}));
      return draw_exclamation(painter, at);
    case TimeMark::kFire:
      painter.drawRect(QRectF(x - 4.0, y - 4.0, 8.0, 8.0));
      return;
    case TimeMark::kPuncture:
    case TimeMark::kOther:
      painter.drawPolygon(QPolygonF({{x, y - kSize}, {x + kSize, y}, {x, y + kSize}, {x - kSize, y}}));
      return;
  }
}

}  // namespace

TimeTrack::TimeTrack(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("time-track"));
  setAccessibleName(tr("Time"));
  setToolTip(tr("Click or drag to go to a time (Left, Right, Home, End)"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void TimeTrack::set_duration(double duration_s) {
  duration_s_ = std::isfinite(duration_s) ? std::max(duration_s, 0.0) : 0.0;
  time_s_ = std::clamp(time_s_, 0.0, duration_s_);
  update();
}

void TimeTrack::set_events(std::vector<Event> events) {
  events_ = std::move(events);
  std::stable_sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.time_s < b.time_s; });
  update();
}

void TimeTrack::set_phases(std::vector<Phase> phases) {
  phases_ = std::move(phases);
  update();
}

void TimeTrack::set_curve(std::vector<QPointF> curve) {
  curve_ = std::move(curve);
  update();
}

void TimeTrack::set_time(double time_s) {
  if (time_s == time_s_) return;
  time_s_ = time_s;
  update();
}

QRectF TimeTrack::area() const {
  return {kSide, kMarkHigh + 2.0, std::max(1.0, width() - 2.0 * kSide), height() - kMarkHigh - 4.0};
}

double TimeTrack::x_of(double time_s) const {
  const QRectF room = area();
  return room.left() + (duration_s_ > 0.0 ? room.width() * time_s / duration_s_ : 0.0);
}

double TimeTrack::time_at(double x) const {
  const QRectF room = area();
  return std::clamp((x - room.left()) / room.width(), 0.0, 1.0) * duration_s_;
}

void TimeTrack::scrub(double x) {
  for (const Event& event : events_)  // marks can be clicked
    if (std::abs(x_of(event.time_s) - x) <= 0.5 * kNear) return Q_EMIT scrubbed(event.time_s);
  Q_EMIT scrubbed(time_at(x));
}

void TimeTrack::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) scrub(event->pos().x());
}

void TimeTrack::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons().testFlag(Qt::LeftButton)) Q_EMIT scrubbed(time_at(event->pos().x()));
}

QString TimeTrack::text_at(const QPoint& position) const {
  const Event* nearest = nullptr;
  for (const Event& event : events_) {
    const double distance = std::abs(x_of(event.time_s) - position.x());
    if (distance <= kNear && (nearest == nullptr || distance < std::abs(x_of(nearest->time_s) - position.x())))
      nearest = &event;
  }
  if (nearest != nullptr) return QStringLiteral("%L1 · %L2 s").arg(nearest->title).arg(nearest->time_s, 0, 'f', 1);
  const double time_s = time_at(position.x());
  QString text = QStringLiteral("%L1 s").arg(time_s, 0, 'f', 1);
  for (const Phase& phase : phases_)
    if (phase.from_s <= time_s && time_s < phase.to_s) text += QStringLiteral(" · ") + phase.name;
  return text;
}

bool TimeTrack::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), text_at(help->pos()), this);
  return true;
}

void TimeTrack::paint_curve(QPainter& painter) const {
  const QRectF room = area().adjusted(0.0, 2.0, 0.0, -kPhaseHigh - 2.0);
  std::vector<report::Point2> points;
  std::vector<double> forces{0.0};
  for (const QPointF& value : curve_) {
    if (!std::isfinite(value.x()) || !std::isfinite(value.y())) continue;
    points.emplace_back(x_of(value.x()), value.y());
    forces.push_back(value.y());
  }
  if (points.empty()) return;
  const report::AxisRange range = report::range_of(forces);
  QPolygonF line;
  for (const report::Point2& point : report::thin_out(points, 1.0))
    line.append({point.x(), room.bottom() - room.height() * (point.y() - range.low) / (range.high - range.low)});
  const double zero = room.bottom() - room.height() * (0.0 - range.low) / (range.high - range.low);
  QPolygonF filled = line;
  filled.append({line.last().x(), zero});
  filled.append({line.first().x(), zero});
  QColor fill = theme().accent;
  fill.setAlphaF(0.18F);
  painter.setPen(Qt::NoPen);
  painter.setBrush(fill);
  painter.drawPolygon(filled);
  painter.setPen(QPen(theme().accent.darker(125), 1.2));
  painter.drawPolyline(line);
}

void TimeTrack::paint_marks(QPainter& painter) const {
  // The worst moment is drawn over the other marks, and contact with a risk structure over it, as they often coincide.
  const auto rank = [](TimeMark kind) { return kind == TimeMark::kRisk ? 2 : kind == TimeMark::kWorst ? 1 : 0; };
  for (const int now : {0, 1, 2}) {
    for (const Event& event : events_) {
      if (rank(event.kind) != now) continue;
      const bool is_risk = event.kind == TimeMark::kRisk;
      const double x = x_of(event.time_s);
      QColor line = color_of(event.kind);
      line.setAlphaF(is_risk ? 0.9F : 0.45F);
      painter.setPen(QPen(line, is_risk ? 2.0 : 1.0));
      painter.drawLine(QPointF(x, kMarkHigh), QPointF(x, area().bottom()));
      draw_mark(painter, {x, 0.5 * kMarkHigh + 1.0}, event.kind);
    }
  }
}

void TimeTrack::paintEvent(QPaintEvent* /*event*/) {
  const Theme& t = theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF room = area();
  painter.setPen(Qt::NoPen);
  painter.setBrush(t.raised);
  painter.drawRoundedRect(room, 4.0, 4.0);
  for (const Phase& phase : phases_) {
    const double left = std::clamp(x_of(phase.from_s), room.left(), room.right());
    const double right = std::clamp(x_of(phase.to_s), room.left(), room.right());
    painter.fillRect(QRectF(left, room.bottom() - kPhaseHigh, right - left, kPhaseHigh), phase.color);
  }
  paint_curve(painter);
  paint_marks(painter);
  const double x = x_of(time_s_);
  QColor later = t.ground;  // the part after the present time is dimmed
  later.setAlphaF(0.45F);
  painter.fillRect(QRectF(x, room.top(), room.right() - x, room.height()), later);
  painter.setPen(QPen(t.text, 2.0));
  painter.drawLine(QPointF(x, room.top() - 2.0), QPointF(x, room.bottom() + 2.0));
  painter.setPen(QPen(t.panel, 1.5));
  painter.setBrush(t.text);
  painter.drawEllipse(QPointF(x, room.center().y()), 6.0, 6.0);
}

QSize TimeTrack::sizeHint() const {
  return {600, 52};
}

QSize TimeTrack::minimumSizeHint() const {
  return {160, 44};
}

}  // namespace trocar::trainer
