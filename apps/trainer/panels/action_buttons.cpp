#include "panels/action_buttons.h"

#include <QGridLayout>
#include <QPushButton>
#include <algorithm>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

bool asks_for(const tasks::Task& task, tasks::ConditionKind kind) {
  return std::any_of(task.phases.begin(), task.phases.end(), [&](const tasks::Phase& phase) {
    return std::any_of(phase.done.begin(), phase.done.end(), [&](const auto& done) { return done.kind == kind; });
  });
}

const char* name_of(TraineeAction action) {
  switch (action) {
    case TraineeAction::kAnaesthetic:
      return "action-anaesthetic";
    case TraineeAction::kStylet:
      return "action-stylet";
    case TraineeAction::kAspirate:
      return "action-aspirate";
    case TraineeAction::kWire:
      return "action-wire";
    case TraineeAction::kBreath:
      return "action-breath";
    case TraineeAction::kLoad:
      return "action-load";
  }
  return "";
}

QString text_of(TraineeAction action, const ActionState& state) {
  switch (action) {
    case TraineeAction::kAnaesthetic:
      return ActionButtons::tr("Anaesthetic");
    case TraineeAction::kStylet:
      return state.is_stylet_drawn ? ActionButtons::tr("Stylet in") : ActionButtons::tr("Draw stylet");
    case TraineeAction::kAspirate:
      return ActionButtons::tr("Aspirate");
    case TraineeAction::kWire:
      return state.wire_mm > 0.0 ? ActionButtons::tr("Wire further") : ActionButtons::tr("Guide wire");
    case TraineeAction::kBreath:
      return state.is_breath_held ? ActionButtons::tr("Breathe") : ActionButtons::tr("Hold breath");
    case TraineeAction::kLoad:
      return ActionButtons::tr("Load the gun");
  }
  return {};
}

QString tooltip_of(TraineeAction action, const ActionState& state) {
  switch (action) {
    case TraineeAction::kAnaesthetic:
      return ActionButtons::tr("Inject %1 ml of local anaesthetic").arg(kAnaesthetic_ml, 0, 'f', 0);
    case TraineeAction::kStylet:
      return state.is_stylet_drawn ? ActionButtons::tr("Put the stylet back")
                                   : ActionButtons::tr("Draw the stylet and see what comes out of the needle");
    case TraineeAction::kAspirate:
      return ActionButtons::tr("Pull at a syringe and see what comes");
    case TraineeAction::kWire:
      return ActionButtons::tr("Advance the guide wire by %1 mm").arg(kWireStep_mm, 0, 'f', 0);
    case TraineeAction::kBreath:
      return state.is_breath_held ? ActionButtons::tr("Let the patient breathe again")
                                  : ActionButtons::tr("Ask the patient to hold the breath");
    case TraineeAction::kLoad:
      return ActionButtons::tr("Take the core out and load the gun again");
  }
  return {};
}

void set_button_text(QPushButton& button, const QString& text, const QString& tooltip) {
  if (button.text() == text && button.toolTip() == tooltip) return;
  button.setText(text);
  button.setToolTip(tooltip);
  button.setAccessibleName(tooltip);
}

}  // namespace

std::vector<TraineeAction> actions_of(const tasks::Task& task, const tasks::Needle& needle) {
  std::vector<TraineeAction> actions;
  if (task.pain.needs_anaesthesia || asks_for(task, tasks::ConditionKind::kAnaesthetised))
    actions.push_back(TraineeAction::kAnaesthetic);
  if (!needle.is_biopsy && needle.stylet_diameter_mm > 0.0) actions.push_back(TraineeAction::kStylet);
  if (!needle.is_biopsy && needle.inner_diameter_mm > 0.0) actions.push_back(TraineeAction::kAspirate);
  if (asks_for(task, tasks::ConditionKind::kWire)) actions.push_back(TraineeAction::kWire);
  if (asks_for(task, tasks::ConditionKind::kBreathHeld)) actions.push_back(TraineeAction::kBreath);
  if (needle.is_biopsy) actions.push_back(TraineeAction::kLoad);
  return actions;
}

/// Letters that no view uses: N as in numb, Y as in stylet (and the gun's), Q as in aspirate (syringe), W as in wire,
/// U.
Qt::Key key_of(TraineeAction action) noexcept {
  switch (action) {
    case TraineeAction::kAnaesthetic:
      return Qt::Key_N;
    case TraineeAction::kStylet:
      return Qt::Key_Y;
    case TraineeAction::kAspirate:
      return Qt::Key_Q;
    case TraineeAction::kWire:
      return Qt::Key_W;
    case TraineeAction::kBreath:
      return Qt::Key_U;
    case TraineeAction::kLoad:
      return Qt::Key_Y;
  }
  return Qt::Key_unknown;
}

std::optional<TraineeAction> action_of(int key, const std::vector<TraineeAction>& actions) noexcept {
  for (const TraineeAction action : actions)
    if (key_of(action) == key) return action;
  return std::nullopt;
}

tasks::ActionRequest request_of(TraineeAction action, const ActionState& state) noexcept {
  switch (action) {
    case TraineeAction::kAnaesthetic:
      return {tasks::ActionKind::kAnaesthetise, kAnaesthetic_ml};
    case TraineeAction::kStylet:
      return {state.is_stylet_drawn ? tasks::ActionKind::kReplaceStylet : tasks::ActionKind::kDrawStylet};
    case TraineeAction::kAspirate:
      return {tasks::ActionKind::kAspirate};
    case TraineeAction::kWire:
      return {tasks::ActionKind::kAdvanceWire, state.wire_mm + kWireStep_mm};
    case TraineeAction::kBreath:
      return {state.is_breath_held ? tasks::ActionKind::kBreathe : tasks::ActionKind::kHoldBreath};
    case TraineeAction::kLoad:
      return {tasks::ActionKind::kLoad};
  }
  return {};
}

QString why_not(TraineeAction action, const ActionState& state, const tasks::Needle& needle) {
  if (!state.can_act) return ActionButtons::tr("The attempt is not running.");
  const bool needs_bore = action == TraineeAction::kAspirate || action == TraineeAction::kWire;
  if (needs_bore && needle.stylet_diameter_mm > 0.0 && !state.is_stylet_drawn)
    return ActionButtons::tr("Draw the stylet first (Y).");
  if (action != TraineeAction::kLoad) return {};
  if (state.is_gun_loaded) return ActionButtons::tr("The gun is loaded.");
  if (!needle.is_coaxial && !state.is_outside)
    return ActionButtons::tr("Withdraw the needle first: without a coaxial needle the gun is loaded outside.");
  return {};
}

ActionButtons::ActionButtons(QWidget* parent) : QWidget(parent) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(6);
  for (const TraineeAction action : kTraineeActions) {
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

void ActionButtons::begin(const std::vector<TraineeAction>& actions) {
  auto& grid = static_cast<QGridLayout&>(*layout());
  for (const auto& [action, button] : buttons_) {
    grid.removeWidget(button);
    button->hide();
  }
  int place = 0;
  for (const TraineeAction action : actions) {
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
    set_button_text(*button, text_of(action, state),
                    tr("%1 (%2)").arg(tooltip_of(action, state)).arg(QChar(static_cast<char16_t>(key_of(action)))));
    if (button->isEnabled() != state.can_act) button->setEnabled(state.can_act);
  }
}

}  // namespace trocar::trainer
