// From a choice to an open case with its briefing.
#include "attempt/record/journal.h"
#include "control/learning_control.h"
#include "control/results_control.h"
#include "core/available_memory.h"
#include "core/files/file_system.h"
#include "io/patient/patient_cache.h"
#include "pages/briefing_page.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "panels/status_text.h"
#include "parameters/parameter_panel.h"
#include "shell/main_window.h"
#include "shell/trainer_flow.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "views/ultrasound/ultrasound_view.h"
#include "workspace/workspace.h"

namespace trocar::trainer {

cases::CaseChoice TrainerFlow::case_choice(const TrainerChoice& choice) {
  cases::CaseChoice result;
  // A patient of the case builder contains its own task.
  result.options.task = cases::has_own_task(choice.patient) ? std::string() : choice.task;
  result.options.needle = choice.needle;
  if (choice.mode != TrainingMode::kExam) result.options.breathing = choice.breathing;
  result.patient_source = choice.patient;
  result.patient_seed = choice.patient_seed;
  result.force_model = choice.force_model;
  return result;
}

void TrainerFlow::start(const TrainerChoice& chosen) {
  if (results_->is_signing_in())
    return window_.show_message(tr("Finish signing in first: enter the PIN, or press Cancel beside it."),
                                BannerKind::kWarning);
  TrainerChoice choice = chosen;
  choice.is_person_named = !results_->person_id().empty();
  if (!needs_exam_body(choice)) return open(choice);
  choice_ = choice;
  enter(FindingBody());
  window_.briefing().show_opening(choice);
  window_.show_page(QStringLiteral("briefing"));
  learning_->find_exam_body(choice);
}

void TrainerFlow::open(const TrainerChoice& choice, std::optional<attempt::JournalClaim> cut_off) {
  choice_ = choice;
  if (is_exam()) learning_->note_tables();
  enter(Opening{std::move(cut_off), {}, {}, false});
  window_.briefing().show_opening(choice);
  window_.show_page(QStringLiteral("briefing"));
}

void TrainerFlow::poll(Opening& opening) {
  if (opening.has_failed) return;
  if (opening.opened) return show_part(opening);
  if (!opening.job.has_work()) {
    // One at a time: a patient that is no longer wanted takes memory until its work has ended.
    if (retired_.sweep() > 0) return;
    opening.job = cases::open_case(case_choice(choice_), cases::OpenOptions{open_, io::patient_cache_folder()});
  }
  const JobView view = opening.job.view();
  auto result = opening.job.take();
  if (!result) {
    if (!view.is_done) window_.briefing().show_progress(shown(view.step), view.fraction);
    return;
  }
  if (!*result) {
    opening.has_failed = true;
    return window_.briefing().show_error(shown(result->error().text()));
  }
  opening.opened = **result;
  window_.work().workspace().begin_case(opening.opened);
}

void TrainerFlow::show_part(Opening& opening) {
  if (window_.work().workspace().show_part()) return;
  if (open_ == opening.opened) return show_opened(opening);
  leave(std::exchange(open_, opening.opened));
  window_.work().parameters().show_case(open_);
}

/// The briefing is last: it enables the start.
void TrainerFlow::show_opened(Opening& opening) {
  std::optional<attempt::JournalClaim> cut_off = std::move(opening.cut_off);
  enter(Briefed());        // ends `opening`
  release_freed_memory();  // memory of the previous case and of opening
  window_.work().workspace().show_help(choice_.mode);
  // An exam shows no target, whose depth this is.
  const double depth_mm = is_exam() ? open_->neutral.depth_mm : open_->probe_depth_mm;
  window_.work().ultrasound().change_settings([&](UltrasoundSettings& s) { s.acquisition.depth_mm = depth_mm; });
  window_.briefing().show_case(open_, choice_.mode);
  if (!cut_off) return;
  window_.briefing().show_progress(tr("Reading the recording"), 0.0);
  window_.briefing().set_hindrance(tr("The recording of the interrupted attempt is being read."));
  const std::filesystem::path session = cut_off->entry().session;
  load_replay({session, {}, {}, std::move(cut_off), {}});
}

/// The thread of a previous patient's pictures may need half a second to stop: the window does not wait for it.
void TrainerFlow::leave(Case previous) {
  if (!previous || previous->later == open_->later) return;
  previous->later->cancel();
  left_.push_back(std::move(previous));
}

/// Reports the preparation of the case's pictures on the briefing, and its errors once.
void TrainerFlow::show_later() {
  if (!open_ || in<Opening>() != nullptr || in<FindingBody>() != nullptr) return;
  window_.work().workspace().take_later_data();
  if (complete_ == open_->later) return;
  const JobView view = open_->later->view();
  if (in<Briefed>() != nullptr) window_.briefing().show_later(view.is_done ? QString() : shown(view.step));
  if (!view.is_done) return;
  complete_ = open_->later;
  release_freed_memory();
  for (const std::string& error : complete_->errors()) window_.show_message(shown(error), BannerKind::kWarning);
}

/// Begin is possible only where the attempt can be recorded.
void TrainerFlow::watch_disk() {
  constexpr double kEvery_s = 2.0;
  if (now_s() - disk_watched_s_ < kEvery_s) return;
  disk_watched_s_ = now_s();
  const bool was_hindered = window_.briefing().is_hindered();
  const Result<std::string> recording = check_recording();
  window_.briefing().set_hindrance(recording ? QString() : tr("Attempts cannot be recorded now."));
  if (!recording) window_.show_banner(sentence_of(recording.error()), BannerKind::kError);
  if (recording && was_hindered) window_.show_banner({});
}

/// Displays present and impending problems.
bool TrainerFlow::can_record() {
  const Result<std::string> recording = check_recording();
  if (!recording) window_.show_banner(sentence_of(recording.error()), BannerKind::kError);
  if (recording && !recording->empty()) window_.show_banner(shown(*recording));
  return recording.has_value();
}

/// Whether sessions can be written; the value is a warning, or empty.
Result<std::string> TrainerFlow::check_recording() const {
  const std::filesystem::path folder = state_folder_ / "sessions";
  if (Status made = make_writable_folder(folder); !made)
    return fail(to_std(tr("Cannot record attempts in %1: %2").arg(to_qt(folder.string()), shown(made.error().what))),
                {}, to_std(tr("start trocar-trainer with --state and a folder with write permission")));
  const attempt::RecordingSpace room(folder, find_free_bytes(folder));
  TROCAR_TRY_STATUS(room.check_start());
  return room.start_warning();
}

}  // namespace trocar::trainer
