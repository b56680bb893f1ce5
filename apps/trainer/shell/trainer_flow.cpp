#include "shell/trainer_flow.h"

#include <QDateTime>
#include <QDir>
#include <QFileDialog>
#include <QStandardPaths>
#include <algorithm>

#include "attempt/record/other_forces.h"
#include "attempt/record/recording_space.h"
#include "cases/scene_request.h"
#include "control/attempt_control.h"
#include "control/learning_control.h"
#include "control/mirror_station.h"
#include "control/replay_control.h"
#include "control/results_control.h"
#include "core/available_memory.h"
#include "core/files/disk_space.h"
#include "io/patient/patient_cache.h"
#include "pages/briefing_page.h"
#include "pages/case_page.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "panels/feedback_panel.h"
#include "panels/puncture_panel.h"
#include "panels/status_strip.h"
#include "panels/status_text.h"
#include "parameters/force_preview.h"
#include "parameters/parameter_panel.h"
#include "report/html_report.h"
#include "shell/main_window.h"
#include "signing/token.h"
#include "ui_kit/parts.h"
#include "ui_kit/trainer_application.h"
#include "views/patient/patient_view.h"
#include "views/plots/time_line.h"
#include "views/ultrasound/ultrasound_view.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

constexpr int kFrame_ms = 16;
constexpr std::size_t kMostFrames = 200'000;  // an hour

cases::CaseChoice case_choice(const TrainerChoice& choice) {
  cases::CaseChoice result;
  // A patient of the case builder contains its own task.
  result.options.task = cases::has_own_task(choice.patient) ? std::string() : choice.task;
  result.options.needle = choice.needle;
  result.patient_source = choice.patient;
  result.patient_seed = choice.patient_seed;
  result.force_model = choice.force_model;
  return result;
}

}  // namespace

TrainerFlow::TrainerFlow(MainWindow& window, std::filesystem::path state_folder, const database::DatabaseUrl& results)
    : QObject(&window), window_(window), state_folder_(std::move(state_folder)), journal_(state_folder_) {
  learning_ = std::make_unique<LearningControl>(state_folder_, window_.start(), window_.work().feedback());
  results_ =
      std::make_unique<ResultsControl>(results, state_folder_ / "sessions", window_.start(), window_.work().feedback());
  connect_pages();
  connect_learning();
  connect_results();
  offered_ = journal_.find_cut_off();
  if (offered_)
    window_.start().offer_recovery(
        tr("The last attempt was interrupted. Its recording is kept: you can score and replay it."));
  can_record();
  clock_.start();
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kFrame_ms);
  timer_.setObjectName(QStringLiteral("frame-timer"));
  connect(&timer_, &QTimer::timeout, this, &TrainerFlow::frame);
  timer_.start();
}

TrainerFlow::~TrainerFlow() = default;

void TrainerFlow::set_frame_rate(int most_hz) {
  timer_.setInterval(std::max(kFrame_ms, 1000 / most_hz));
}

void TrainerFlow::connect_pages() {
  connect(&window_.start(), &StartPage::start_requested, this, &TrainerFlow::start);
  connect(&window_.start(), &StartPage::recovery_requested, this, &TrainerFlow::recover);
  connect(&window_.start(), &StartPage::recovery_declined, this, [this] {
    if (offered_) journal_.forget(*std::exchange(offered_, {}));
  });
  connect(&window_.briefing(), &BriefingPage::back_requested, this, &TrainerFlow::go_to_start);
  connect(&window_.briefing(), &BriefingPage::begin_requested, this, &TrainerFlow::begin_attempt);
  FeedbackPanel& feedback = window_.work().feedback();
  connect(&feedback, &FeedbackPanel::again_requested, this, &TrainerFlow::try_again);
  connect(&feedback, &FeedbackPanel::other_case_requested, this, &TrainerFlow::go_to_start);
  connect(&feedback, &FeedbackPanel::report_requested, this, &TrainerFlow::save_report);
  connect(&window_.case_builder(), &CasePage::case_saved, this, [this](const QString& folder) {
    window_.start().add_patient(folder);
    go_to_start();
  });
  connect(&window_.strip(), &StatusStrip::toggle_requested, this, [this] {
    if (attempt_) attempt_->toggle_forces();
  });
  ParameterPanel& parameters = window_.work().parameters();
  connect(&parameters, &ParameterPanel::parameters_changed, this, [this] {
    if (attempt_ && !is_exam())
      attempt_->attempt().set_parameters(cases::tissue_parameters(window_.work().parameters().changes()));
  });
  connect(&parameters, &ParameterPanel::model_changed, this, [this](const QString& model) {
    if (attempt_ && !is_exam()) attempt_->attempt().set_parameters({.force_model = to_std(model)});
  });
}

void TrainerFlow::connect_learning() {
  connect(learning_.get(), &LearningControl::exam_progress, &window_.briefing(), &BriefingPage::show_progress);
  connect(learning_.get(), &LearningControl::exam_failed, &window_.briefing(), &BriefingPage::show_error);
  connect(learning_.get(), &LearningControl::exam_found, this, &TrainerFlow::open);
}

void TrainerFlow::go_to_start() {
  learning_->cancel_exam_body();
  retired_.retire(std::exchange(opening_, {}));
  opened_.reset();
  attempt_.reset();
  replay_.reset();
  window_.strip().show_forces(false, false);
  window_.strip().show_servers({});
  window_.work().set_parameters_locked(false);
  window_.show_banner({});
  window_.show_page(QStringLiteral("start"));
  results_->refresh();
  can_record();
  release_freed_memory();  // a replay holds every tick
}

void TrainerFlow::go_to_case_builder() {
  const QString is_scored = tr("The attempt is being scored. The case builder is available afterwards.");
  if (attempt_) {
    const bool is_ending = attempt_->view().phase == attempt::AttemptPhase::kFinishing;
    return attempt_->show_notice(
        is_ending ? is_scored : tr("The case builder is not available during an attempt. End the attempt first (E)."));
  }
  if (loading_.has_work()) return window_.show_message(is_scored, BannerKind::kWarning);
  window_.show_page(QStringLiteral("case-builder"));
}

void TrainerFlow::start(const TrainerChoice& chosen) {
  TrainerChoice choice = chosen;
  choice.is_person_named = !results_->person_id().empty();
  if (!needs_exam_body(choice)) return open(choice);
  choice_ = choice;
  window_.work().set_parameters_locked(true);
  window_.briefing().show_opening(choice);
  window_.show_page(QStringLiteral("briefing"));
  learning_->find_exam_body(choice);
}

void TrainerFlow::open(const TrainerChoice& choice) {
  choice_ = choice;
  // An interrupted exam can be replayed but not continued.
  window_.work().set_parameters_locked(is_exam() && !cut_off_);
  opened_.reset();
  if (is_exam()) learning_->note_tables();
  retired_.retire(std::exchange(
      opening_, cases::open_case(case_choice(choice), cases::OpenOptions{open_, io::patient_cache_folder()})));
  window_.briefing().show_opening(choice);
  window_.show_page(QStringLiteral("briefing"));
}

void TrainerFlow::poll_opening() {
  if (!opening_.has_work()) return;
  const JobView view = opening_.view();
  auto result = opening_.take();
  if (!result) {
    if (!view.is_done) window_.briefing().show_progress(to_qt(view.step), view.fraction);
    return;
  }
  opening_ = {};
  if (!*result) return window_.briefing().show_error(to_qt(result->error().text()));
  opened_ = **result;
  window_.work().workspace().begin_case(opened_);
}

/// The thread of a previous patient's pictures may need a second to stop: the window does not wait for it.
void TrainerFlow::leave(std::shared_ptr<const cases::OpenCase> previous) {
  if (!previous || previous->later == open_->later) return;
  previous->later->cancel();
  left_.push_back(std::move(previous));
}

/// Reports the preparation of the case's pictures on the briefing, and its errors once.
void TrainerFlow::show_later() {
  if (!open_ || opened_ || opening_.has_work() || learning_->is_finding_body()) return;
  window_.work().workspace().take_later_data();
  if (complete_ == open_->later) return;
  const JobView view = open_->later->view();
  window_.briefing().show_later(view.is_done ? QString() : to_qt(view.step));
  if (!view.is_done) return;
  complete_ = open_->later;
  release_freed_memory();
  for (const std::string& error : complete_->errors()) window_.show_message(to_qt(error), BannerKind::kWarning);
}

/// The briefing is last: it enables the start.
void TrainerFlow::show_opened() {
  if (!opened_) return;
  if (window_.work().workspace().show_part()) return;
  if (open_ != opened_) {
    leave(std::exchange(open_, opened_));
    window_.work().parameters().show_case(open_);
    return;
  }
  opened_.reset();
  release_freed_memory();  // memory of the previous case and of opening
  window_.work().workspace().show_help(choice_.difficulty);
  // The depth of the target belongs to the plan, too.
  const bool is_guided = choice_.difficulty == Difficulty::kGuided;
  const double depth_mm = is_guided ? open_->probe_depth_mm : open_->neutral.depth_mm;
  window_.work().ultrasound().change_settings([&](UltrasoundSettings& s) { s.acquisition.depth_mm = depth_mm; });
  window_.briefing().show_case(open_, choice_.difficulty);
  if (cut_off_) load_replay(std::exchange(cut_off_, {})->session);
}

/// Checks if sessions can be written; displays present and impending problems.
bool TrainerFlow::can_record() {
  const std::filesystem::path folder = state_folder_ / "sessions";
  if (const Status made = make_writable_folder(folder); !made) {
    window_.show_banner(
        tr("Cannot record attempts in %1: %2. Start trocar-trainer with --state and a folder with write permission.")
            .arg(to_qt(folder.string()), to_qt(made.error().what)),
        BannerKind::kError);
    return false;
  }
  const attempt::RecordingSpace room(folder, find_free_bytes(folder));
  const Status start = room.check_start();
  if (!start) window_.show_banner(sentence_of(start.error()), BannerKind::kError);
  if (start && !room.start_warning().empty()) window_.show_banner(to_qt(room.start_warning()));
  return start.has_value();
}

void TrainerFlow::begin_attempt() {
  if (!open_ || !can_record()) return;
  attempt::AttemptOptions options;
  const QString name = QDateTime::currentDateTime().toString(QStringLiteral("yyyy-MM-dd_HH-mm-ss-zzz"));
  options.session = state_folder_ / "sessions" / to_std(name + QStringLiteral(".trocar"));
  options.device_needle = choice_.needle_device;
  options.device_probe = choice_.probe_device;
  options.level = name_of(choice_.difficulty);
  if (!is_exam()) options.force_model = to_std(window_.work().parameters().preview().model());
  options.is_guided = choice_.difficulty != Difficulty::kExam;
  options.person_id = results_->person_id();
  options.attempt_id = signing::make_id();
  // Finding the target is a part of the task, and the start of the plan would reveal it.
  options.X_PN_start = open_->neutral.X_PN;
  options.X_PT_start = open_->neutral.X_PT;
  if (const Status kept = journal_.begin({case_choice(choice_), options.session}); !kept)
    return window_.show_banner(sentence_of(kept.error()), BannerKind::kError);
  record_begin(options, {results_->person_id(), results_->person_name(), results_->has_person_given_pin()});
  replay_.reset();
  recoveries_ = 0;
  window_.work().set_parameters_locked(is_exam());
  window_.work().show_puncture();
  window_.show_page(QStringLiteral("puncture"));
  frames_.restart();
  attempt_ = std::make_unique<AttemptControl>(open_, choice_, std::move(options), servers_, window_.work());
  connect(
      attempt_.get(), &AttemptControl::close_confirmed, this,
      [this] {
        is_close_confirmed_ = true;
        window_.close();
      },
      Qt::QueuedConnection);
  connect(attempt_.get(), &AttemptControl::gun_fired, this, [this] {
    if (window_.has_sound()) speaker_.play(gun_click_);
  });
  if (const auto changes = window_.work().parameters().changes(); !changes.empty() && !is_exam())
    attempt_->attempt().set_parameters(cases::tissue_parameters(changes));
}

/// After an exam its body is known: another one is drawn.
void TrainerFlow::try_again() {
  attempt_.reset();
  if (!needs_exam_body(choice_)) return begin_attempt();
  TrainerChoice next = choice_;
  next.exam_number = 0;
  next.is_body_known = false;
  go_to_start();
  start(next);
}

void TrainerFlow::poll_attempt() {
  if (!attempt_) return;
  const attempt::AttemptView& view = attempt_->view();
  const bool is_bad = view.is_harm || view.phase == attempt::AttemptPhase::kFailed;
  window_.show_banner(to_qt(view.banner), is_bad ? BannerKind::kError : BannerKind::kWarning);
  report_recoveries(view);
  std::vector<ServerLine> servers{line_of(view.servers[0], tr("Needle"))};
  if (view.has_probe) servers.push_back(line_of(view.servers[1], tr("Transducer")));
  window_.strip().show_servers(servers);
  window_.strip().show_forces(view.phase != attempt::AttemptPhase::kFinishing, view.are_forces_stopped);
  auto result = attempt_->attempt().take_result();
  if (!result) return;
  const std::filesystem::path session = attempt_->attempt().session_path();
  servers_ = attempt_->attempt().servers();
  attempt_.reset();
  window_.strip().show_forces(false, false);
  window_.strip().show_servers({});  // the servers wait for the next attempt; their status is outdated
  window_.show_banner({});
  journal_.clear();
  if (!*result) {
    results_->record_end(session);
    window_.strip().show_servers({});
    window_.show_banner(sentence_of(result->error()) + tr(" Press Begin to try again, or Back for the start page."),
                        BannerKind::kError);
    return window_.show_page(QStringLiteral("briefing"));
  }
  keep_result(session, **result);
  warnings_ = (*result)->warnings;
  cut_short_ = (*result)->cut_short;
  shown_session_ = session;
  if ((*result)->unsaved) {
    show_replay(attempt::AttemptReplay::of(*std::move((*result)->unsaved), open_));
  } else {
    load_replay(session);
  }
}

void TrainerFlow::report_recoveries(const attempt::AttemptView& view) {
  if (view.recoveries == recoveries_) return;
  recoveries_ = view.recoveries;
  window_.show_message(to_qt(view.recovered), BannerKind::kSuccess);
}

void TrainerFlow::load_replay(const std::filesystem::path& session) {
  shown_session_ = session;
  loading_ = BackgroundJob<attempt::AttemptReplay>(
      [session, open = open_](const Progress&) { return attempt::AttemptReplay::load(session, open); });
}

void TrainerFlow::poll_replay() {
  auto loaded = loading_.take();
  if (!loaded) return;
  loading_ = {};
  show_replay(*std::move(loaded));
}

void TrainerFlow::show_replay(Result<attempt::AttemptReplay> replay) {
  if (!replay) return window_.show_banner(sentence_of(replay.error()), BannerKind::kError);
  window_.show_banner(to_qt(std::exchange(cut_short_, {})));
  if (std::string note = attempt::other_forces_note(replay->session().info); !note.empty())
    warnings_.push_back(std::move(note));
  replay_ = std::make_unique<ReplayControl>(*std::move(replay), open_, window_.work(), std::exchange(warnings_, {}));
  window_.work().set_parameters_locked(false);
  window_.work().feedback().show_again(needs_exam_body(choice_));
  window_.work().show_feedback();
  window_.show_page(QStringLiteral("feedback"));
  window_.work().time_line().setFocus();
}

/// Opens the case of the interrupted attempt; its replay follows when the case is open.
void TrainerFlow::recover() {
  window_.start().offer_recovery({});
  if (!offered_) return;
  cut_off_ = std::exchange(offered_, {});
  if (!journal_.forget(*cut_off_)) {
    cut_off_.reset();
    return window_.show_message(tr("The attempt has been opened in another trainer."), BannerKind::kWarning);
  }
  TrainerChoice choice = window_.start().choice();
  choice.task = cut_off_->choice.options.task;
  choice.patient = cut_off_->choice.patient_source;
  choice.patient_seed = cut_off_->choice.patient_seed;
  choice.needle = cut_off_->choice.options.needle;
  choice.force_model = cut_off_->choice.force_model;
  open(choice);
}

void TrainerFlow::save_report() {
  if (!replay_) return;
  const QDir documents(QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation));
  const QString name = to_qt(report::report_file_of(shown_session_.filename()).string());
  const QString file = QFileDialog::getSaveFileName(&window_, tr("Report of the attempt"), documents.filePath(name),
                                                    tr("Pages (*.html)"));
  if (file.isEmpty()) return;
  const Status status = replay_->save_report(to_std(file));
  if (!status) return window_.show_banner(sentence_of(status.error()), BannerKind::kError);
  window_.show_message(tr("The report is in %1").arg(file), BannerKind::kSuccess);
}

void TrainerFlow::frame() {
  const double now = now_s();
  retired_.sweep();
  std::erase_if(left_, [](const auto& open) { return open->later->view().is_done; });
  show_opened();
  show_later();
  poll_opening();
  learning_->poll();
  results_->poll();
  poll_attempt();
  poll_replay();
  const double dt_s = frames_.since_last_s(now);
  if (attempt_) attempt_->advance(dt_s);
  if (replay_) replay_->advance(dt_s);
  if (window_.page() == QLatin1String("case-builder")) window_.case_builder().advance();
  if (attempt_ || replay_) {
    window_.work().parameters().advance();
    const cases::Case& the_case = open_->the_case;
    window_.mirror().update_camera(window_.work().view_3d(),
                                   cases::room_in_patient(the_case.plan.line_P, the_case.needle.length_mm));
    window_.work().workspace().draw(now);
  }
  if (attempt_) attempt_->attempt().frame_drawn();
  measure_frame(now_s());
}

void TrainerFlow::measure_frame(double now) {
  const double frame_s = frames_.since_last_s(now);
  if (frame_s > 0.0 && (attempt_ || replay_) && frame_ms_.size() < kMostFrames) frame_ms_.push_back(1e3 * frame_s);
  const auto picture = window_.work().ultrasound().picture();
  if (picture && std::exchange(last_scan_, picture->number) != picture->number && scan_ms_.size() < kMostFrames)
    scan_ms_.push_back(picture->took_ms);
  frames_.add(now, attempt_ != nullptr);
  if (const auto figures = frames_.figures()) window_.strip().show_frames(*figures);
}

bool TrainerFlow::may_close() {
  if (!attempt_ || is_close_confirmed_ || attempt_->view().phase == attempt::AttemptPhase::kStarting) return true;
  attempt_->ask_to_close();
  return false;
}

void TrainerFlow::close() {
  timer_.stop();
  attempt_.reset();
  replay_.reset();
  servers_.reset();
  retired_.retire(std::exchange(opening_, {}));
  if (open_) open_->later->cancel();
}

void TrainerFlow::end_server(const QString& tool) {
  if (attempt_) attempt_->end_server(tool);
}

}  // namespace trocar::trainer
