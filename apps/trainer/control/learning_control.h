#pragma once

#include <QObject>
#include <filesystem>
#include <functional>
#include <memory>

#include "choice/trainer_choice.h"
#include "core/background_job.h"
#include "database/database_url.h"
#include "exams/exam_body.h"
#include "exams/exam_seal.h"
#include "learning/next_exercise.h"

namespace trocar::trainer {

class FeedbackPanel;
class StartPage;

/// The learning path of who practises (else of this station's sessions), the bodies of its exams and their signed
/// results. Work runs in the background; poll() shows what is ready.
class LearningControl : public QObject {
  Q_OBJECT

 public:
  LearningControl(std::filesystem::path state_folder, StartPage& start, FeedbackPanel& feedback,
                  QObject* parent = nullptr);
  ~LearningControl() override;

  /// Whose attempts count: those of a person in a database, or (empty id) those of the station's folder. Then
  /// refreshes.
  void follow(const database::DatabaseUrl& url, const std::string& person_id);
  /// Reads the attempts anew.
  void refresh();
  /// Finds the body of an exam; exam_found or exam_failed follows, exam_progress before.
  void find_exam_body(const TrainerChoice& choice);
  void cancel_exam_body();
  /// Call when a case is opened: an exam is sealed only if the data tables have not changed since.
  void note_tables();
  /// Seals the session of an exam that has just ended and makes its result, then refreshes. `end` is what this program
  /// has recorded; its tables are those noted.
  void seal(const std::filesystem::path& session, exams::ExamEnd end);
  /// Clears the result of the last exam on the feedback page.
  void forget_result();
  void poll();

  bool is_finding_body() const noexcept { return draw_ || drawing_.has_work(); }
  const QString& next_title() const noexcept { return next_title_; }    ///< Empty: none, or not yet.
  const QString& result_file() const noexcept { return result_file_; }  ///< Of the last exam; empty: none.

 Q_SIGNALS:
  void exam_progress(const QString& step, double fraction);
  void exam_found(const trocar::trainer::TrainerChoice& choice);
  void exam_failed(const QString& error);

 private:
  struct Advice {
    learning::Recommendation next;
    std::string title;  ///< Empty: no exercise.
  };
  void show(const Advice& advice);
  void poll_body();
  void poll_signature();

  std::filesystem::path state_folder_;
  database::DatabaseUrl url_;
  std::string person_id_;  ///< Empty: the attempts of the station count.
  StartPage& start_;
  FeedbackPanel& feedback_;
  BackgroundJob<Advice> advising_;
  std::function<BackgroundJob<exams::ExamBody>()> draw_;  ///< Starts drawing_ when the former one has ended.
  BackgroundJob<exams::ExamBody> drawing_;
  BackgroundJob<std::filesystem::path> signing_;
  RetiredJobs retired_;
  TrainerChoice exam_;                               ///< The choice whose body is being found.
  Result<std::string> data_sha256_ = std::string();  ///< When the case was opened.
  QString next_title_, result_file_;
};

}  // namespace trocar::trainer
