#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <QVariant>
#include <functional>

#include "script/script.h"

class QAction;
class QWidget;

namespace trocar::trainer {

/// Interface of the window for a player; allows tests with any widget.
struct Stage {
  QWidget* window = nullptr;
  std::function<QVariantMap()> facts;
  std::function<void(const QString& tool)> end_server;
  std::function<void()> reset_watch;
  double default_timeout_s = 10.0;  ///< Timeout for a widget that does not exist yet.
};

/// Plays a script in a window: sends events to the widgets step by step while the window runs. Ends with an error or
/// empty.
class ScriptPlayer : public QObject {
  Q_OBJECT

 public:
  ScriptPlayer(std::vector<ScriptStep> steps, Stage stage, QObject* parent = nullptr);
  void start();

 Q_SIGNALS:
  /// `error` is empty if all steps were played, else "steps.txt line 12: …".
  void finished(const QString& error);

 private:
  enum class Progress { kDone, kAgain };

  void play_on();
  Result<Progress> play(const ScriptStep& step);
  Result<Progress> play_pointer(const ScriptStep& step, QWidget& widget);
  Result<Progress> play_drag(const ScriptStep& step, QWidget& widget);
  /// Calls `act` at the step's rate per second until the fact is true.
  Result<Progress> play_until(const ScriptStep& step, const std::function<Status()>& act);
  Result<Progress> play_waiting(const ScriptStep& step);
  Result<Progress> expect_whole() const;
  Result<Progress> play_looking(const ScriptStep& step);
  /// Null if the widget is not visible yet.
  Result<QWidget*> find(const QString& name) const;
  /// Null if the widget is not visible or not enabled yet.
  Result<QWidget*> find_usable(const QString& name) const;
  Result<Progress> click_menu_entry(QAction& entry) const;
  bool holds(const QString& fact, const QString& op, const QString& value) const;
  /// Done once the fact holds; an error where it does not within the step's time.
  Result<Progress> wait_until_holds(const QStringList& fact_op_value, double timeout_s);
  /// Time since the step began, in which the window kept up: a poll that came late counts as one in time. So a busy
  /// machine has longer to fulfil a condition, and no more events reach the window than it handles.
  double seconds() const { return step_s_; }

  std::vector<ScriptStep> steps_;
  Stage stage_;
  std::size_t at_ = 0;
  QTimer timer_;
  QElapsedTimer poll_;  ///< Time since the last poll.
  QElapsedTimer step_;  ///< Since the step began.
  /// TROCAR_SCRIPT_TIMES is set: the time of each step goes to standard error.
  const bool tells_times_ = qEnvironmentVariableIsSet("TROCAR_SCRIPT_TIMES");
  double step_s_ = 0.0;  ///< See seconds().
  int sent_ = 0;         ///< Events sent in this step.
};

}  // namespace trocar::trainer
