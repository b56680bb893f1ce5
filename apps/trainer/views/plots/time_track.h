#pragma once

#include <QColor>
#include <QString>
#include <QWidget>
#include <vector>

namespace trocar::trainer {

/// Kind of a session event and of its mark: kRisk is drawn over all others, in the colour of errors.
enum class TimeMark { kEnter, kPuncture, kRisk, kFire, kOther, kWorst };

/// The painted part of a time line: phases as a coloured strip, the force as a small curve, events as marks, the
/// present time as a handle that follows the mouse. TimeLine sets its values. Object name: time-track.
class TimeTrack : public QWidget {
  Q_OBJECT

 public:
  struct Event {
    double time_s = 0.0;
    QString title;
    TimeMark kind = TimeMark::kOther;
  };
  struct Phase {
    double from_s = 0.0;
    double to_s = 0.0;
    QString name;
    QColor color;
  };

  explicit TimeTrack(QWidget* parent = nullptr);

  void set_duration(double duration_s);
  void set_events(std::vector<Event> events);
  void set_phases(std::vector<Phase> phases);
  /// Time (s) and force (N) by rising time.
  void set_curve(std::vector<QPointF> curve);
  void set_time(double time_s);

  double duration_s() const noexcept { return duration_s_; }
  double time_s() const noexcept { return time_s_; }
  const std::vector<Event>& events() const noexcept { return events_; }
  /// Position in points of the widget; time_at() is the inverse.
  double x_of(double time_s) const;
  double time_at(double x) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  /// The user has selected a time.
  void scrubbed(double time_s);

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;

 private:
  QRectF area() const;
  void scrub(double x);
  void paint_curve(QPainter& painter) const;
  void paint_marks(QPainter& painter) const;
  QString text_at(const QPoint& position) const;

  double duration_s_ = 0.0;
  double time_s_ = 0.0;
  std::vector<Event> events_;
  std::vector<Phase> phases_;
  std::vector<QPointF> curve_;
};

}  // namespace trocar::trainer
