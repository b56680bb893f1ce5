#include "pages/curve_plot.h"

#include <QPainter>
#include <QPainterPath>
#include <algorithm>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kMostPoints = 100.0;

}  // namespace

CurvePlot::CurvePlot(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("learning-curve"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

QSize CurvePlot::sizeHint() const {
  const int line = fontMetrics().height();
  return {22 * line, 6 * line};
}

QSize CurvePlot::minimumSizeHint() const {
  const int line = fontMetrics().height();
  return {12 * line, 4 * line};
}

void CurvePlot::clear() {
  show_curve({});
}

void CurvePlot::show_curve(const results::LearningCurve& curve) {
  points_.clear();
  peers_.clear();
  experts_ = curve.experts;
  for (const results::CurveAttempt& one : curve.attempts)
    points_.push_back({one.attempt.score, one.moving_mean, one.attempt.is_passed});
  for (const auto& point : curve.peer_curve) peers_.push_back(point ? std::optional(point->mean) : std::nullopt);
  // What the others did much later says nothing yet.
  constexpr std::size_t kLookAhead = 5;
  peers_.resize(std::min(peers_.size(), points_.size() + kLookAhead));
  setAccessibleName(tr("Learning curve of %n attempt(s)", nullptr, static_cast<int>(points_.size())));
  update();
}

QRectF CurvePlot::plot_area() const {
  const double text = fontMetrics().horizontalAdvance(QStringLiteral("100")) + 6.0;
  const double line = fontMetrics().height();
  return QRectF(rect()).adjusted(text, 0.4 * line, -4.0, -0.4 * line);
}

double CurvePlot::y_of(double score) const {
  const QRectF area = plot_area();
  return area.bottom() - area.height() * std::clamp(score, 0.0, kMostPoints) / kMostPoints;
}

void CurvePlot::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Theme& t = theme();
  const QRectF area = plot_area();
  painter.setFont(scaled_font(0.85));
  for (const int score : {0, 50, 100}) {
    painter.setPen(t.line);
    painter.drawLine(QPointF(area.left(), y_of(score)), QPointF(area.right(), y_of(score)));
    painter.setPen(t.dim);
    painter.drawText(QRectF(0, y_of(score) - 10, area.left() - 4, 20), Qt::AlignRight | Qt::AlignVCenter,
                     QString::number(score));
  }
  const std::size_t count = std::max({points_.size(), peers_.size(), std::size_t{5}});
  const auto x_of = [&](std::size_t n) {
    return area.left() + area.width() * (static_cast<double>(n) + 0.5) / static_cast<double>(count);
  };
  if (experts_) {
    QColor band = t.good;
    band.setAlphaF(0.22);
    const double top = y_of(experts_->high), bottom = std::max(y_of(experts_->low), top + 3.0);
    painter.fillRect(QRectF(area.left(), top, area.width(), bottom - top), band);
  }
  const auto draw_line = [&](const QPen& pen, std::size_t size, const auto& value_at) {
    QPainterPath path;
    bool is_begun = false;
    for (std::size_t n = 0; n < size; ++n) {
      const std::optional<double> value = value_at(n);
      if (!value) continue;
      is_begun ? path.lineTo(x_of(n), y_of(*value)) : path.moveTo(x_of(n), y_of(*value));
      is_begun = true;
    }
    painter.setPen(pen);
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(path);
  };
  draw_line(QPen(t.dim, 1.5, Qt::DashLine), peers_.size(), [&](std::size_t n) { return peers_[n]; });
  draw_line(QPen(t.accent, 2.5), points_.size(), [&](std::size_t n) { return points_[n].mean; });
  const double radius = points_.size() > 60 ? 1.5 : 3.0;
  for (std::size_t n = 0; n < points_.size(); ++n) {
    // Passed attempts are filled, so that the difference does not rest on colour.
    painter.setPen(QPen(t.accent, 1.5));
    painter.setBrush(points_[n].is_passed ? QBrush(t.accent) : QBrush(t.panel));
    painter.drawEllipse(QPointF(x_of(n), y_of(points_[n].score.value_or(0.0))), radius, radius);
  }
}

}  // namespace trocar::trainer
