#include "views/plots/force_bar.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "core/result.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kHold_s = 1.5;        ///< Hold time of a peak.
constexpr double kWarningShare = 0.6;  ///< Of the device's peak force.
constexpr double kBadShare = 0.85;
constexpr double kGapBesideBar = 8.0;
constexpr double kForceThick = 16.0;
constexpr double kLagThick = 7.0;
constexpr double kShown = 0.002;  ///< Smallest visible change, as share of the bar: smaller changes are not drawn.

QColor color_of_force(double share) {
  const Theme& t = theme();
  if (share >= kBadShare) return t.bad;
  return share >= kWarningShare ? t.warning : t.good;
}

double text_height() {
  return std::ceil(QFontMetricsF(scaled_font(0.85)).height());
}

double text_width(const QString& text) {
  return std::ceil(QFontMetricsF(scaled_font(0.85)).horizontalAdvance(text));
}

QString force_title() {
  return ForceBar::tr("Resistance");
}

QString lag_title() {
  return ForceBar::tr("Lag");
}

/// Width of the titles and values next to horizontal bars.
double titles_width() {
  return std::max(text_width(force_title()), text_width(lag_title())) + kGapBesideBar;
}

double values_width() {
  return text_width(QStringLiteral("00.0 mm")) + kGapBesideBar;
}

}  // namespace

ForceBar::ForceBar(Qt::Orientation orientation, QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("force-bar"));
  setAccessibleName(tr("Resistance and lag"));
  setToolTip(
      tr("Resistance: present force of the tissue, relative to the device's maximum; the line holds the peak.\nLag: "
         "distance of the tool behind the hand."));
  set_orientation(orientation);
}

void ForceBar::set_orientation(Qt::Orientation orientation) {
  orientation_ = orientation;
  const bool is_upright = orientation == Qt::Vertical;
  setSizePolicy(is_upright ? QSizePolicy::Fixed : QSizePolicy::Expanding,
                is_upright ? QSizePolicy::Expanding : QSizePolicy::Fixed);
  updateGeometry();
  update();
}

void ForceBar::set_scale(double peak_force_n, double full_lag_mm) {
  TROCAR_CHECK(peak_force_n > 0.0 && full_lag_mm > 0.0);
  if (peak_force_n == full_n_ && full_lag_mm == full_mm_) return;
  full_n_ = peak_force_n;
  full_mm_ = full_lag_mm;
  update();
}

void ForceBar::set_force(double force_n, double time_s) {
  if (!std::isfinite(force_n) || !std::isfinite(time_s)) return;
  const double size_n = std::abs(force_n);
  const double old_peak_n = peak_n_;
  const bool is_over = time_s - peak_time_s_ > kHold_s || time_s < peak_time_s_;
  if (size_n >= peak_n_ || is_over) {
    peak_n_ = size_n;
    peak_time_s_ = time_s;
  }
  const bool is_seen =
      std::abs(size_n - force_n_) > kShown * full_n_ || std::abs(peak_n_ - old_peak_n) > kShown * full_n_;
  if (!is_seen) return;
  force_n_ = size_n;
  update();
}

void ForceBar::set_lag(double lag_mm) {
  if (!std::isfinite(lag_mm) || std::abs(std::abs(lag_mm) - lag_mm_) <= kShown * full_mm_) return;
  lag_mm_ = std::abs(lag_mm);
  update();
}

void ForceBar::clear() {
  force_n_ = peak_n_ = peak_time_s_ = lag_mm_ = 0.0;
  update();
}

QRectF ForceBar::force_rect() const {
  if (orientation_ == Qt::Vertical) {
    const double left = 0.5 * (width() - kForceThick - kGapBesideBar - kLagThick);
    return {left, 2.0 * text_height() + 4.0, kForceThick, height() - 4.0 * text_height() - 8.0};
  }
  const double top = 0.5 * (height() - text_height() - kForceThick);  // two text lines, a bar in the middle of each
  return {titles_width(), top, width() - titles_width() - values_width(), kForceThick};
}

QRectF ForceBar::lag_rect() const {
  const QRectF bar = force_rect();
  if (orientation_ == Qt::Vertical) return {bar.right() + kGapBesideBar, bar.top(), kLagThick, bar.height()};
  const double middle = bar.bottom() + 0.5 * text_height();
  return {bar.left(), middle - 0.5 * kLagThick, bar.width(), kLagThick};
}

QRectF ForceBar::part_of(const QRectF& bar, double from_share, double to_share) const {
  const double from = std::clamp(from_share, 0.0, 1.0);
  const double to = std::clamp(to_share, 0.0, 1.0);
  if (orientation_ == Qt::Vertical)
    return {bar.left(), bar.bottom() - to * bar.height(), bar.width(), (to - from) * bar.height()};
  return {bar.left() + from * bar.width(), bar.top(), (to - from) * bar.width(), bar.height()};
}

void ForceBar::paintEvent(QPaintEvent* /*event*/) {
  const Theme& t = theme();
  QPainter painter(this);
  const QRectF bar = force_rect();
  const QRectF lag = lag_rect();
  const double share = force_n_ / full_n_;
  const double peak = std::min(peak_n_ / full_n_, 1.0);
  painter.fillRect(bar, t.raised);
  painter.fillRect(lag, t.raised);
  painter.fillRect(part_of(bar, 0.0, share), color_of_force(share));
  painter.fillRect(part_of(lag, 0.0, lag_mm_ / full_mm_), t.accent);
  constexpr double kLine = 2.0;
  const double thickness = kLine / (orientation_ == Qt::Vertical ? bar.height() : bar.width());
  if (peak > 0.0) painter.fillRect(part_of(bar, std::max(0.0, peak - thickness), peak), t.text);
  for (const double mark : {kWarningShare, kBadShare}) {  // thresholds of the colours
    painter.setPen(QPen(t.line, 1.0));
    const QRectF at = part_of(bar, mark, mark);
    painter.drawLine(at.topLeft(), at.bottomRight());
  }

  paint_text(painter);
}

void ForceBar::paint_text(QPainter& painter) const {
  const Theme& t = theme();
  painter.setFont(scaled_font(0.85));
  const QString force = QStringLiteral("%L1 N").arg(force_n_, 0, 'f', full_n_ < 10.0 ? 2 : 1);
  const QString distance = QStringLiteral("%L1 mm").arg(lag_mm_, 0, 'f', lag_mm_ < 10.0 ? 1 : 0);
  const double high = text_height();
  const auto put = [&](const QRectF& room, int alignment, const QString& text, const QColor& color) {
    painter.setPen(color);
    painter.drawText(room, alignment, text);
  };
  if (orientation_ == Qt::Vertical) {
    put({0.0, 0.0, 1.0 * width(), high}, Qt::AlignCenter, force_title(), t.dim);
    put({0.0, high, 1.0 * width(), high}, Qt::AlignCenter, force, t.text);
    put({0.0, height() - 2.0 * high, 1.0 * width(), high}, Qt::AlignCenter, distance, t.accent);
    put({0.0, height() - high, 1.0 * width(), high}, Qt::AlignCenter, lag_title(), t.dim);
    return;
  }
  for (const bool is_force : {true, false}) {
    const QRectF bar = is_force ? force_rect() : lag_rect();
    const double top = bar.center().y() - 0.5 * high;
    put({0.0, top, bar.left(), high}, Qt::AlignLeft | Qt::AlignVCenter, is_force ? force_title() : lag_title(), t.dim);
    put({bar.right(), top, width() - bar.right(), high}, Qt::AlignRight | Qt::AlignVCenter, is_force ? force : distance,
        is_force ? t.text : t.accent);
  }
}

QSize ForceBar::sizeHint() const {
  if (orientation_ == Qt::Vertical) return {std::max(64, static_cast<int>(text_width(force_title())) + 4), 200};
  return {320, static_cast<int>(2.0 * text_height()) + 4};
}

QSize ForceBar::minimumSizeHint() const {
  if (orientation_ == Qt::Vertical) return {sizeHint().width(), 140};
  return {200, sizeHint().height()};
}

}  // namespace trocar::trainer
