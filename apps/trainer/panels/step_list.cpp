#include "panels/step_list.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

/// Of the grid: the title, and below the current one what it lacks, the reason and help.
constexpr int kLinesAStep = 4;

void set_color(QLabel& label, const QColor& color, bool is_bold = false) {
  const QString sheet =
      QStringLiteral("color: %1;%2").arg(color.name(), is_bold ? QStringLiteral(" font-weight: 600;") : QString());
  if (label.styleSheet() != sheet) label.setStyleSheet(sheet);
}

QString step_name(std::size_t step, const char* part = "") {
  return QStringLiteral("step-%1%2").arg(step + 1).arg(QLatin1String(part));
}

bool look_same(const attempt::PhaseView& a, const attempt::PhaseView& b) {
  return a.title == b.title && a.why == b.why && a.lacks == b.lacks && a.is_open == b.is_open && a.done_s == b.done_s;
}

}  // namespace

StepList::StepList(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("steps"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  auto* top = new QHBoxLayout;
  heading_ = make_label({}, "dim");
  heading_->setObjectName(QStringLiteral("steps-heading"));
  fold_ = make_tool_button("steps-fold", {}, tr("Show all steps, or only the current ones"));
  fold_->setFocusPolicy(Qt::TabFocus);
  fold_->setStyleSheet(QStringLiteral("QToolButton { padding: 0 6px; min-height: 0; }"));
  top->addWidget(heading_, 1);
  top->addWidget(fold_);
  column->addLayout(top);
  grid_ = new QGridLayout;
  grid_->setHorizontalSpacing(6);
  grid_->setVerticalSpacing(2);
  grid_->setColumnStretch(1, 1);
  column->addLayout(grid_);
  for (QLabel** label : {&lacks_, &why_, &stuck_}) {
    *label = make_label({}, "", this);
    (*label)->setWordWrap(true);
    (*label)->hide();
  }
  lacks_->setObjectName(QStringLiteral("step-lacks"));
  set_color(*lacks_, theme().accent, true);
  why_->setObjectName(QStringLiteral("step-why"));
  set_color(*why_, theme().dim);
  stuck_->setObjectName(QStringLiteral("step-stuck"));
  set_color(*stuck_, theme().text);
  connect(fold_, &QToolButton::clicked, this, [this] {
    is_chosen_ = true;
    set_folded(!is_folded_);
  });
  set_folded(false);
  hide();
}

void StepList::show_steps(const std::vector<attempt::PhaseView>& steps, std::optional<std::size_t> current,
                          double time_s, bool has_help, const QString& stuck) {
  bool is_same =
      steps.size() == steps_.size() && current == current_ && has_help == has_help_ && stuck_->text() == stuck;
  const bool are_new = steps.size() != steps_.size();
  steps_.resize(steps.size());
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const bool is_confirmed = steps[s].done_s && time_s - *steps[s].done_s < kConfirmed_s;
    is_same = is_same && look_same(steps_[s].phase, steps[s]) && steps_[s].is_confirmed == is_confirmed;
    steps_[s] = {steps[s], is_confirmed};
  }
  if (is_same) return;
  current_ = current;
  has_help_ = has_help;
  if (are_new) make_rows();
  set_label_text(*stuck_, stuck);
  update_rows();
  update_heading();
  setVisible(!steps_.empty());
}

void StepList::make_rows() {
  for (const Row& row : rows_) {
    delete row.mark;
    delete row.title;
    delete row.repeat;
  }
  rows_.clear();
  grid_->removeWidget(lacks_);
  grid_->removeWidget(why_);
  grid_->removeWidget(stuck_);
  int line = 0;
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    Row row{make_label({}, "", this), make_label({}, "", this), nullptr};
    row.mark->setFixedWidth(row.mark->fontMetrics().horizontalAdvance(QStringLiteral("00")));
    row.mark->setAlignment(Qt::AlignTop | Qt::AlignHCenter);
    row.title->setObjectName(step_name(s));
    row.title->setWordWrap(true);
    row.repeat = make_tool_button("", QStringLiteral("\u21bb"), {});
    row.repeat->setObjectName(step_name(s, "-repeat"));
    row.repeat->setFocusPolicy(Qt::TabFocus);  // a click leaves the arrow keys with the tool
    row.repeat->setStyleSheet(QStringLiteral("QToolButton { padding: 0 4px; min-height: 0; }"));
    connect(row.repeat, &QToolButton::clicked, this, [this, s] { Q_EMIT repeat_requested(s); });
    grid_->addWidget(row.mark, line, 0, Qt::AlignTop);
    grid_->addWidget(row.repeat, line, 2, Qt::AlignTop);
    rows_.push_back(row);
    line += kLinesAStep;
  }
}

/// Folded: the last done step before the current one, the current one and the next one.
bool StepList::is_row_shown(std::size_t step) const {
  if (!is_folded_) return true;
  const std::size_t current = current_.value_or(steps_.size());
  return step + 1 == current || step == current || step == current + 1;
}

void StepList::update_rows() {
  const bool has_current = current_ && has_help_;
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    const attempt::PhaseView& phase = steps_[s].phase;
    const Row& row = rows_[s];
    const bool is_current = s == current_, is_done = phase.done_s.has_value(), is_shown = is_row_shown(s);
    set_label_text(*row.mark, is_done      ? QStringLiteral("\u2713")
                              : is_current ? QStringLiteral("\u25b6")
                                           : QString::number(s + 1));
    set_color(*row.mark, is_done ? theme().good : is_current ? theme().accent : theme().dim, is_done || is_current);
    const QString title = shown(phase.title);
    set_label_text(*row.title, title);
    set_color(*row.title, steps_[s].is_confirmed ? theme().good : is_current ? theme().text : theme().dim, is_current);
    row.title->setToolTip(has_help_ ? shown(phase.why) : QString());
    row.title->setAccessibleName(is_done ? tr("done: %1").arg(title) : is_current ? tr("now: %1").arg(title) : title);
    row.repeat->setToolTip(tr("Repeat this step: %1").arg(title));
    row.repeat->setAccessibleName(tr("Repeat: %1").arg(title));
    grid_->addWidget(row.title, static_cast<int>(kLinesAStep * s), 1, 1, is_done ? 1 : 2);
    row.mark->setVisible(is_shown);
    row.title->setVisible(is_shown);
    row.repeat->setVisible(is_shown && is_done);
    if (is_current && has_current) {
      grid_->addWidget(lacks_, static_cast<int>(kLinesAStep * s + 1), 1, 1, 2);
      grid_->addWidget(why_, static_cast<int>(kLinesAStep * s + 2), 1, 1, 2);
      grid_->addWidget(stuck_, static_cast<int>(kLinesAStep * s + 3), 1, 1, 2);
    }
  }
  const QString lacks = has_current ? shown(steps_[*current_].phase.lacks) : QString();
  const bool is_title = has_current && lacks.compare(shown(steps_[*current_].phase.title), Qt::CaseInsensitive) == 0;
  set_label_text(*lacks_, is_title ? QString() : lacks);
  set_label_text(*why_, has_current ? shown(steps_[*current_].phase.why) : QString());
  lacks_->setVisible(!lacks_->text().isEmpty());
  why_->setVisible(!why_->text().isEmpty());
  stuck_->setVisible(has_current && !stuck_->text().isEmpty());
}

void StepList::update_heading() {
  const auto confirmed = std::find_if(steps_.rbegin(), steps_.rend(), [](const Step& s) { return s.is_confirmed; });
  const auto done = std::count_if(steps_.begin(), steps_.end(), [](const Step& s) { return s.phase.done_s; });
  if (confirmed != steps_.rend()) {
    set_label_text(*heading_, tr("\u2713 Step %1 done").arg(std::distance(confirmed, steps_.rend())));
  } else if (done == static_cast<std::ptrdiff_t>(steps_.size())) {
    set_label_text(*heading_, tr("All steps done"));
  } else {
    set_label_text(*heading_, tr("%1 of %2 steps done").arg(done).arg(steps_.size()));
  }
  set_color(*heading_, confirmed != steps_.rend() ? theme().good : theme().dim, confirmed != steps_.rend());
}

void StepList::propose_folded(bool is_folded) {
  if (!is_chosen_) set_folded(is_folded);
}

void StepList::set_folded(bool is_folded) {
  is_folded_ = is_folded;
  fold_->setText(is_folded ? tr("All steps") : tr("Fewer"));
  if (!rows_.empty()) update_rows();
}

}  // namespace trocar::trainer
