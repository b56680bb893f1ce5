#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "ui_kit/action_table.h"
#include "views/plots/time_track.h"

class QComboBox;
class QLabel;
class QToolButton;

namespace trocar::trainer {

/// The time line of a replay: play and pause, scrubbing, speed, events, jump to the worst moment. It has no clock: the
/// page calls advance() once per frame. Object names: time-line, time-play, time-previous, time-next, time-worst,
/// time-speed, time-track.
///
/// Keys: those of Scope::kTimeLine and kFeedback. Mouse: click or drag on the track.
class TimeLine : public QWidget {
  Q_OBJECT

 public:
  using Event = TimeTrack::Event;
  using Phase = TimeTrack::Phase;

  explicit TimeLine(QWidget* parent = nullptr);

  /// Length (s); resets the time to 0 and pauses.
  void set_duration(double duration_s);
  void set_events(std::vector<Event> events);
  void set_phases(std::vector<Phase> phases);
  void set_curve(std::vector<QPointF> curve);
  /// Clamped to 0..duration; emits time_changed if it changes.
  void set_time(double time_s);
  /// Playing at the end starts from the beginning.
  void set_playing(bool is_playing);
  /// One of speeds(); another value is rounded to the nearest.
  void set_speed(double factor);
  /// While playing, advances by dt_s of wall-clock time; stops at the end.
  void advance(double dt_s);
  void go_to_next_event();
  void go_to_previous_event();
  /// No effect without such an event.
  void go_to_worst();
  /// Performs an action of the replay; false: another action.
  bool perform(const FoundAction& found);

  double time_s() const noexcept;
  double duration_s() const noexcept;
  bool is_playing() const noexcept { return is_playing_; }
  double speed() const noexcept;
  static const std::vector<double>& speeds();

 Q_SIGNALS:
  void time_changed(double time_s);
  void playing_changed(bool is_playing);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QToolButton* add_button(const char* name, const QString& text, const QString& tooltip);
  void update_label();
  void step_speed(int by);

  TimeTrack* track_;
  QToolButton *play_, *previous_, *next_, *worst_;
  QComboBox* speed_;
  QLabel* label_;
  bool is_playing_ = false;
};

}  // namespace trocar::trainer
