#include "control/attempt_words.h"

#include <QCoreApplication>

namespace trocar::trainer {
namespace {

QString phase_tr(const char* text) {
  return QCoreApplication::translate("AttemptControl", text);
}

}  // namespace

QString phase_text(const attempt::AttemptView& view) {
  switch (view.phase) {
    case attempt::AttemptPhase::kStarting:
      return phase_tr("starting");
    case attempt::AttemptPhase::kServerLost:
      return phase_tr("interrupted");
    case attempt::AttemptPhase::kStopped:
      return phase_tr("forces stopped");
    case attempt::AttemptPhase::kFinishing:
      return phase_tr("being scored");
    default:
      break;
  }
  switch (view.needle.phase) {
    case telemetry::InsertionPhase::kOutside:
      return phase_tr("outside");
    case telemetry::InsertionPhase::kLoading:
      return phase_tr("pressing");
    case telemetry::InsertionPhase::kInserted:
      return phase_tr("in the body");
    case telemetry::InsertionPhase::kRetracting:
      return phase_tr("pulling back");
  }
  return {};
}

QString progress_text(const attempt::AttemptView& view) {
  QString step = to_qt(view.progress);
  if (step.isEmpty()) return step;
  step[0] = step[0].toUpper();
  if (view.progress_fraction <= 0.0) return step;
  return QStringLiteral("%1, %2\u00a0%").arg(step).arg(100.0 * view.progress_fraction, 0, 'f', 0);
}

}  // namespace trocar::trainer
