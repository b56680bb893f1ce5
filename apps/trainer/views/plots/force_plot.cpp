#include "views/plots/force_plot.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QPainter>
#include <QToolButton>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "ui_kit/action_table.h"
#include "ui_kit/theme.h"
#include "views/view_strip.h"

namespace trocar::trainer {
namespace {

constexpr double kLeastDepth_mm = 20.0;  ///< Minimum ranges of the axes.
constexpr double kLeastForce_n = 1.0;
constexpr double kLeastTime_s = 10.0;
constexpr double kHeadroom = 1.08;
constexpr int kDepthSteps = 6;  ///< The end of an axis is rounded to a multiple of its range divided by this.
constexpr int kForceSteps = 6;

QPolygonF polygon_of(const std::vector<QPointF>& values, const PlotFrame& frame) {
  QPolygonF polygon;
  polygon.reserve(static_cast<int>(values.size()));
  for (const QPointF& value : values) polygon.append(frame.to_point(value));
  return polygon;
}

std::vector<QPointF> finite_only(std::vector<QPointF> curve) {
  std::erase_if(curve, [](const QPointF& p) { return !std::isfinite(p.x()) || !std::isfinite(p.y()); });
  return curve;
}

QColor with_alpha(QColor color, double share) {
  color.setAlphaF(static_cast<float>(share));
  return color;
}

}  // namespace

ForcePlot::ForcePlot(QWidget* parent)
    : QWidget(parent),
      axis_button_(new QToolButton(this)),
      strip_(new ViewStrip(*this, [this](QPainter& painter, const QRectF& room) { paint_strip(painter, room); })) {
  setObjectName(QStringLiteral("force-plot"));
  setAccessibleName(tr("Resistance"));
  setToolTip(tr("Resistance of the tissue along the needle. T: switch between depth and time"));
  setFocusPolicy(Qt::StrongFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
  axis_button_->setObjectName(QStringLiteral("force-plot-axis"));
  axis_button_->setAccessibleName(tr("Axis: depth or time"));
  axis_button_->setToolTip(tr("Against depth or time (T)"));
  axis_button_->setFont(scaled_font(0.85));
  axis_button_->setStyleSheet(QStringLiteral("QToolButton { padding: 0 8px; min-height: 0; border-radius: 4px; }"));
  connect(axis_button_, &QToolButton::clicked, this,
          [this] { set_axis(axis_ == Axis::kDepth ? Axis::kTime : Axis::kDepth); });
  strip_->add_button(*axis_button_);
  set_axis(Axis::kDepth);
  clear();
}

void ForcePlot::set_bands(std::vector<Band> bands) {
  bands_ = std::move(bands);
  widen_for_curves();
  change_ground();
}

void ForcePlot::set_predicted(std::vector<QPointF> curve) {
  predicted_ = finite_only(std::move(curve));
  widen_for_curves();
  change_ground();
}

void ForcePlot::set_reference(std::vector<QPointF> curve) {
  reference_ = finite_only(std::move(curve));
  widen_for_curves();
  change_ground();
}

void ForcePlot::set_curve_names(const QString& predicted, const QString& reference) {
  predicted_name_ = predicted;
  reference_name_ = reference;
  update();
}

void ForcePlot::append(std::span<const ForcePoint> points) {
  for (const ForcePoint& point : points) {
    if (!std::isfinite(point.time_s) || !std::isfinite(point.depth_mm) || !std::isfinite(point.resistance_n)) continue;
    by_depth_.append({point.depth_mm, point.resistance_n});
    by_time_.append({point.time_s, point.resistance_n});
    widen_for({point.depth_mm, point.resistance_n});
  }
  if (!points.empty()) update();
}

void ForcePlot::add_event(double depth_mm, double time_s, const QString& text) {
  events_.push_back({depth_mm, time_s, text});
  update();
}

void ForcePlot::clear() {
  by_depth_.clear();
  by_time_.clear();
  events_.clear();
  cursor_s_.reset();
  far_mm_ = kLeastDepth_mm;
  low_n_ = 0.0;
  high_n_ = kLeastForce_n;
  widen_for_curves();
  change_ground();
}

void ForcePlot::set_cursor(std::optional<double> time_s) {
  if (time_s == cursor_s_) return;
  cursor_s_ = time_s;
  update();
}

void ForcePlot::set_depth_shown(bool is_shown) {
  if (is_shown == is_depth_shown_) return;
  is_depth_shown_ = is_shown;
  axis_button_->setEnabled(is_shown);
  axis_button_->setToolTip(is_shown ? tr("Against depth or time (T)") : tr("Depth is hidden in an exam"));
  set_axis(is_shown ? Axis::kDepth : Axis::kTime);
}

void ForcePlot::set_axis(Axis axis) {
  if (axis == Axis::kDepth && !is_depth_shown_) return;
  axis_ = axis;
  axis_button_->setText(axis == Axis::kDepth ? tr("depth") : tr("time"));
  change_ground();
}

void ForcePlot::widen_for(const QPointF& depth_and_force) {
  far_mm_ = std::max(far_mm_, depth_and_force.x());
  low_n_ = std::min(low_n_, depth_and_force.y());
  high_n_ = std::max(high_n_, depth_and_force.y());
}

void ForcePlot::widen_for_curves() {
  for (const Band& band : bands_) far_mm_ = std::max(far_mm_, band.to_mm);
  for (const QPointF& value : predicted_) widen_for(value);
  for (const QPointF& value : reference_) widen_for(value);
}

void ForcePlot::change_ground() {
  ground_ = {};
  update();
}

double ForcePlot::band_height() const {
  if (bands_.empty() || axis_ == Axis::kTime) return 0.0;
  return std::ceil(QFontMetricsF(scaled_font(0.75)).height()) + 2.0;
}

PlotFrame ForcePlot::frame() const {
  const QFontMetricsF metrics(scaled_font(0.82));
  const double left = std::ceil(metrics.horizontalAdvance(QStringLiteral("\u22120.0"))) + 10.0;
  const double below = band_height() + std::ceil(metrics.height()) + 6.0;
  const double top = strip_->height_in_view() + 6.0;
  PlotFrame frame;
  frame.area = QRectF(left, top, std::max(20.0, width() - left - 10.0), std::max(20.0, height() - top - below));
  frame.y = rounded_out({kHeadroom * low_n_, kHeadroom * high_n_}, kForceSteps);
  if (axis_ == Axis::kDepth) {
    frame.x = rounded_out({0.0, far_mm_}, kDepthSteps);
    return frame;
  }
  double span_s = kLeastTime_s;  // doubled, so that it changes rarely
  while (!by_time_.points().empty() && span_s < by_time_.points().back().x()) span_s *= 2.0;
  frame.x = {0.0, span_s};
  return frame;
}

std::size_t ForcePlot::shown_count() const {
  const std::vector<QPointF>& points = by_time_.points();
  if (!cursor_s_) return points.size();
  const auto after = std::upper_bound(points.begin(), points.end(), *cursor_s_,
                                      [](double time_s, const QPointF& point) { return time_s < point.x(); });
  return static_cast<std::size_t>(after - points.begin());
}

QPointF ForcePlot::value_at(std::size_t index) const {
  return (axis_ == Axis::kDepth ? by_depth_ : by_time_).points()[index];
}

std::optional<ForcePoint> ForcePlot::current() const {
  const std::size_t count = shown_count();
  if (count == 0) return std::nullopt;
  const QPointF& depth = by_depth_.points()[count - 1];
  return ForcePoint{by_time_.points()[count - 1].x(), depth.x(), depth.y()};
}

void ForcePlot::redraw_ground(const PlotFrame& frame) {
  const double ratio = devicePixelRatioF();
  const QSize size = ratio * QWidget::size();
  const auto is_same = [](const report::AxisRange& a, const report::AxisRange& b) {
    return a.low == b.low && a.high == b.high;
  };
  if (ground_.size() == size && is_same(ground_x_, frame.x) && is_same(ground_y_, frame.y)) return;
  ground_ = QPixmap(size);
  ground_.setDevicePixelRatio(ratio);
  ground_.fill(theme().panel);
  ground_x_ = frame.x;
  ground_y_ = frame.y;
  QPainter painter(&ground_);
  painter.setRenderHint(QPainter::Antialiasing);
  paint_bands(painter, frame);
  frame.draw_axes(painter, axis_ == Axis::kDepth ? QStringLiteral("mm") : QStringLiteral("s"), QStringLiteral("N"),
                  band_height());
  if (axis_ == Axis::kTime) return;
  painter.setClipRect(frame.area);
  QPen dashes(theme().dim, 1.6, Qt::CustomDashLine, Qt::FlatCap);
  dashes.setDashPattern({5.0, 3.0});
  painter.setPen(dashes);
  painter.drawPolyline(polygon_of(predicted_, frame));
  painter.setPen(QPen(with_alpha(theme().path, 0.75), 1.4));
  painter.drawPolyline(polygon_of(reference_, frame));
}

void ForcePlot::paint_bands(QPainter& painter, const PlotFrame& frame) const {
  const double high = band_height();
  if (high == 0.0) return;
  painter.setFont(scaled_font(0.75));
  const QFontMetricsF metrics(painter.font());
  for (const Band& band : bands_) {
    const double left = std::max(frame.area.left(), frame.to_point({band.from_mm, 0.0}).x());
    const double right = std::min(frame.area.right(), frame.to_point({band.to_mm, 0.0}).x());
    if (!(right > left)) continue;
    painter.fillRect(QRectF(left, frame.area.top(), right - left, frame.area.height()), with_alpha(band.color, 0.10));
    const QRectF box(left, frame.area.bottom(), right - left, high);
    painter.fillRect(box.adjusted(0.0, 0.0, right - left > 3.0 ? -1.0 : 0.0, 0.0), band.color);
    if (metrics.horizontalAdvance(band.name) + 4.0 > box.width()) continue;  // the tool tip shows the name
    const bool is_bright = qGray(band.color.rgb()) > 120;
    painter.setPen(is_bright ? QColor(0x10, 0x14, 0x1a) : QColor(Qt::white));
    painter.drawText(box, Qt::AlignCenter, band.name);
  }
}

void ForcePlot::paint_curve(QPainter& painter, const PlotFrame& frame) {
  CurveTrace& trace = axis_ == Axis::kDepth ? by_depth_ : by_time_;
  if (trace.points().empty()) return;
  trace.set_column_width(0.5 * (frame.x.high - frame.x.low) / frame.area.width());
  const auto polygon = [&](std::size_t count) {
    QPolygonF line;
    for (const std::size_t index : trace.drawn(count)) line.append(frame.to_point(trace.points()[index]));
    return line;
  };
  const std::size_t shown = shown_count();
  painter.save();
  painter.setClipRect(frame.area.adjusted(-2.0, -2.0, 2.0, 2.0));
  if (shown < trace.points().size()) {
    painter.setPen(QPen(with_alpha(theme().accent, 0.3), 1.4));
    painter.drawPolyline(polygon(trace.points().size()));
  }
  painter.setPen(QPen(theme().accent, 1.8, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.drawPolyline(polygon(shown));
  painter.restore();
  if (shown == 0) return;
  const QPointF at = frame.to_point(value_at(shown - 1));
  if (cursor_s_) {
    painter.setPen(QPen(with_alpha(theme().text, 0.4), 1.0));
    painter.drawLine(QPointF(at.x(), frame.area.top()), QPointF(at.x(), frame.area.bottom()));
  }
  painter.setPen(QPen(theme().panel, 1.5));
  painter.setBrush(theme().text);
  painter.drawEllipse(at, 4.0, 4.0);
}

void ForcePlot::paint_events(QPainter& painter, const PlotFrame& frame) const {
  constexpr std::size_t kRows = 3;
  painter.setFont(scaled_font(0.8));
  const QFontMetricsF metrics(painter.font());
  std::vector<const Event*> by_place;
  for (const Event& event : events_) by_place.push_back(&event);
  std::stable_sort(by_place.begin(), by_place.end(),
                   [&](const Event* a, const Event* b) { return place_of(*a) < place_of(*b); });
  const double unit_end = frame.area.left() + 20.0;
  double free_from[kRows] = {unit_end, frame.area.left(), frame.area.left()};
  for (const Event* event : by_place) {
    const double x = frame.to_point({place_of(*event), 0.0}).x();
    if (x < frame.area.left() - 0.5 || x > frame.area.right() + 0.5) continue;
    painter.setPen(QPen(with_alpha(theme().warning, 0.7), 1.0, Qt::DashLine));
    painter.drawLine(QPointF(x, frame.area.top()), QPointF(x, frame.area.bottom()));
    const double wide = metrics.horizontalAdvance(event->text);
    const double left = std::min(x + 4.0, frame.area.right() - wide);
    for (std::size_t row = 0; row < kRows; ++row) {  // if no row has space, the tool tip shows the name
      if (left < free_from[row]) continue;
      const double top = frame.area.top() + static_cast<double>(row) * metrics.height();
      painter.fillRect(QRectF(left - 2.0, top, wide + 4.0, metrics.height()), with_alpha(theme().panel, 0.75));
      painter.setPen(theme().warning);
      painter.drawText(QPointF(left, top + metrics.ascent()), event->text);
      free_from[row] = left + wide + 6.0;
      break;
    }
  }
}

QString ForcePlot::force_text() const {
  const auto now = current();
  return now ? QStringLiteral("%L1 N").arg(now->resistance_n, 0, 'f', 2) : QString();
}

QString ForcePlot::figures_text() const {
  return is_depth_shown_ ? force_text() + QStringLiteral(" · ") + depth_text() : force_text();
}

QString ForcePlot::depth_text() const {
  const auto now = current();
  return now && is_depth_shown_ ? QStringLiteral("%L1 mm").arg(now->depth_mm, 0, 'f', 0) : QString();
}

void ForcePlot::paint_strip(QPainter& painter, QRectF room) const {
  const Theme& t = theme();
  const auto put = [&](const QString& text, bool is_bold, const QColor& color, bool is_right) {
    painter.setFont(scaled_font(is_bold ? 0.95 : 0.85, is_bold));
    const double wide = std::ceil(QFontMetricsF(painter.font()).horizontalAdvance(text));
    if (wide > room.width()) return false;
    painter.setPen(color);
    painter.drawText(room, static_cast<int>(Qt::AlignVCenter | (is_right ? Qt::AlignRight : Qt::AlignLeft)), text);
    is_right ? room.setRight(room.right() - wide - 12.0) : room.setLeft(room.left() + wide + 12.0);
    return true;
  };
  put(tr("Resistance"), true, t.text, false);
  if (current() && !put(figures_text(), true, t.accent, true)) put(force_text(), true, t.accent, true);
  if (axis_ == Axis::kTime) return;
  if (!reference_.empty()) put(QStringLiteral("— ") + reference_name_, false, t.path, true);
  if (!predicted_.empty()) put(QStringLiteral("- - ") + predicted_name_, false, t.dim, true);
}

void ForcePlot::paintEvent(QPaintEvent* /*event*/) {
  const PlotFrame plot = frame();
  redraw_ground(plot);
  QPainter painter(this);
  painter.drawPixmap(0, 0, ground_);
  painter.setRenderHint(QPainter::Antialiasing);
  paint_events(painter, plot);
  paint_curve(painter, plot);
  strip_->refresh(force_text() + depth_text() + (predicted_.empty() ? QString() : predicted_name_) +
                  (reference_.empty() ? QString() : reference_name_) + axis_button_->text());
}

QString ForcePlot::text_at(const QPoint& position) const {
  constexpr double kNear = 5.0;
  const PlotFrame plot = frame();
  if (!plot.area.adjusted(0.0, 0.0, 0.0, band_height()).contains(position)) return toolTip();
  for (const Event& event : events_)
    if (std::abs(plot.to_point({place_of(event), 0.0}).x() - position.x()) < kNear) {
      const QString depth = is_depth_shown_ ? QStringLiteral("%L1 mm · ").arg(event.depth_mm, 0, 'f', 1) : QString();
      return QStringLiteral("%L1 · %L2%L3 s").arg(event.text, depth).arg(event.time_s, 0, 'f', 1);
    }
  const QPointF value = plot.to_value(position);
  const QString place = QStringLiteral("%L1 %L2").arg(value.x(), 0, 'f', 1).arg(axis_ == Axis::kDepth ? "mm" : "s");
  if (axis_ == Axis::kDepth)
    for (const Band& band : bands_)
      if (band.from_mm <= value.x() && value.x() < band.to_mm) return place + QStringLiteral(" · ") + band.name;
  return place;
}

bool ForcePlot::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), text_at(help->pos()), this);
  return true;
}

void ForcePlot::keyPressEvent(QKeyEvent* event) {
  if (find_action(Scope::kForcePlot, *event))
    axis_button_->click();
  else
    QWidget::keyPressEvent(event);
}

void ForcePlot::resizeEvent(QResizeEvent* /*event*/) {
  strip_->follow_view();
}

QSize ForcePlot::sizeHint() const {
  return {420, 260};
}

QSize ForcePlot::minimumSizeHint() const {
  return {220, 140};
}

}  // namespace trocar::trainer
