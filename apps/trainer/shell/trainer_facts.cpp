// What scripts, tests and benchmarks read from a running trainer.
#include <QLabel>

#include "control/attempt_control.h"
#include "control/learning_control.h"
#include "control/replay_control.h"
#include "control/results_control.h"
#include "core/available_memory.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "shell/main_window.h"
#include "shell/trainer_flow.h"
#include "ui_kit/parts.h"
#include "ui_kit/trainer_application.h"
#include "views/patient/patient_view.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
QVariantMap TrainerFlow::facts() const {
  QVariantMap facts;
  facts[QStringLiteral("case")] = open_ ? to_qt(open_->the_case.patient->name) : QString();
  facts[QStringLiteral("is_complete")] =
      open_ != nullptr && open_->later->view().is_done && window_.work().view_3d().is_ready();
  facts[QStringLiteral("is_open")] = open_ != nullptr && in<FindingBody>() == nullptr && in<Opening>() == nullptr;
  constexpr double kBytesPerMiB = 1024.0 * 1024.0;
  facts[QStringLiteral("memory_mb")] = static_cast<double>(resident_memory_bytes()) / kBytesPerMiB;
  facts[QStringLiteral("person")] = to_qt(results_->person_name());
  const auto text_of = [](const QWidget& page, const char* label) {
    const auto* found = page.findChild<QLabel*>(QString::fromLatin1(label));
    return found != nullptr && found->isVisible() ? found->text() : QString();
  };
  facts[QStringLiteral("chosen_task")] = to_qt(window_.start().choice().task);
  facts[QStringLiteral("chosen_patient")] = to_qt(window_.start().choice().patient);
  facts[QStringLiteral("history")] = text_of(window_.start(), "history-text");
  facts[QStringLiteral("comparison")] = text_of(window_.work(), "feedback-comparison");
  facts[QStringLiteral("person_message")] = text_of(window_.start(), "person-message");
  facts[QStringLiteral("is_recording_results")] = results_->has_work();
  facts[QStringLiteral("next_exercise")] = learning_->next_title();
  facts[QStringLiteral("exam_result")] = learning_->result_file();
  facts[QStringLiteral("exam_number")] = static_cast<qulonglong>(is_exam() ? choice_.exam_number : 0);
  const auto* attempting = in<Attempting>();
  if (attempting != nullptr) facts.insert(attempting->control->facts());
  if (const auto* reviewing = in<Reviewing>()) facts.insert(reviewing->control->facts());
  // Settings of the displayed ultrasound image.
  const bool tells_plan = attempting == nullptr || !is_exam();
  if (const auto picture = window_.work().ultrasound().picture(); picture && open_ && tells_plan)
    facts[QStringLiteral("picture_from_plan_mm")] = (picture->X_PT.p() - open_->X_PT_start.p()).norm();
  watch_.add_facts(facts, now_s());
  if (const auto picture = window_.work().ultrasound().picture())
    facts[QStringLiteral("ultrasound_lines")] = picture->scan.lines;
  const scene::FrameTimes& renders = window_.work().view_3d().moving_frame_times();
  facts[QStringLiteral("render_p50_ms")] = renders.p50_ms();
  facts[QStringLiteral("render_p99_ms")] = renders.p99_ms();
  const scene::FrameTimes& stills = window_.work().view_3d().still_frame_times();
  facts[QStringLiteral("still_p50_ms")] = stills.p50_ms();
  facts[QStringLiteral("unwatched_ms")] = window_.work().view_3d().unwatched_times().percentile_ms(1.0);
  if (const auto* application = qobject_cast<TrainerApplication*>(QCoreApplication::instance())) {
    const auto& slowest = application->slowest();
    facts[QStringLiteral("slowest_ms")] = slowest.empty() ? 0.0 : slowest.front().ms;
    facts[QStringLiteral("slowest")] =
        slowest.empty() ? QString()
                        : QStringLiteral("%1 ms: %2").arg(slowest.front().ms, 0, 'f', 1).arg(slowest.front().what);
  }
  return facts;
}

void TrainerFlow::reset_watch() {
  window_.work().view_3d().clear_frame_times();
  watch_.reset(now_s());
  if (auto* application = qobject_cast<TrainerApplication*>(QCoreApplication::instance())) application->reset_watch();
}

}  // namespace trocar::trainer
