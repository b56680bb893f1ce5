// What TrainerFlow does with the results of attempts.
#include "control/learning_control.h"
#include "control/results_control.h"
#include "core/version.h"
#include "shell/main_window.h"
#include "shell/trainer_flow.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {

void TrainerFlow::connect_results() {
  connect(results_.get(), &ResultsControl::history_changed, this,
          [this] { learning_->follow(results_->url(), results_->person_id()); });
  connect(results_.get(), &ResultsControl::warned, this,
          [this](const QString& text) { window_.show_message(text, BannerKind::kWarning); });
}

void TrainerFlow::record_begin(const attempt::AttemptOptions& options) {
  storage::SessionInfo info;
  info.attempt_id = options.attempt_id;
  info.person_id = options.person_id;
  info.task = open_->the_case.task.name;
  info.patient_name = open_->the_case.patient->name;
  info.patient_source = open_->choice.patient_source;
  info.patient_hash = open_->the_case.patient->content_hash;
  info.patient_seed = open_->choice.patient_seed;
  info.level = options.level;
  info.operator_name = options.trainee;
  info.program_version = kVersion;
  results_->record_begin(info);
}

/// Exams are signed; every attempt is recorded and changes the next exercise.
void TrainerFlow::keep_result(const std::filesystem::path& session) {
  learning_->forget_result();
  results_->record_end(session);
  if (is_exam()) return learning_->sign(session);
  learning_->refresh();
}

}  // namespace trocar::trainer
