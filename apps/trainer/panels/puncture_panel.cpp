#include "panels/puncture_panel.h"

#include <QButtonGroup>
#include <QGridLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QShortcut>
#include <QVBoxLayout>
#include <cmath>

#include "panels/core_picture.h"
#include "panels/step_list.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/wrapped_rows.h"
#include "views/plots/force_bar.h"

namespace trocar::trainer {
namespace {

/// Short enough for two of them in a row.
QString length_text(const std::optional<double>& length_mm) {
  if (!length_mm) return QStringLiteral("–");
  return PuncturePanel::tr("%1 mm").arg(*length_mm, 0, 'f', std::abs(*length_mm) < 100.0 ? 1 : 0);
}

/// A caption and its value.
QLabel* add_figure(QHBoxLayout& row, const QString& title, const char* name, Qt::Alignment alignment) {
  row.addWidget(make_label(title, "dim"), 0, Qt::AlignTop);
  auto* value = make_label({});
  value->setObjectName(QString::fromLatin1(name));
  value->setAlignment(alignment | Qt::AlignTop);
  row.addWidget(value, 1);
  return value;
}

}  // namespace

PuncturePanel::PuncturePanel(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("puncture-panel"));
  auto* inside = new QWidget;
  make_content(*inside);
  fire_ = make_button("fire", tr("Fire the gun"), Action::kFire);
  fire_->setProperty("role", "primary");
  fire_->setFocusPolicy(Qt::NoFocus);
  end_ = make_button("end-attempt", tr("End the attempt"), Action::kEnd);
  end_->setFocusPolicy(Qt::NoFocus);
  scroll_ = make_scrolled(*inside);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(scroll_, 1);
  auto* buttons = new QVBoxLayout;  // always visible
  buttons->setContentsMargins(12, 8, 12, 12);
  buttons->setSpacing(8);
  buttons->addWidget(fire_);
  buttons->addWidget(end_);
  buttons->addWidget(make_question());
  column->addLayout(buttons);
  connect(fire_, &QPushButton::clicked, this, &PuncturePanel::fire_requested);
  connect(end_, &QPushButton::clicked, this, &PuncturePanel::end_requested);
}

int PuncturePanel::needed_width() const {
  return scroll_->widget()->minimumSizeHint().width() + scroll_->verticalScrollBar()->sizeHint().width();
}

void PuncturePanel::make_content(QWidget& inside) {
  auto* content = new QVBoxLayout(&inside);
  content->setContentsMargins(12, 10, 12, 4);
  content->setSpacing(8);
  content->addWidget(make_tool_choice());  // buttons above the text: they keep their place
  actions_ = new ActionButtons;
  content->addWidget(actions_);
  connect(actions_, &ActionButtons::requested, this, &PuncturePanel::action_requested);
  steps_ = new StepList;
  content->addWidget(steps_);
  hint_ = make_label({});
  hint_->setObjectName(QStringLiteral("hint"));
  hint_->setWordWrap(true);
  hint_->setAlignment(Qt::AlignTop);
  content->addWidget(hint_);
  content->addWidget(make_figures());
  force_ = new ForceBar(Qt::Horizontal);
  force_->setObjectName(QStringLiteral("force-bar"));
  content->addWidget(force_);
  core_ = new CorePicture;
  core_->hide();
  content->addWidget(core_);
  events_ = new QListWidget;
  events_->setObjectName(QStringLiteral("events"));
  events_->setFocusPolicy(Qt::NoFocus);
  wrap_rows(*events_);
  events_->setSelectionMode(QAbstractItemView::NoSelection);
  constexpr int kLeastEvents = 3;  // rows
  events_->setMinimumHeight(kLeastEvents * (events_->fontMetrics().lineSpacing() + 8));
  content->addWidget(events_, 1);
  connect(events_->verticalScrollBar(), &QScrollBar::rangeChanged, events_, &QListWidget::scrollToBottom);
}

/// In a low window only the steps about the current one are shown.
void PuncturePanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  constexpr int kLinesForAllSteps = 60;  // with depth, resistance and events below them
  steps_->propose_folded(height() < kLinesForAllSteps * fontMetrics().lineSpacing());
}

QWidget* PuncturePanel::make_tool_choice() {
  auto* box = new QWidget;
  auto* grid = new QGridLayout(box);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(6);
  const QString narrow = QStringLiteral("QPushButton { padding: 4px 5px; }");
  tool_buttons_ = new QButtonGroup(this);
  const auto add = [&](ActiveTool tool, const char* name, const QString& text, Action action, const QString& does,
                       int row, int column) {
    auto* button = make_button(name, text, action, does);
    button->setCheckable(true);
    button->setFocusPolicy(Qt::NoFocus);
    button->setStyleSheet(narrow);
    tool_buttons_->addButton(button, static_cast<int>(tool));
    grid->addWidget(button, row, column);
    connect(button, &QPushButton::clicked, this, [this, tool] { Q_EMIT tool_requested(tool); });
  };
  add(ActiveTool::kNeedle, "tool-needle", tr("Needle"), Action::kSelectNeedle,
      tr("Active tool: the mouse moves the needle"), 0, 0);
  add(ActiveTool::kTransducer, "tool-transducer", tr("Transducer"), Action::kSelectTransducer,
      tr("Active tool: the mouse moves the transducer"), 0, 1);
  add(ActiveTool::kFinger, "tool-finger", tr("Finger"), Action::kSelectFinger,
      tr("Active tool: a finger feels the skin under the pointer; a click marks the place"), 0, 2);
  add(ActiveTool::kNone, "tool-none", tr("View"), Action::kSelectView, tr("No active tool: the mouse rotates the view"),
      1, 0);
  clamp_ = make_button("clamp", tr("Lock"), Action::kLock, tr("Hold the active tool in place"));
  clamp_->setCheckable(true);
  aim_ = make_button("aim", tr("Move to planned position"), Action::kPlannedPosition);
  for (QPushButton* button : {clamp_, aim_}) {
    button->setFocusPolicy(Qt::NoFocus);
    button->setStyleSheet(narrow);
  }
  grid->addWidget(clamp_, 1, 1);
  grid->addWidget(aim_, 2, 0, 1, 3);
  connect(clamp_, &QPushButton::clicked, this, &PuncturePanel::clamp_requested);
  connect(aim_, &QPushButton::clicked, this, &PuncturePanel::aim_requested);
  return box;
}

QWidget* PuncturePanel::make_question() {
  question_ = new QFrame;
  question_->setObjectName(QStringLiteral("question"));
  question_->setProperty("role", "card");
  auto* rows = new QVBoxLayout(question_);
  rows->setContentsMargins(10, 8, 10, 10);
  rows->setSpacing(6);
  question_text_ = make_label({});
  question_text_->setWordWrap(true);
  yes_ = make_button("question-yes", {}, Action::kConfirm);
  yes_->setProperty("role", "primary");
  auto* no = make_button("question-no", tr("Go on (Esc)"), tr("Continue the attempt"));
  for (QPushButton* button : {yes_, no}) button->setFocusPolicy(Qt::NoFocus);
  rows->addWidget(question_text_);
  rows->addWidget(yes_);
  rows->addWidget(no);
  question_->hide();
  connect(yes_, &QPushButton::clicked, this, [this] { answer(true); });
  connect(no, &QPushButton::clicked, this, [this] { answer(false); });
  for (const int key : {Qt::Key_Return, Qt::Key_Enter, Qt::Key_Escape}) {
    auto* shortcut = new QShortcut(QKeySequence(key), this);
    shortcut->setEnabled(false);
    shortcut->setAutoRepeat(false);
    connect(shortcut, &QShortcut::activated, this, [this, key] { answer(key != Qt::Key_Escape); });
    answers_.push_back(shortcut);
  }
  return question_;
}

void PuncturePanel::show_core(const attempt::GunShot& shot) {
  core_->set_shots({&shot, 1});
  core_->show();
}

void PuncturePanel::ask(const QString& question, const QString& yes) {
  question_text_->setText(question);
  yes_->setText(yes);
  yes_->setAccessibleName(yes);
  for (QWidget* covered : {fire_, end_}) covered->hide();
  question_->show();
  for (QShortcut* shortcut : answers_) shortcut->setEnabled(true);
  Q_EMIT asked();
}

bool PuncturePanel::is_asking() const {
  return !question_->isHidden();
}

void PuncturePanel::answer(bool is_yes) {
  for (QShortcut* shortcut : answers_) shortcut->setEnabled(false);
  question_->hide();
  fire_->setVisible(has_gun_);
  end_->show();
  if (is_yes) Q_EMIT confirmed();
}

QWidget* PuncturePanel::make_figures() {
  auto* box = new QWidget;
  auto* rows = new QVBoxLayout(box);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(4);
  const auto add_row = [&] {
    auto* row = new QHBoxLayout;
    row->setSpacing(5);
    rows->addLayout(row);
    return row;
  };
  auto* needle = add_row();
  phase_ = add_figure(*needle, tr("Needle"), "phase", Qt::AlignLeft);
  time_ = make_label({});
  time_->setObjectName(QStringLiteral("time"));
  time_->setToolTip(tr("Time since the needle touched the skin"));
  needle->addWidget(time_);
  tissue_ = add_figure(*add_row(), tr("Tissue at the tip"), "tissue", Qt::AlignRight);
  tissue_->setWordWrap(true);
  auto* distances = add_row();
  depth_ = add_figure(*distances, tr("Depth"), "depth", Qt::AlignLeft);
  target_ = add_figure(*distances, tr("Target"), "to-target", Qt::AlignRight);
  target_->setToolTip(tr("Distance of the tip from the target"));
  return box;
}

void PuncturePanel::begin(double most_force_n, bool can_aim, bool has_gun, const std::vector<Action>& actions) {
  has_gun_ = has_gun;
  actions_->begin(actions);
  steps_->show_steps({}, {}, 0.0, false);
  aim_->setVisible(can_aim);
  events_->clear();
  force_->clear();
  core_->hide();
  answer(false);
  constexpr double kFullLag_mm = 15.0;
  force_->set_scale(most_force_n, kFullLag_mm);
  show_figures({});
}

void PuncturePanel::show_figures(const PunctureFigures& figures) {
  set_label_text(*phase_, figures.phase);
  set_label_text(*tissue_, figures.tissue);
  set_label_text(*depth_, length_text(figures.depth_mm));
  set_label_text(*target_, length_text(figures.to_target_mm));
  set_label_text(*time_, tr("%1 s").arg(figures.since_contact_s, 0, 'f', 0));
  show_hint(figures);
  actions_->show_state(figures.actions);
  force_->set_force(figures.force_n, figures.time_s);
  force_->set_lag(figures.lag_mm);
  if (fire_->isEnabled() != figures.can_fire) fire_->setEnabled(figures.can_fire);
  const int tool = tool_buttons_->checkedId();
  const bool is_clamped = (tool == static_cast<int>(ActiveTool::kNeedle) && figures.is_clamped[0]) ||
                          (tool == static_cast<int>(ActiveTool::kTransducer) && figures.is_clamped[1]);
  if (clamp_->isChecked() != is_clamped) clamp_->setChecked(is_clamped);
}

void PuncturePanel::show_hint(const PunctureFigures& figures) {
  set_label_text(*hint_, figures.hint);
  const int lines_px = hint_->fontMetrics().lineSpacing() * (steps_->isHidden() ? 3 : 2);
  if (hint_->minimumHeight() != lines_px) hint_->setMinimumHeight(lines_px);
  const QString sheet =
      figures.is_hint_notice
          ? QStringLiteral(
                "QLabel { background: %1; border: 1px solid %2; border-radius: 6px; padding: 5px; font-weight: 600; }")
                .arg(theme().raised.name(), theme().accent.name())
          : QString();
  if (hint_->styleSheet() != sheet) hint_->setStyleSheet(sheet);
}

void PuncturePanel::show_active_tool(ActiveTool tool) {
  if (auto* button = tool_buttons_->button(static_cast<int>(tool))) button->setChecked(true);
}

void PuncturePanel::add_event(const QString& text, bool is_bad) {
  auto* row = new QListWidgetItem(text, events_);
  if (is_bad) row->setForeground(theme().bad);
  events_->scrollToBottom();
}

}  // namespace trocar::trainer
