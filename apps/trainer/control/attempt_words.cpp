#include "control/attempt_words.h"

#include <QCoreApplication>

#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

class AttemptWords {
  Q_DECLARE_TR_FUNCTIONS(AttemptWords)
};

}  // namespace

QString phase_text(const attempt::AttemptView& view) {
  switch (view.phase) {
    case attempt::AttemptPhase::kStarting:
      return AttemptWords::tr("starting");
    case attempt::AttemptPhase::kServerLost:
      return AttemptWords::tr("interrupted");
    case attempt::AttemptPhase::kStopped:
      return AttemptWords::tr("forces stopped");
    case attempt::AttemptPhase::kFinishing:
      return AttemptWords::tr("being scored");
    default:
      break;
  }
  switch (view.needle.phase) {
    case telemetry::InsertionPhase::kOutside:
      return AttemptWords::tr("outside");
    case telemetry::InsertionPhase::kLoading:
      return AttemptWords::tr("pressing");
    case telemetry::InsertionPhase::kInserted:
      return AttemptWords::tr("in the body");
    case telemetry::InsertionPhase::kRetracting:
      return AttemptWords::tr("pulling back");
  }
  return {};
}

QString progress_text(const attempt::AttemptView& view) {
  QString step = shown(view.progress);
  if (step.isEmpty()) return step;
  step[0] = step[0].toUpper();
  if (view.progress_fraction <= 0.0) return step;
  return QStringLiteral("%L1, %L2\u00a0%").arg(step).arg(100.0 * view.progress_fraction, 0, 'f', 0);
}

}  // namespace trocar::trainer
