#include "panels/feedback_panel.h"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QVBoxLayout>
#include <algorithm>

#include "panels/core_picture.h"
#include "panels/expert_path_list.h"
#include "panels/hint_list.h"
#include "panels/score_dial.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

/// A session of an older program has no verdict.
bool has_verdict(const scoring::Outcome& outcome) {
  return outcome.is_passed || !outcome.fails.empty();
}

/// Harm is not passed, with a score or without.
bool is_harmful(const scoring::Outcome& outcome) {
  return !outcome.harms.empty() && outcome.harms.front().grade >= tasks::Harm::kMajor;
}

QString verdict_of(const scoring::Outcome& outcome) {
  if (!outcome.is_scored() && !is_harmful(outcome))
    return FeedbackPanel::tr("Not scored: %1").arg(shown(outcome.not_scored));
  if (has_verdict(outcome)) return outcome.is_passed ? FeedbackPanel::tr("Passed") : FeedbackPanel::tr("Not passed");
  if (!outcome.risks_touched.empty()) return FeedbackPanel::tr("A structure at risk was touched");
  return outcome.target_reached ? FeedbackPanel::tr("Target reached") : FeedbackPanel::tr("The target was missed");
}

/// Major and critical harm, one a line: "⚠ Critical harm: the needle went 12 mm into the heart (blood …)".
QString alarm_of(const scoring::Outcome& outcome) {
  QStringList lines;
  for (const metrics::HarmEvent& event : outcome.harms) {
    if (event.grade < tasks::Harm::kMajor) continue;
    const QString what = event.grade == tasks::Harm::kCritical ? FeedbackPanel::tr("Critical harm: %1")
                                                               : FeedbackPanel::tr("Major harm: %1");
    QString line = QStringLiteral("\u26a0 ") + what.arg(shown(metrics::harm_words(event)));
    if (!event.reason.empty()) line += QStringLiteral(" (%1)").arg(shown(event.reason));
    lines << line;
  }
  return lines.join(QLatin1Char('\n'));
}

/// One reason a line: "The target was not reached"; the harm is told above.
QString reasons_of(const scoring::Outcome& outcome) {
  QStringList reasons;
  for (const std::string& fail : outcome.fails) {
    const bool is_told = std::any_of(outcome.harms.begin(), outcome.harms.end(), [&](const auto& event) {
      return event.grade >= tasks::Harm::kMajor && metrics::harm_words(event) == fail;
    });
    if (is_told) continue;
    const QString reason = shown(fail);
    reasons << reason.left(1).toUpper() + reason.mid(1);
  }
  if (!outcome.is_scored()) reasons = QStringList(FeedbackPanel::tr("Not scored: %1").arg(shown(outcome.not_scored)));
  return reasons.join(QStringLiteral("\n"));
}

/// Target tissue of each core: "Target tissue in the cores: 15.2 mm, 16.0 mm".
QString cores_text(const std::vector<scoring::BiopsyCore>& cores) {
  QStringList lengths;
  for (const scoring::BiopsyCore& core : cores) lengths << FeedbackPanel::tr("%1 mm").arg(core.target_mm, 0, 'f', 1);
  return (cores.size() == 1 ? FeedbackPanel::tr("Target tissue in the core: %1")
                            : FeedbackPanel::tr("Target tissue in the cores: %1"))
      .arg(lengths.join(QStringLiteral(", ")));
}

/// Risk of bleeding and pain events, a line each.
QString harm_text(const scoring::Outcome& outcome) {
  QStringList lines;
  if (outcome.bleeding) {
    QString line = FeedbackPanel::tr("Risk of bleeding: %1").arg(shown(to_string(outcome.bleeding->risk)));
    for (const std::string& reason : outcome.bleeding->reasons) line += QStringLiteral("; ") + shown(reason);
    lines << line;
  }
  if (outcome.pain_events > 0) lines << FeedbackPanel::tr("Pain events: %1").arg(outcome.pain_events);
  return lines.join(QLatin1Char('\n'));
}

/// File names can be wrapped, too.
QString breakable_file_names(QString text) {
  for (const char mark : {'/', '_', '-'}) text.replace(QLatin1Char(mark), QString(QLatin1Char(mark)) + QChar(0x200b));
  return text;
}

}  // namespace

FeedbackPanel::FeedbackPanel(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("feedback-panel"));
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  scroll_ = new QScrollArea;
  scroll_->setWidgetResizable(true);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* inside = new QWidget;
  auto* content = new QVBoxLayout(inside);
  content->setContentsMargins(12, 12, 12, 12);
  content->setSpacing(10);
  alarm_ = make_label({}, "alarm");
  alarm_->setObjectName(QStringLiteral("harm-alarm"));
  alarm_->setWordWrap(true);
  alarm_->hide();
  content->addWidget(alarm_);
  verdict_ = make_label({}, "heading");
  verdict_->setObjectName(QStringLiteral("verdict"));
  verdict_->setAlignment(Qt::AlignHCenter);
  verdict_->setWordWrap(true);
  content->addWidget(verdict_);
  reasons_ = make_label({});
  reasons_->setObjectName(QStringLiteral("verdict-reasons"));
  reasons_->setAlignment(Qt::AlignHCenter);
  reasons_->setWordWrap(true);
  reasons_->hide();
  content->addWidget(reasons_);
  dial_ = new ScoreDial;
  content->addWidget(dial_, 0, Qt::AlignHCenter);
  level_ = make_label({}, "badge");
  level_->setObjectName(QStringLiteral("level"));
  level_->hide();
  content->addWidget(level_, 0, Qt::AlignHCenter);
  result_ = make_label({}, "dim");
  result_->setObjectName(QStringLiteral("exam-result"));
  result_->setWordWrap(true);
  result_->hide();
  content->addWidget(result_);
  comparison_ = make_label({}, "dim");
  comparison_->setObjectName(QStringLiteral("feedback-comparison"));
  comparison_->setWordWrap(true);
  comparison_->hide();
  content->addWidget(comparison_);
  content->addWidget(make_label(tr("Improvements"), "heading"));
  hints_ = new HintList;
  content->addWidget(hints_);
  worst_ = make_label({}, "dim");
  worst_->setWordWrap(true);
  content->addWidget(worst_);
  next_title_ = make_label(tr("Next exercise"), "heading");
  next_title_->hide();
  content->addWidget(next_title_);
  next_ = make_label({});
  next_->setObjectName(QStringLiteral("feedback-next"));
  next_->setWordWrap(true);
  next_->hide();
  content->addWidget(next_);
  score_heading_ = make_label(tr("Score"), "heading");
  content->addWidget(score_heading_);
  parts_ = new QGridLayout;
  parts_->setHorizontalSpacing(10);
  parts_->setVerticalSpacing(3);
  parts_->setColumnStretch(0, 1);
  content->addLayout(parts_);
  core_picture_ = new CorePicture;
  core_picture_->hide();
  content->addWidget(core_picture_);
  core_ = make_label({}, "dim");
  core_->setWordWrap(true);
  content->addWidget(core_);
  harm_ = make_label({}, "dim");
  harm_->setObjectName(QStringLiteral("harm"));
  harm_->setWordWrap(true);
  content->addWidget(harm_);
  expert_paths_ = new ExpertPathList;
  content->addWidget(expert_paths_);
  notes_ = make_label({}, "dim");
  notes_->setObjectName(QStringLiteral("attempt-notes"));
  notes_->setWordWrap(true);
  notes_->hide();
  content->addWidget(notes_);
  content->addStretch();
  scroll_->setWidget(inside);
  outer->addWidget(scroll_, 1);
  outer->addWidget(make_buttons());
}

QWidget* FeedbackPanel::make_buttons() {
  auto* bar = new QWidget;
  auto* grid = new QGridLayout(bar);
  grid->setContentsMargins(16, 8, 16, 12);
  grid->setSpacing(8);
  again_button_ = make_button("try-again", {}, Action::kTryAgain);
  again_button_->setProperty("role", "primary");
  show_again(false);
  worst_button_ = make_button("worst-moment", tr("Worst moment"), Action::kWorstMoment);
  auto* other = make_button("other-case", tr("Other case"), Action::kOtherCase);
  auto* report = make_button("open-report", tr("Report"), Action::kReport);
  grid->addWidget(again_button_, 0, 0, 1, 2);
  grid->addWidget(worst_button_, 1, 0, 1, 2);
  grid->addWidget(report, 2, 0);
  grid->addWidget(other, 2, 1);
  connect(again_button_, &QPushButton::clicked, this, &FeedbackPanel::again_requested);
  connect(worst_button_, &QPushButton::clicked, this, &FeedbackPanel::worst_requested);
  connect(other, &QPushButton::clicked, this, &FeedbackPanel::other_case_requested);
  connect(report, &QPushButton::clicked, this, &FeedbackPanel::report_requested);
  return bar;
}

void FeedbackPanel::show_parts(const std::vector<scoring::ScorePart>& parts) {
  clear_layout(*parts_);
  int row = 0;
  for (const scoring::ScorePart& part : parts) {
    auto* title = make_label(shown(part.title));
    title->setWordWrap(true);
    parts_->addWidget(title, row, 0);
    auto* value = make_label(shown(scoring::part_value_text(part)), "dim");
    value->setAlignment(Qt::AlignRight | Qt::AlignBottom);
    parts_->addWidget(value, row, 1);
    value->setVisible(!scoring::is_deduction(part));  // without a parent it would be a window
    if (!scoring::is_deduction(part)) parts_->addWidget(new PointsBar(part.points, part.max_points), row + 1, 0);
    auto* points = make_label(scoring::is_deduction(part)
                                  ? tr("%1").arg(part.points, 0, 'f', 0)
                                  : tr("%1 / %2").arg(part.points, 0, 'f', 0).arg(part.max_points, 0, 'f', 0),
                              "dim");
    points->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    parts_->addWidget(points, row + 1, 1);
    row += 2;
  }
}

void FeedbackPanel::show_verdict(const scoring::Outcome& outcome) {
  verdict_->setText(verdict_of(outcome));
  const bool is_judged = outcome.is_scored() || is_harmful(outcome), is_coloured = is_judged && has_verdict(outcome);
  verdict_->setStyleSheet(
      is_coloured ? QStringLiteral("color: %1;").arg((outcome.is_passed ? theme().good : theme().bad).name())
                  : QString());
  alarm_->setText(alarm_of(outcome));
  alarm_->setVisible(!alarm_->text().isEmpty());
  reasons_->setText(is_judged ? reasons_of(outcome) : QString());
  reasons_->setVisible(!reasons_->text().isEmpty());
}

void FeedbackPanel::show_outcome(const scoring::Outcome& outcome, const QString& worst_moment) {
  dial_->setVisible(outcome.is_scored());
  dial_->set_score(outcome.score);
  show_verdict(outcome);
  show_parts(outcome.parts);
  score_heading_->setVisible(outcome.is_scored());
  hints_->show_hints(outcome.hints);
  core_->setText(cores_text(outcome.cores));
  core_->setVisible(!outcome.cores.empty());
  harm_->setText(harm_text(outcome));
  harm_->setVisible(!harm_->text().isEmpty());
  worst_->setText(worst_moment);
  worst_->setVisible(!worst_moment.isEmpty());
  worst_button_->setVisible(!worst_moment.isEmpty());
  scroll_->verticalScrollBar()->setValue(0);
}

void FeedbackPanel::show_level(const QString& level) {
  level_->setText(level);
  level_->setVisible(!level.isEmpty());
}

void FeedbackPanel::show_cores(std::span<const attempt::GunShot> shots) {
  core_picture_->setVisible(!shots.empty());
  core_picture_->set_shots(shots);
}

void FeedbackPanel::show_comparison(const QString& text) {
  comparison_->setText(text);
  comparison_->setVisible(!text.isEmpty());
}

void FeedbackPanel::show_next(const QString& text) {
  next_->setText(text);
  next_->setVisible(!text.isEmpty());
  next_title_->setVisible(!text.isEmpty());
}

void FeedbackPanel::show_again(bool is_next_exam) {
  const QString text = is_next_exam ? tr("Next exam") : tr("Try again");
  const QString tip = is_next_exam ? tr("Another exam, on a body that you have not seen") : tr("Repeat the same case");
  set_button_action(*again_button_, text, Action::kTryAgain, tip);
}

void FeedbackPanel::show_result(const QString& text) {
  result_->setText(breakable_file_names(text));
  result_->setVisible(!text.isEmpty());
}

void FeedbackPanel::show_notes(const QStringList& notes) {
  const QString text = tr("Notes on the recording:") + QStringLiteral("\n•  ") + notes.join(QStringLiteral("\n•  "));
  notes_->setText(breakable_file_names(text));
  notes_->setVisible(!notes.isEmpty());
}

}  // namespace trocar::trainer
