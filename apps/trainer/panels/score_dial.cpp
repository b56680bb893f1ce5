#include "panels/score_dial.h"

#include <QPainter>
#include <algorithm>

#include "ui_kit/theme.h"

namespace trocar::trainer {

QColor color_of_share(double share) {
  constexpr double kGood = 0.8, kFair = 0.5;
  const Theme& t = theme();
  return share >= kGood ? t.good : share >= kFair ? t.warning : t.bad;
}

ScoreDial::ScoreDial(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
  setObjectName(QStringLiteral("score-dial"));
}

QSize ScoreDial::sizeHint() const {
  const int side = fontMetrics().height() * 8;
  return {side, side};
}

void ScoreDial::set_score(double score) {
  score_ = std::clamp(score, 0.0, 100.0);
  setAccessibleName(tr("Score %1 of 100").arg(score_, 0, 'f', 0));
  update();
}

void ScoreDial::paintEvent(QPaintEvent* /*event*/) {
  constexpr int kPerDegree = 16;
  constexpr double kBegin_deg = 225.0, kSpan_deg = 270.0;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double width = 0.085 * std::min(this->width(), height());
  const QRectF ring = QRectF(rect()).adjusted(width, width, -width, -width);
  const QColor color = color_of_share(score_ / 100.0);
  painter.setPen(QPen(theme().raised, width, Qt::SolidLine, Qt::RoundCap));
  painter.drawArc(ring, static_cast<int>(kBegin_deg * kPerDegree), static_cast<int>(-kSpan_deg * kPerDegree));
  painter.setPen(QPen(color, width, Qt::SolidLine, Qt::RoundCap));
  painter.drawArc(ring, static_cast<int>(kBegin_deg * kPerDegree),
                  static_cast<int>(-kSpan_deg * kPerDegree * std::max(score_, 0.5) / 100.0));
  painter.setPen(theme().text);
  painter.setFont(scaled_font(3.2, true));
  painter.drawText(rect(), Qt::AlignCenter, QString::number(score_, 'f', 0));
  painter.setPen(theme().dim);
  painter.setFont(scaled_font(0.95));
  painter.drawText(rect().adjusted(0, 0, 0, -static_cast<int>(0.4 * width)), Qt::AlignHCenter | Qt::AlignBottom,
                   tr("of 100"));
}

PointsBar::PointsBar(double points, double most, QWidget* parent)
    : QWidget(parent), share_(most > 0.0 ? std::clamp(points / most, 0.0, 1.0) : 0.0) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

QSize PointsBar::sizeHint() const {
  return {fontMetrics().height() * 4, fontMetrics().height() / 2};
}

void PointsBar::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const double round = 0.5 * height();
  painter.setBrush(theme().raised);
  painter.drawRoundedRect(rect(), round, round);
  if (share_ <= 0.0) return;
  painter.setBrush(color_of_share(share_));
  painter.drawRoundedRect(QRectF(0, 0, std::max(share_ * width(), 2.0 * round), height()), round, round);
}

}  // namespace trocar::trainer
