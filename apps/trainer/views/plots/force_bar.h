#pragma once

#include <QWidget>

namespace trocar::trainer {

/// Bar of the tissue's present resistance relative to the device's maximum, with a line at the peak of the last
/// seconds; next to it, thinner, the lag of the tool behind the hand, as a visual cue of resistance. Both have names
/// and values. Only setters change it. Object name: force-bar.
class ForceBar : public QWidget {
  Q_OBJECT

 public:
  explicit ForceBar(Qt::Orientation orientation = Qt::Vertical, QWidget* parent = nullptr);

  void set_orientation(Qt::Orientation orientation);
  /// Maxima of the two bars: the device's peak force (N) and a lag (mm), both > 0.
  void set_scale(double peak_force_n, double full_lag_mm);
  /// Magnitude of the force (N) at a time (s), which never decreases except for a new start.
  void set_force(double force_n, double time_s);
  /// Distance from hand to tool (mm).
  void set_lag(double lag_mm);
  /// Resets force, lag and peak.
  void clear();

  double force_n() const noexcept { return force_n_; }
  double peak_n() const noexcept { return peak_n_; }
  double lag_mm() const noexcept { return lag_mm_; }
  /// Rectangle of the force bar in the widget, in points; it fills from the bottom or the left.
  QRectF force_rect() const;
  QRectF lag_rect() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paint_text(QPainter& painter) const;
  QRectF part_of(const QRectF& bar, double from_share, double to_share) const;

  Qt::Orientation orientation_;
  double full_n_ = 3.3;
  double full_mm_ = 20.0;
  double force_n_ = 0.0;
  double peak_n_ = 0.0;
  double peak_time_s_ = 0.0;
  double lag_mm_ = 0.0;
};

}  // namespace trocar::trainer
