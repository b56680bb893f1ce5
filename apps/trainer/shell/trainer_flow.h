#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <QVariantMap>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "attempt/live/live_attempt.h"
#include "attempt/record/attempt_replay.h"
#include "attempt/record/journal.h"
#include "cases/open_case.h"
#include "choice/trainer_choice.h"
#include "core/background_job.h"
#include "database/database_url.h"
#include "devices/pointer/speaker.h"
#include "exams/exam_seal.h"
#include "shell/frame_watch.h"

namespace trocar::trainer {

class AttemptControl;
class LearningControl;
class MainWindow;
class ReplayControl;
class ResultsControl;

/// Sequence of pages: start, briefing, puncture, feedback. It is in one state at a time, which owns what belongs to it
/// alone: leaving the state ends its work. Polls background work and draws the views once per frame.
class TrainerFlow : public QObject {
  Q_OBJECT

 public:
  TrainerFlow(MainWindow& window, std::filesystem::path state_folder, const database::DatabaseUrl& results);
  ~TrainerFlow() override;

  void go_to_start();
  void go_to_case_builder();
  void start(const TrainerChoice& choice);
  void begin_attempt();
  void try_again();
  void save_report();
  /// False while an attempt runs or a case is not saved: the user must confirm, and the answer yes closes the window.
  bool may_close();
  void close();
  QVariantMap facts() const;
  /// Kills a haptic server, for scripts that test its loss.
  void end_server(const QString& tool);
  /// Restarts the recording of frame times and slow handlers.
  void reset_watch();
  void set_frame_rate(int most_hz);  ///< 1..60.

 private:
  using Case = std::shared_ptr<const cases::OpenCase>;

  /// Start page or case builder.
  struct AtStart {};
  /// The body of an exam is being found.
  struct FindingBody {};
  /// A case is being opened, then shown in the views, one part a frame.
  struct Opening {
    std::optional<attempt::JournalClaim> cut_off;  ///< Interrupted attempt, whose replay follows.
    BackgroundJob<Case> job;                       ///< Starts when the work of the state before has ended.
    Case opened;                                   ///< Being shown.
    bool has_failed = false;
  };
  /// The case is open; the attempt may begin.
  struct Briefed {};
  struct Attempting {
    storage::SessionInfo begun;  ///< What was known of the attempt when it began.
    exams::Examinee examinee;    ///< Who practised then.
    std::unique_ptr<AttemptControl> control;
    int recoveries = 0;  ///< Reported recoveries of the attempt's servers.
  };
  /// The recording of an attempt is being read.
  struct LoadingReplay {
    std::filesystem::path session;
    std::string cut_short;                         ///< See RunResult.
    std::vector<std::string> warnings;             ///< Of the attempt.
    std::optional<attempt::JournalClaim> cut_off;  ///< Of an interrupted attempt.
    BackgroundJob<attempt::AttemptReplay> job;
  };
  struct Reviewing {
    std::filesystem::path session;
    std::unique_ptr<ReplayControl> control;
  };
  using State = std::variant<AtStart, FindingBody, Opening, Briefed, Attempting, LoadingReplay, Reviewing>;

  template <class S>
  S* in() noexcept {
    return std::get_if<S>(&state_);
  }
  template <class S>
  const S* in() const noexcept {
    return std::get_if<S>(&state_);
  }
  /// Leaves the state, whose work ends in the background, and sets the window for the next one.
  void enter(State next);
  void connect_pages();
  void connect_learning();
  void connect_results();
  void connect_parameters();
  void connect_attempt(AttemptControl& control);
  void offer_recovery();
  void recover();
  void open(const TrainerChoice& choice, std::optional<attempt::JournalClaim> cut_off = {});
  void poll(Opening& opening);
  void show_part(Opening& opening);
  void show_opened(Opening& opening);
  static cases::CaseChoice case_choice(const TrainerChoice& choice);
  void leave(Case previous);
  void show_later();
  void watch_disk();
  bool can_record();
  Result<std::string> check_recording() const;
  attempt::AttemptOptions attempt_options() const;
  void poll(Attempting& attempting);
  void end(Attempting attempting, Result<attempt::RunResult> result);
  exams::ExamEnd exam_end(const Attempting& attempting, const attempt::RunResult& result) const;
  void load_replay(LoadingReplay loading);
  void poll(LoadingReplay& loading);
  void show_replay(LoadingReplay loaded, Result<attempt::AttemptReplay> replay);
  void frame();
  void draw(double dt_s, double now_s);
  bool is_exam() const noexcept { return choice_.mode == TrainingMode::kExam; }
  double now_s() const { return static_cast<double>(clock_.nsecsElapsed()) / 1e9; }

  MainWindow& window_;
  std::filesystem::path state_folder_;
  attempt::Journal journal_;
  std::optional<attempt::JournalEntry> offered_;  ///< Interrupted attempt, offered on the start page.
  TrainerChoice choice_;                          ///< Of the case being opened or open.
  Case open_;                                     ///< The case in the views; kept, so that the same one opens at once.
  std::vector<Case> left_;                        ///< Previous cases whose threads still run.
  std::shared_ptr<const cases::LaterData> complete_;  ///< Display data whose errors were reported.
  std::shared_ptr<attempt::HapticServers> servers_;   ///< Kept from one attempt to the next.
  RetiredJobs retired_;
  State state_;
  std::unique_ptr<LearningControl> learning_;
  std::unique_ptr<ResultsControl> results_;
  devices::Speaker speaker_;
  std::vector<float> gun_click_ = devices::make_gun_click();
  bool is_close_confirmed_ = false;
  QTimer timer_;
  QElapsedTimer clock_;
  FrameWatch watch_;
  double disk_watched_s_ = -1.0;  ///< When the space for recordings was looked at last.
};

}  // namespace trocar::trainer
