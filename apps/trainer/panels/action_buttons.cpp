#include "panels/action_buttons.h"

#include <QGridLayout>
#include <QPushButton>
#include <algorithm>

#include "core/result.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

const char* name_of(Action action) {
  switch (action) {
    case Action::kAnaesthetic:
      return "action-anaesthetic";
    case Action::kStylet:
      return "action-stylet";
    case Action::kAspirate:
      return "action-aspirate";
    case Action::kWire:
      return "action-wire";
    case Action::kBreath:
      return "action-breath";
    case Action::kLoad:
      return "action-load";
    default:
      break;
  }
  return "";
}

QString text_of(Action action, const ActionState& state) {
  switch (action) {
    case Action::kAnaesthetic:
      return ActionButtons::tr("Anaesthetic");
    case Action::kStylet:
      return state.is_stylet_drawn ? ActionButtons::tr("Reinsert stylet") : ActionButtons::tr("Remove stylet");
    case Action::kAspirate:
      return ActionButtons::tr("Aspirate");
    case Action::kWire:
      return state.wire_mm > 0.0 ? ActionButtons::tr("Wire further") : ActionButtons::tr("Guide wire");
    case Action::kBreath:
      return state.is_breath_held ? ActionButtons::tr("Breathe") : ActionButtons::tr("Hold breath");
    case Action::kLoad:
      return ActionButtons::tr("Load the gun");
    default:
      break;
  }
  return {};
}

/// Empty: what the table of actions says.
QString effect_of(Action action, const ActionState& state) {
  switch (action) {
    case Action::kAnaesthetic:
      return ActionButtons::tr("Inject %1 ml of local anaesthetic").arg(attempt::kAnaesthetic_ml, 0, 'f', 0);
    case Action::kStylet:
      return state.is_stylet_drawn ? ActionButtons::tr("Reinsert the stylet")
                                   : ActionButtons::tr("Remove the stylet and see what comes out of the needle");
    case Action::kWire:
      return ActionButtons::tr("Advance the guide wire by %1 mm").arg(attempt::kWireStep_mm, 0, 'f', 0);
    case Action::kBreath:
      return state.is_breath_held ? ActionButtons::tr("Let the patient breathe again")
                                  : ActionButtons::tr("Ask the patient to hold the breath");
    default:
      return {};
  }
}

void set_button_text(QPushButton& button, const QString& text, const QString& tooltip) {
  if (button.text() == text && button.toolTip() == tooltip) return;
  button.setText(text);
  button.setToolTip(tooltip);
  button.setAccessibleName(tooltip);
}

}  // namespace

attempt::TraineeAction trainee_action(Action action) {
  const auto* const found = std::ranges::find(kTraineeActions, action);
  TROCAR_CHECK(found != std::end(kTraineeActions));
  return static_cast<attempt::TraineeAction>(found - std::begin(kTraineeActions));
}

std::vector<Action> actions_of(const tasks::Task& task, const tasks::Needle& needle) {
  std::vector<Action> actions;
  for (const attempt::TraineeAction action : attempt::actions_of(task, needle))
    actions.push_back(kTraineeActions[static_cast<std::size_t>(action)]);
  return actions;
}

QString why_not(Action action, const ActionState& state, const tasks::Needle& needle) {
  switch (attempt::why_not(trainee_action(action), state, needle)) {
    case attempt::Obstacle::kNotRunning:
      return ActionButtons::tr("The attempt is not running.");
    case attempt::Obstacle::kStyletInside:
      return ActionButtons::tr("Remove the stylet first (%1).").arg(keys_text(Action::kStylet));
    case attempt::Obstacle::kGunLoaded:
      return ActionButtons::tr("The gun is loaded.");
    case attempt::Obstacle::kNeedleInside:
      return ActionButtons::tr("Withdraw the needle first: without a coaxial needle the gun is loaded outside.");
    case attempt::Obstacle::kNone:
      break;
  }
  return {};
}

ActionButtons::ActionButtons(QWidget* parent) : QWidget(parent) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(6);
  for (const Action action : kTraineeActions) {
    auto* button = make_button(name_of(action), {}, {});
    button->setParent(this);
    button->setFocusPolicy(Qt::NoFocus);
    button->setStyleSheet(QStringLiteral("QPushButton { padding: 4px 6px; }"));
    connect(button, &QPushButton::clicked, this, [this, action] { Q_EMIT requested(action); });
    button->hide();
    buttons_[action] = button;
  }
  hide();
}

void ActionButtons::begin(const std::vector<Action>& actions) {
  auto& grid = static_cast<QGridLayout&>(*layout());
  for (const auto& [action, button] : buttons_) {
    grid.removeWidget(button);
    button->hide();
  }
  int place = 0;
  for (const Action action : actions) {
    const bool is_alone = place % 2 == 0 && action == actions.back();
    grid.addWidget(buttons_[action], place / 2, place % 2, 1, is_alone ? 2 : 1);
    buttons_[action]->show();
    ++place;
  }
  show_state({});
  setVisible(!actions.empty());
}

void ActionButtons::show_state(const ActionState& state) {
  for (const auto& [action, button] : buttons_) {
    set_button_text(*button, text_of(action, state), tooltip_of(action, effect_of(action, state)));
    if (button->isEnabled() != state.can_act) button->setEnabled(state.can_act);
  }
}

}  // namespace trocar::trainer
