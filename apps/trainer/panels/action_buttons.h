#pragma once

#include <QWidget>
#include <map>
#include <vector>

#include "attempt/tools/trainee_action.h"
#include "ui_kit/action_table.h"

class QPushButton;

namespace trocar::trainer {

using attempt::ActionState;

/// Actions with a button of their own, in the order of attempt::TraineeAction and of the buttons.
inline constexpr Action kTraineeActions[] = {Action::kAnaesthetic, Action::kStylet, Action::kAspirate,
                                             Action::kWire,        Action::kBreath, Action::kLoad};

/// The action of one of kTraineeActions.
attempt::TraineeAction trainee_action(Action action);
/// attempt::actions_of for kTraineeActions.
std::vector<Action> actions_of(const tasks::Task& task, const tasks::Needle& needle);
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
