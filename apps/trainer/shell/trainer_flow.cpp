#include "shell/trainer_flow.h"

#include <QDir>
#include <QFileDialog>
#include <QStandardPaths>
#include <algorithm>
#include <utility>

#include "attempt/record/session_case.h"
#include "cases/scene_request.h"
#include "control/attempt_control.h"
#include "control/learning_control.h"
#include "control/mirror_station.h"
#include "control/replay_control.h"
#include "control/results_control.h"
#include "core/available_memory.h"
#include "pages/briefing_page.h"
#include "pages/case_page.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "panels/feedback_panel.h"
#include "panels/status_strip.h"
#include "panels/status_text.h"
#include "parameters/force_preview.h"
#include "parameters/parameter_panel.h"
#include "report/html_report.h"
#include "shell/main_window.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "views/plots/time_line.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

constexpr int kFrame_ms = 16;
constexpr double kLong_s = 1e6;

}  // namespace

TrainerFlow::TrainerFlow(MainWindow& window, std::filesystem::path state_folder, const database::DatabaseUrl& results)
    : QObject(&window), window_(window), state_folder_(std::move(state_folder)), journal_(state_folder_) {
  learning_ = std::make_unique<LearningControl>(state_folder_, window_.start(), window_.work().feedback());
  results_ =
      std::make_unique<ResultsControl>(results, state_folder_ / "sessions", window_.start(), window_.work().feedback());
  connect_pages();
  connect_parameters();
  connect_learning();
  connect_results();
  offer_recovery();
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
    if (!offered_) return;
    if (auto claim = journal_.claim(*std::exchange(offered_, {}))) std::move(*claim).forget();
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
    if (auto* attempting = in<Attempting>()) attempting->control->toggle_forces();
  });
}

void TrainerFlow::connect_parameters() {
  ParameterPanel& parameters = window_.work().parameters();
  connect(&parameters, &ParameterPanel::parameters_changed, this, [this] {
    auto* attempting = in<Attempting>();
    if (attempting == nullptr || is_exam()) return;
    attempting->control->attempt().set_parameters(cases::tissue_parameters(window_.work().parameters().changes()));
  });
  connect(&parameters, &ParameterPanel::model_changed, this, [this](const QString& model) {
    auto* attempting = in<Attempting>();
    if (attempting != nullptr && !is_exam())
      attempting->control->attempt().set_parameters({.force_model = to_std(model)});
  });
}

void TrainerFlow::connect_learning() {
  connect(learning_.get(), &LearningControl::exam_progress, &window_.briefing(), &BriefingPage::show_progress);
  connect(learning_.get(), &LearningControl::exam_failed, &window_.briefing(), &BriefingPage::show_error);
  connect(learning_.get(), &LearningControl::exam_found, this, [this](const TrainerChoice& choice) { open(choice); });
}

void TrainerFlow::enter(State next) {
  State before = std::exchange(state_, std::move(next));
  if (auto* opening = std::get_if<Opening>(&before)) retired_.retire(std::move(opening->job));
  if (auto* loading = std::get_if<LoadingReplay>(&before)) retired_.retire(std::move(loading->job));
  disk_watched_s_ = -kLong_s;
  if (std::holds_alternative<FindingBody>(before)) learning_->cancel_exam_body();
  if (std::holds_alternative<Attempting>(before)) {
    window_.strip().show_forces(false, false);
    window_.strip().show_servers({});  // the servers wait for the next attempt; their status is outdated
  }
  // An interrupted exam can be replayed but not continued.
  const bool is_replay = std::holds_alternative<Reviewing>(state_) || std::holds_alternative<AtStart>(state_);
  window_.work().set_parameters_locked(is_exam() && !is_replay);
  results_->hold_person(!std::holds_alternative<AtStart>(state_));
}

void TrainerFlow::go_to_start() {
  enter(AtStart());
  window_.show_banner({});
  window_.show_page(QStringLiteral("start"));
  results_->refresh();
  offer_recovery();
  can_record();
  release_freed_memory();  // a replay holds every tick
}

void TrainerFlow::go_to_case_builder() {
  const QString is_scored = tr("The attempt is being scored. The case builder is available afterwards.");
  if (auto* attempting = in<Attempting>()) {
    const bool is_ending = attempting->control->view().phase == attempt::AttemptPhase::kFinishing;
    return attempting->control->show_notice(
        is_ending ? is_scored : tr("The case builder is not available during an attempt. End the attempt first (E)."));
  }
  if (in<LoadingReplay>() != nullptr) return window_.show_message(is_scored, BannerKind::kWarning);
  enter(AtStart());
  window_.show_page(QStringLiteral("case-builder"));
}

void TrainerFlow::offer_recovery() {
  offered_ = journal_.find_cut_off();
  window_.start().offer_recovery(
      offered_ ? tr("The last attempt was interrupted. Its recording is kept: you can score and replay it.")
               : QString());
}

/// Opens the case of the interrupted attempt; its replay follows when the case is open.
void TrainerFlow::recover() {
  if (!offered_) return;
  auto claim = journal_.claim(*std::exchange(offered_, {}));
  window_.start().offer_recovery({});
  if (!claim) return window_.show_message(tr("The attempt has been opened in another trainer."), BannerKind::kWarning);
  const cases::CaseChoice& cut_off = claim->entry().choice;
  TrainerChoice choice = window_.start().choice();
  choice.task = cut_off.options.task;
  choice.patient = cut_off.patient_source;
  choice.patient_seed = cut_off.patient_seed;
  choice.needle = cut_off.options.needle;
  choice.force_model = cut_off.force_model;
  open(choice, std::move(claim));
}

/// After an exam its body is known: another one is drawn.
void TrainerFlow::try_again() {
  if (!needs_exam_body(choice_)) {
    enter(Briefed());
    return begin_attempt();
  }
  TrainerChoice next = choice_;
  next.exam_number = 0;
  next.is_body_known = false;
  go_to_start();
  start(next);
}

void TrainerFlow::load_replay(LoadingReplay loading) {
  loading.job = BackgroundJob<attempt::AttemptReplay>([session = loading.session, open = open_](const Progress&) {
    return attempt::AttemptReplay::load(session, open);
  });
  enter(std::move(loading));
}

void TrainerFlow::poll(LoadingReplay& loading) {
  if (auto loaded = loading.job.take()) show_replay(std::move(loading), *std::move(loaded));
}

void TrainerFlow::show_replay(LoadingReplay loaded, Result<attempt::AttemptReplay> replay) {
  if (!replay) {
    enter(Briefed());
    window_.show_page(QStringLiteral("briefing"));
    window_.briefing().show_case(open_, choice_.mode);
    return window_.show_banner(sentence_of(replay.error()), BannerKind::kError);
  }
  window_.show_banner(shown(loaded.cut_short));
  if (std::string note = attempt::other_forces_note(replay->session().info); !note.empty())
    loaded.warnings.push_back(std::move(note));
  enter(Reviewing{loaded.session, std::make_unique<ReplayControl>(*std::move(replay), open_, window_.work(),
                                                                  std::move(loaded.warnings))});
  window_.work().feedback().show_again(needs_exam_body(choice_));
  window_.work().show_feedback();
  window_.show_page(QStringLiteral("feedback"));
  window_.work().time_line().setFocus();
  if (loaded.cut_off) std::move(*loaded.cut_off).forget();  // shown: it need not be offered again
}

void TrainerFlow::save_report() {
  auto* reviewing = in<Reviewing>();
  if (reviewing == nullptr) return;
  const QDir documents(QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation));
  const QString name = to_qt(report::report_file_of(reviewing->session.filename()).string());
  const QString file = QFileDialog::getSaveFileName(&window_, tr("Report of the attempt"), documents.filePath(name),
                                                    tr("Pages (*.html)"));
  if (file.isEmpty()) return;
  const Status status = reviewing->control->save_report(to_std(file));
  if (!status) return window_.show_banner(sentence_of(status.error()), BannerKind::kError);
  window_.show_message(tr("The report is in %1").arg(file), BannerKind::kSuccess);
}

void TrainerFlow::frame() {
  const double now = now_s();
  retired_.sweep();
  std::erase_if(left_, [](const auto& open) { return open->later->view().is_done; });
  show_later();
  learning_->poll();
  results_->poll();
  if (auto* opening = in<Opening>()) poll(*opening);
  if (auto* attempting = in<Attempting>()) poll(*attempting);
  if (auto* loading = in<LoadingReplay>()) poll(*loading);
  if (in<Briefed>() != nullptr) watch_disk();
  draw(watch_.since_last_s(now), now);
  const bool is_shown = in<Attempting>() != nullptr || in<Reviewing>() != nullptr;
  watch_.note_frame(now_s(), is_shown, in<Attempting>() != nullptr, window_.work(), window_.strip());
}

void TrainerFlow::draw(double dt_s, double now_s) {
  auto* attempting = in<Attempting>();
  auto* reviewing = in<Reviewing>();
  if (attempting != nullptr) attempting->control->advance(dt_s);
  if (reviewing != nullptr) reviewing->control->advance(dt_s);
  if (window_.page() == QLatin1String("case-builder")) window_.case_builder().advance();
  if (attempting == nullptr && reviewing == nullptr) return;
  window_.work().parameters().advance();
  const cases::Case& the_case = open_->the_case;
  window_.mirror().update_camera(window_.work().view_3d(),
                                 cases::room_in_patient(the_case.plan.line_P, the_case.needle.length_mm));
  window_.work().workspace().draw(now_s);
  if (attempting != nullptr) attempting->control->attempt().frame_drawn();
}

bool TrainerFlow::may_close() {
  if (is_close_confirmed_) return true;
  if (auto* attempting = in<Attempting>();
      attempting != nullptr && attempting->control->view().phase != attempt::AttemptPhase::kStarting) {
    attempting->control->ask_to_close();
    return false;
  }
  return window_.case_builder().may_discard(
      tr("Close the trainer? The case in the case builder is not saved and would be lost."));
}

void TrainerFlow::close() {
  timer_.stop();
  enter(AtStart());
  servers_.reset();
  if (open_) open_->later->cancel();
}

void TrainerFlow::end_server(const QString& tool) {
  if (auto* attempting = in<Attempting>()) attempting->control->end_server(tool);
}

}  // namespace trocar::trainer
