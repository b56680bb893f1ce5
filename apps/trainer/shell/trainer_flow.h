#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <QVariantMap>
#include <filesystem>
#include <memory>
#include <optional>
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
#include "ui_kit/frame_count.h"

namespace trocar::trainer {

class AttemptControl;
class LearningControl;
class MainWindow;
class ReplayControl;
class ResultsControl;

/// Sequence of pages: start, open, briefing, puncture, feedback. Owns the data of case and attempt; polls background
/// work and draws the views once per frame.
class TrainerFlow : public QObject {
  Q_OBJECT

 public:
  TrainerFlow(MainWindow& window, std::filesystem::path state_folder, const database::DatabaseUrl& results);
  ~TrainerFlow() override;

  void go_to_start();
  void go_to_case_builder();
  void open(const TrainerChoice& choice);
  void begin_attempt();
  void try_again();
  void save_report();
  /// False while an attempt runs: the trainee must confirm, and the answer yes closes the window.
  bool may_close();
  void close();
  QVariantMap facts() const;
  /// Kills a haptic server, for scripts that test its loss.
  void end_server(const QString& tool);
  /// Restarts the recording of frame times and slow handlers.
  void reset_watch();
  void set_frame_rate(int most_hz);  ///< 1..60.

 private:
  void connect_pages();
  void connect_learning();
  void connect_results();
  void record_begin(const attempt::AttemptOptions& options, const exams::Examinee& person);
  /// Finds the body of an exam first.
  void start(const TrainerChoice& chosen);
  void keep_result(const std::filesystem::path& session, const attempt::RunResult& result);
  exams::ExamEnd exam_end(const attempt::RunResult& result) const;
  void frame();
  void poll_opening();
  void show_opened();
  void leave(std::shared_ptr<const cases::OpenCase> previous);
  void show_later();
  bool is_exam() const noexcept { return choice_.difficulty == Difficulty::kExam; }
  bool can_record();
  void poll_attempt();
  void report_recoveries(const attempt::AttemptView& view);
  void show_replay(Result<attempt::AttemptReplay> replay);
  void poll_replay();
  void load_replay(const std::filesystem::path& session);
  void recover();
  void measure_frame(double now_s);
  double now_s() const { return static_cast<double>(clock_.nsecsElapsed()) / 1e9; }

  MainWindow& window_;
  std::filesystem::path state_folder_;
  attempt::Journal journal_;
  TrainerChoice choice_;
  BackgroundJob<std::shared_ptr<const cases::OpenCase>> opening_;
  BackgroundJob<attempt::AttemptReplay> loading_;
  RetiredJobs retired_;
  devices::Speaker speaker_;
  std::vector<float> gun_click_ = devices::make_gun_click();
  std::optional<attempt::JournalEntry> offered_;   ///< Interrupted attempt, offered on the start page.
  std::optional<attempt::JournalEntry> cut_off_;   ///< Interrupted attempt being opened, to be scored and shown.
  std::shared_ptr<const cases::OpenCase> opened_;  ///< Case being shown, one part per frame; reset when complete.
  std::shared_ptr<const cases::OpenCase> open_;
  std::vector<std::shared_ptr<const cases::OpenCase>> left_;  ///< Previous cases whose threads still run.
  std::shared_ptr<const cases::LaterData> complete_;          ///< Display data whose errors were reported.
  std::shared_ptr<attempt::HapticServers> servers_;           ///< Kept from one attempt to the next.
  std::unique_ptr<AttemptControl> attempt_;
  std::unique_ptr<ReplayControl> replay_;
  std::unique_ptr<LearningControl> learning_;
  std::unique_ptr<ResultsControl> results_;
  std::filesystem::path shown_session_;  ///< Of the replay.
  bool is_close_confirmed_ = false;
  storage::SessionInfo begun_;         ///< What was known of the attempt when it began.
  exams::Examinee examinee_;           ///< Who practised then.
  int recoveries_ = 0;                 ///< Reported recoveries of the attempt's servers.
  std::string cut_short_;              ///< See RunResult; for the same attempt.
  std::vector<std::string> warnings_;  ///< Warnings of the attempt whose replay is being loaded.
  QTimer timer_;
  QElapsedTimer clock_;
  FrameCount frames_;
  std::vector<double> frame_ms_;  ///< Frames of attempt or replay since the last reset; kMostFrames at most.
  std::vector<double> scan_ms_;   ///< Computation times of ultrasound pictures since then; kMostFrames at most.
  std::uint64_t last_scan_ = 0;   ///< Number of the last of them.
  double watched_since_s_ = 0.0;
};

}  // namespace trocar::trainer
