#include "pages/history_card.h"

#include <QLabel>
#include <QVBoxLayout>
#include <algorithm>

#include "pages/curve_plot.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

QString points_text(double score) {
  return QString::number(score, 'f', 0);
}

std::size_t scored(const results::LearningCurve& curve) {
  return static_cast<std::size_t>(
      std::ranges::count_if(curve.attempts, [](const auto& one) { return one.attempt.score.has_value(); }));
}

/// What ended without a result, and what does not count; empty: nothing.
QString counts_of(const results::LearningCurve& curve) {
  if (curve.counts.unscored + curve.counts.left_out() == 0) return {};
  return shown(learning::counts_text(curve.counts)) + QLatin1Char('.');
}

/// The others at the same number of attempts; empty: nobody got that far.
QString peers_text(const results::LearningCurve& curve, std::size_t attempt) {
  if (attempt == 0 || attempt > curve.peer_curve.size() || !curve.peer_curve[attempt - 1]) return {};
  const cohort::CurvePoint& point = *curve.peer_curve[attempt - 1];
  return QObject::tr("Others at attempt %1: %2 (%3).")
      .arg(attempt)
      .arg(points_text(point.mean))
      .arg(point.people == 1 ? QObject::tr("1 person") : QObject::tr("%1 people").arg(point.people));
}

QString experts_text(const results::LearningCurve& curve) {
  if (!curve.experts) return {};
  const results::ExpertLevel& experts = *curve.experts;
  const QString range = experts.people == 1
                            ? points_text(experts.mean)
                            : QObject::tr("%1 to %2").arg(points_text(experts.low), points_text(experts.high));
  return (experts.is_simulated ? QObject::tr("Simulated experts: %1.") : QObject::tr("Experts: %1.")).arg(range);
}

QString joined_without_empty(QStringList sentences) {
  sentences.removeAll(QString());
  return sentences.join(QLatin1Char(' '));
}

}  // namespace

QString history_text(const results::LearningCurve& curve) {
  const std::size_t count = curve.attempts.size();
  if (count == 0)
    return joined_without_empty({QObject::tr("No attempt that counts yet."), counts_of(curve), experts_text(curve)});
  const auto passed = std::ranges::count_if(curve.attempts, [](const auto& one) { return one.attempt.is_passed; });
  const auto last = std::find_if(curve.attempts.rbegin(), curve.attempts.rend(),
                                 [](const auto& one) { return one.moving_mean.has_value(); });
  QString own = QObject::tr("%1 of %2 attempts passed.").arg(passed).arg(count);
  if (last != curve.attempts.rend())
    own += QObject::tr(" Mean of the last %1: %2.")
               .arg(std::min(scored(curve), results::CurveRules().window))
               .arg(points_text(*last->moving_mean));
  return joined_without_empty({own, counts_of(curve), peers_text(curve, count), experts_text(curve)});
}

QString comparison_text(const results::LearningCurve& curve) {
  if (curve.attempts.empty() || !curve.attempts.back().attempt.score) return {};
  const std::size_t count = curve.attempts.size();
  return joined_without_empty(
      {QObject::tr("Your attempt %1: %2 points.").arg(count).arg(points_text(*curve.attempts.back().attempt.score)),
       peers_text(curve, count), experts_text(curve)});
}

HistoryCard::HistoryCard(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("history"));
  setProperty("role", "card");
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(16, 10, 16, 10);
  column->setSpacing(6);
  column->addWidget(make_label(tr("Your history at this task"), "heading"));
  plot_ = new CurvePlot;
  plot_->setToolTip(
      tr("Points: your attempts, filled where passed. Line: their moving mean. Dashed: mean of the others "
         "at the same attempt. Band: experts."));
  column->addWidget(plot_, 1);
  text_ = make_label({}, "dim");
  text_->setObjectName(QStringLiteral("history-text"));
  text_->setWordWrap(true);
  column->addWidget(text_);
  hide();
}

void HistoryCard::show_history(const results::LearningCurve& curve) {
  text_->setText(history_text(curve));
  plot_->show_curve(curve);
  show();
}

void HistoryCard::clear() {
  plot_->clear();
  hide();
}

}  // namespace trocar::trainer
