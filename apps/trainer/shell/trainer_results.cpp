// What TrainerFlow does with the results of attempts.
#include "control/learning_control.h"
#include "control/results_control.h"
#include "core/version.h"
#include "io/patient/patient_source.h"
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

void TrainerFlow::record_begin(const attempt::AttemptOptions& options, const exams::Examinee& person) {
  begun_ = {};
  begun_.attempt_id = options.attempt_id;
  begun_.person_id = options.person_id;
  begun_.task = open_->the_case.task.name;
  begun_.patient_name = open_->the_case.patient->name;
  begun_.patient_source = open_->choice.patient_source;
  begun_.patient_hash = open_->the_case.patient->content_hash;
  begun_.patient_seed = open_->choice.patient_seed;
  begun_.level = options.level;
  begun_.operator_name = options.trainee;
  begun_.program_version = kVersion;
  examinee_ = person;
  results_->record_begin(begun_);
}

exams::ExamEnd TrainerFlow::exam_end(const attempt::RunResult& result) const {
  exams::ExamEnd end{begun_, result.outcome, result.ticks_hash, examinee_, {}};
  end.info.patient_source = io::absolute_source(begun_.patient_source);  // as the session has it
  return end;
}

/// Exams are sealed; every attempt is recorded and changes the next exercise.
void TrainerFlow::keep_result(const std::filesystem::path& session, const attempt::RunResult& result) {
  learning_->forget_result();
  results_->record_end(session);
  if (is_exam()) return learning_->seal(session, exam_end(result));
  learning_->refresh();
}

}  // namespace trocar::trainer
