#pragma once

#include <QColor>
#include <QPixmap>
#include <QString>
#include <QWidget>
#include <optional>
#include <span>
#include <vector>

#include "views/plots/curve_trace.h"
#include "views/plots/plot_frame.h"

class QToolButton;

namespace trocar::trainer {

class ViewStrip;

struct ForcePoint {
  double time_s = 0.0;
  double depth_mm = 0.0;  ///< Depth of the tip; 0 at the skin.
  double resistance_n = 0.0;
};

/// Felt resistance against the depth of the tip (paper A, figure 4b), or against time: the live curve, the predicted
/// and the expert's curve behind it, the tissues along the expert path as coloured bands, punctures as marked lines.
/// Axes have round numbers and only grow, so that the plot does not jitter. Object name: force-plot.
/// Key: T depth or time (button: force-plot-axis).
class ForcePlot : public QWidget {
  Q_OBJECT

 public:
  enum class Axis { kDepth, kTime };
  struct Band {
    double from_mm = 0.0;
    double to_mm = 0.0;
    QString name;
    QColor color;
  };

  explicit ForcePlot(QWidget* parent = nullptr);

  /// Tissues along the expert path, from the skin on; the depth axis extends to the end of the last one.
  void set_bands(std::vector<Band> bands);
  /// Depth (mm) and resistance (N) by rising depth; empty hides the curve.
  void set_predicted(std::vector<QPointF> curve);
  void set_reference(std::vector<QPointF> curve);
  /// Names of the two curves in the plot; by default "predicted" and "expert".
  void set_curve_names(const QString& predicted, const QString& reference);
  /// Points by rising time; points that are not finite are ignored.
  void append(std::span<const ForcePoint> points);
  void add_event(double depth_mm, double time_s, const QString& text);
  /// Clears curve and events, and resets the axes; bands and the other curves stay.
  void clear();
  /// Replay: the curve up to this time is bright, the rest faint. Empty: the newest point is the current one.
  void set_cursor(std::optional<double> time_s);
  void set_axis(Axis axis);
  /// If false, there is only the time axis, and the depth of the tip is hidden.
  void set_depth_shown(bool is_shown);

  Axis axis() const noexcept { return axis_; }
  /// Present mapping from values to the widget.
  PlotFrame frame() const;
  /// Text of the strip: force, and depth if shown.
  QString figures_text() const;
  /// The point of the marker.
  std::optional<ForcePoint> current() const;

  /// Name, force and axis; a dock may show it in its title.
  ViewStrip& strip() noexcept { return *strip_; }

  /// Text of the tooltip at a position.
  QString text_at(const QPoint& position) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  struct Event {
    double depth_mm, time_s;
    QString text;
  };

  double band_height() const;
  /// Number of points before the cursor.
  std::size_t shown_count() const;
  QPointF value_at(std::size_t index) const;
  double place_of(const Event& event) const { return axis_ == Axis::kDepth ? event.depth_mm : event.time_s; }
  void widen_for(const QPointF& depth_and_force);
  void widen_for_curves();
  void change_ground();
  void redraw_ground(const PlotFrame& frame);
  void paint_bands(QPainter& painter, const PlotFrame& frame) const;
  void paint_curve(QPainter& painter, const PlotFrame& frame);
  void paint_events(QPainter& painter, const PlotFrame& frame) const;
  void paint_strip(QPainter& painter, QRectF room) const;
  QString force_text() const;
  QString depth_text() const;

  bool is_depth_shown_ = true;
  Axis axis_ = Axis::kDepth;
  std::vector<Band> bands_;
  std::vector<QPointF> predicted_, reference_;
  QString predicted_name_ = tr("predicted"), reference_name_ = tr("expert");
  CurveTrace by_depth_, by_time_;
  std::vector<Event> events_;
  std::optional<double> cursor_s_;
  double far_mm_, low_n_, high_n_;  ///< Limits that the axes must contain.
  QPixmap ground_;                  ///< Static parts: axes, bands, curves behind.
  report::AxisRange ground_x_, ground_y_;
  QToolButton* axis_button_;
  ViewStrip* strip_;
};

}  // namespace trocar::trainer
