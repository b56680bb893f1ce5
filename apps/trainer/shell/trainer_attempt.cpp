// From the first to the last moment of an attempt, and what is recorded of it.
#include <QDateTime>

#include "cases/scene_request.h"
#include "control/attempt_control.h"
#include "control/learning_control.h"
#include "control/results_control.h"
#include "core/version.h"
#include "io/patient/patient_folder.h"
#include "pages/briefing_page.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "panels/puncture_panel.h"
#include "panels/status_strip.h"
#include "panels/status_text.h"
#include "parameters/force_preview.h"
#include "parameters/parameter_panel.h"
#include "shell/main_window.h"
#include "shell/trainer_flow.h"
#include "signing/token.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {

void TrainerFlow::connect_results() {
  connect(results_.get(), &ResultsControl::history_changed, this,
          [this] { learning_->follow(results_->url(), results_->person_id()); });
  connect(results_.get(), &ResultsControl::warned, this,
          [this](const QString& text) { window_.show_message(text, BannerKind::kWarning); });
}

attempt::AttemptOptions TrainerFlow::attempt_options() const {
  attempt::AttemptOptions options;
  const QString name = QDateTime::currentDateTime().toString(QStringLiteral("yyyy-MM-dd_HH-mm-ss-zzz"));
  options.session = state_folder_ / "sessions" / to_std(name + QStringLiteral(".trocar"));
  options.device_needle = choice_.needle_device;
  options.device_probe = choice_.probe_device;
  options.level = name_of(choice_.mode);
  if (!is_exam()) options.force_model = to_std(window_.work().parameters().preview().model());
  options.is_guided = !is_exam();
  if (!choice_.is_tutorial) options.person_id = results_->person_id();
  options.attempt_id = signing::make_id();
  options.operator_name = "trainee";
  options.patient_source = open_->choice.patient_source;
  options.patient_seed = open_->choice.patient_seed;
  // Finding the target is a part of the task, and the start of the plan would reveal it.
  options.X_PN_start = open_->neutral.X_PN;
  options.X_PT_start = open_->neutral.X_PT;
  return options;
}

void TrainerFlow::begin_attempt() {
  if (in<Briefed>() == nullptr || !can_record()) return;
  attempt::AttemptOptions options = attempt_options();
  if (const Status kept = journal_.begin({case_choice(choice_), options.session}); !kept)
    return window_.show_banner(sentence_of(kept.error()), BannerKind::kError);
  Attempting attempting;
  attempting.begun = attempt::identify(open_->the_case, options);
  attempting.examinee = {results_->person_id(), results_->person_name(), results_->has_person_given_pin()};
  if (!choice_.is_tutorial) results_->record_begin(attempting.begun);
  window_.work().show_puncture();
  window_.show_page(QStringLiteral("puncture"));
  watch_.restart();
  attempting.control = std::make_unique<AttemptControl>(open_, choice_, std::move(options), servers_, window_.work());
  connect_attempt(*attempting.control);
  if (const auto changes = window_.work().parameters().changes(); !changes.empty() && !is_exam())
    attempting.control->attempt().set_parameters(cases::tissue_parameters(changes));
  enter(std::move(attempting));
}

void TrainerFlow::connect_attempt(AttemptControl& control) {
  connect(
      &control, &AttemptControl::close_confirmed, this,
      [this] {
        is_close_confirmed_ = true;
        window_.close();
      },
      Qt::QueuedConnection);
  connect(&control, &AttemptControl::gun_fired, this, [this] {
    if (window_.has_sound()) speaker_.play(gun_click_);
  });
}

void TrainerFlow::poll(Attempting& attempting) {
  const attempt::AttemptView& view = attempting.control->view();
  const bool is_bad = view.is_harm || view.phase == attempt::AttemptPhase::kFailed;
  window_.show_banner(shown(view.banner), is_bad ? BannerKind::kError : BannerKind::kWarning);
  if (view.recoveries != attempting.recoveries) window_.show_message(shown(view.recovered), BannerKind::kSuccess);
  attempting.recoveries = view.recoveries;
  std::vector<ServerLine> servers{line_of(view.servers[0], tr("Needle"))};
  if (view.has_probe) servers.push_back(line_of(view.servers[1], tr("Transducer")));
  window_.strip().show_servers(servers);
  window_.strip().show_forces(view.phase != attempt::AttemptPhase::kFinishing, view.are_forces_stopped);
  if (auto result = attempting.control->attempt().take_result()) end(std::move(attempting), *std::move(result));
}

/// Exams are sealed; every attempt is recorded and changes the next exercise.
void TrainerFlow::end(Attempting attempting, Result<attempt::RunResult> result) {
  const std::filesystem::path session = attempting.control->attempt().session_path();
  servers_ = attempting.control->attempt().servers();
  attempting.control.reset();
  enter(Briefed());
  window_.show_banner({});
  journal_.clear();
  if (!choice_.is_tutorial) results_->record_end(session, attempting.begun);
  if (!result) {
    window_.show_banner(sentence_of(result.error()) + tr(" Press Begin to try again, or Back for the start page."),
                        BannerKind::kError);
    return window_.show_page(QStringLiteral("briefing"));
  }
  if (choice_.is_tutorial) window_.start().note_first_steps();
  learning_->forget_result();
  is_exam() ? learning_->seal(session, exam_end(attempting, *result)) : learning_->refresh();
  LoadingReplay loading{session, std::move(result->cut_short), std::move(result->warnings), {}, {}};
  if (result->unsaved)
    return show_replay(std::move(loading), attempt::AttemptReplay::of(*std::move(result->unsaved), open_));
  load_replay(std::move(loading));
}

exams::ExamEnd TrainerFlow::exam_end(const Attempting& attempting, const attempt::RunResult& result) const {
  return {attempting.begun, result.outcome, result.ticks_hash, attempting.examinee, {}};
}

}  // namespace trocar::trainer
