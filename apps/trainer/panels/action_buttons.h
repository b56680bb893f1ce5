#pragma once

#include <QWidget>
#include <map>
#include <vector>

#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/task.h"
#include "ui_kit/action_table.h"

class QPushButton;

namespace trocar::trainer {

/// Actions with a button of their own, in the order of the buttons. A second press of kStylet and kBreath undoes it.
inline constexpr Action kTraineeActions[] = {Action::kAnaesthetic, Action::kStylet, Action::kAspirate,
                                             Action::kWire,        Action::kBreath, Action::kLoad};

inline constexpr double kAnaesthetic_ml = 5.0;  ///< Of one press. Range 0..20. [assumed: a syringe of 5 ml]
inline constexpr double kWireStep_mm = 50.0;    ///< Of one press. Range 1..300. [assumed]

/// Actions that make sense in a task with this needle, in the order of kTraineeActions.
std::vector<Action> actions_of(const tasks::Task& task, const tasks::Needle& needle);

/// State on which the actions depend.
struct ActionState {
  bool is_stylet_drawn = false, is_breath_held = false;
  double wire_mm = 0.0;  ///< Of the guide wire beyond the tip; 0: not in the needle.
  bool can_act = false;  ///< The attempt runs.
  bool is_gun_loaded = true, is_outside = true;
};
/// The request of a pressed action.
tasks::ActionRequest request_of(Action action, const ActionState& state) noexcept;
/// Reason why an action is not possible, for the trainee; empty: it is possible.
QString why_not(Action action, const ActionState& state, const tasks::Needle& needle);

/// Buttons of a task's actions, two in a row. Object names: action-anaesthetic, action-stylet, action-aspirate,
/// action-wire, action-breath, action-load.
class ActionButtons : public QWidget {
  Q_OBJECT

 public:
  explicit ActionButtons(QWidget* parent = nullptr);

  /// Hidden without actions.
  void begin(const std::vector<Action>& actions);
  void show_state(const ActionState& state);

 Q_SIGNALS:
  void requested(trocar::trainer::Action action);

 private:
  std::map<Action, QPushButton*> buttons_;
};

}  // namespace trocar::trainer
