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

/// What a player needs of the window, so that it can be tried on any widget.
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
  /// Empty: all steps were played. Else "line 12: …".
  void finished(const QString& error);

 private:
  enum class Progress { kDone, kAgain };

  void play_on();
  Result<Progress> play(const ScriptStep& step);
  Result<Progress> play_pointer(const ScriptStep& step, QWidget& widget);
  Result<Progress> play_drag(const ScriptStep& step, QWidget& widget);
  /// Acts so often a second until the fact is there.
  Result<Progress> play_until(const ScriptStep& step, const std::function<Status()>& act);
  Result<Progress> play_waiting(const ScriptStep& step);
  Result<Progress> expect_whole() const;
  Result<Progress> play_looking(const ScriptStep& step);
  /// Null: not to be seen yet.
  Result<QWidget*> find(const QString& name) const;
  /// Null: not to be seen, or disabled, yet.
  Result<QWidget*> find_usable(const QString& name) const;
  Result<Progress> click_menu_entry(QAction& entry) const;
  bool holds(const QString& fact, const QString& op, const QString& value) const;
  /// Done once the fact holds; an error where it does not within the step's time.
  Result<Progress> wait_until_holds(const QStringList& fact_op_value, double timeout_s);
  double seconds() const { return static_cast<double>(clock_.nsecsElapsed()) / 1e9; }

  std::vector<ScriptStep> steps_;
  Stage stage_;
  std::size_t at_ = 0;
  QTimer timer_;
  QElapsedTimer clock_;  ///< Since the step began.
  int sent_ = 0;         ///< Events of this step so far.
};

}  // namespace trocar::trainer
