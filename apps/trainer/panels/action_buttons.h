#pragma once

#include <QWidget>
#include <map>
#include <optional>
#include <vector>

#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/task.h"

class QPushButton;

namespace trocar::trainer {

/// What a trainee can do with one button or key, besides moving tools. A second press of kStylet and kBreath undoes it.
enum class TraineeAction { kAnaesthetic, kStylet, kAspirate, kWire, kBreath, kLoad };
inline constexpr TraineeAction kTraineeActions[] = {TraineeAction::kAnaesthetic, TraineeAction::kStylet,
                                                    TraineeAction::kAspirate,    TraineeAction::kWire,
                                                    TraineeAction::kBreath,      TraineeAction::kLoad};

inline constexpr double kAnaesthetic_ml = 5.0;  ///< Of one press. Range 0..20. [assumed: a syringe of 5 ml]
inline constexpr double kWireStep_mm = 50.0;    ///< Of one press. Range 1..300. [assumed]

/// Actions that make sense in a task with this needle, in the order of kTraineeActions.
std::vector<TraineeAction> actions_of(const tasks::Task& task, const tasks::Needle& needle);
/// Key of an action; independent of the focus. Stylet and gun share one: a needle has only one of them.
Qt::Key key_of(TraineeAction action) noexcept;
/// The action of a key among those of a task; empty: none.
std::optional<TraineeAction> action_of(int key, const std::vector<TraineeAction>& actions) noexcept;

/// State on which the actions depend.
struct ActionState {
  bool is_stylet_drawn = false, is_breath_held = false;
  double wire_mm = 0.0;  ///< Of the guide wire beyond the tip; 0: not in the needle.
  bool can_act = false;  ///< The attempt runs.
  bool is_gun_loaded = true, is_outside = true;
};
/// The request of a pressed action.
tasks::ActionRequest request_of(TraineeAction action, const ActionState& state) noexcept;
/// Reason why an action is not possible, for the trainee; empty: it is possible.
QString why_not(TraineeAction action, const ActionState& state, const tasks::Needle& needle);

/// Buttons of a task's actions, two in a row. Object names: action-anaesthetic, action-stylet, action-aspirate,
/// action-wire, action-breath, action-load.
class ActionButtons : public QWidget {
  Q_OBJECT

 public:
  explicit ActionButtons(QWidget* parent = nullptr);

  /// Hidden without actions.
  void begin(const std::vector<TraineeAction>& actions);
  void show_state(const ActionState& state);

 Q_SIGNALS:
  void requested(trocar::trainer::TraineeAction action);

 private:
  std::map<TraineeAction, QPushButton*> buttons_;
};

}  // namespace trocar::trainer
