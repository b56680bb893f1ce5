#pragma once

#include <QObject>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/background_job.h"
#include "results/people.h"
#include "results/proficiency.h"
#include "storage/session_file.h"

namespace trocar::trainer {

class FeedbackPanel;
class PersonBar;
class StartPage;

/// Who practises, and the results of that person in the database of the station or the department. Work runs in the
/// background, one step after the other; poll() shows what is ready. Where the database cannot be reached, the session
/// files stay on the station and are recorded when it can be reached again.
class ResultsControl : public QObject {
  Q_OBJECT

 public:
  ResultsControl(database::DatabaseUrl url, std::filesystem::path sessions_folder, StartPage& start,
                 FeedbackPanel& feedback, QObject* parent = nullptr);
  ~ResultsControl() override;

  const database::DatabaseUrl& url() const noexcept { return url_; }
  /// Empty: nobody practises, nothing is recorded.
  std::string person_id() const { return person_ ? person_->id : std::string(); }
  std::string person_name() const { return person_ ? person_->name : std::string(); }
  /// True if the person has a PIN: it was entered before the person could practise.
  bool has_person_given_pin() const noexcept { return person_ && person_->has_pin; }
  /// A name or a PIN is being entered or checked.
  bool is_signing_in() const;
  /// While it is held, the person does not change: an attempt belongs to who began it.
  void hold_person(bool is_held);
  /// Records sessions that are left on the station, then reads people and history anew.
  void refresh();
  /// Writes that an attempt has begun, and its result when it has ended; one that recorded nothing is forgotten.
  void record_begin(const storage::SessionInfo& info);
  void record_end(const std::filesystem::path& session, const storage::SessionInfo& begun);
  void poll();
  bool has_work() const noexcept { return working_.has_work() || !waiting_.empty(); }

 Q_SIGNALS:
  /// Another person practises, or the person's attempts have changed.
  void history_changed();
  void warned(const QString& text);

 private:
  using Curves = std::map<std::string, results::LearningCurve>;
  /// What a step of work has found; empty members do not change what is shown.
  struct Found {
    std::optional<std::vector<results::Person>> people;
    bool are_pins_required = false;
    std::optional<results::Person> person;  ///< Who practises from now on.
    std::string read_for;                   ///< Id of the person whose curves were read; empty: nobody's.
    std::optional<Curves> curves;           ///< Of that person, by task; empty: the person is deleted.
    Error refusal;                          ///< For the start page: a wrong PIN, a name that is taken; empty: none.
    std::string warning;                    ///< In the window, once: how the database is kept.
    bool has_recorded = false;              ///< An attempt was recorded.
  };
  using Work = std::function<Result<Found>(const database::DatabaseUrl&)>;

  void enqueue(Work work);
  void choose(const QString& id);
  void check_pin(const QString& pin);
  void add_person(const QString& name, const QString& pin);
  void practise_as(std::optional<results::Person> person);
  void take(Found found);
  void show_people();
  void show_history();
  Work reading_of(const std::optional<results::Person>& person) const;
  static Result<Curves> read_curves(results::Repository& repository, const results::Person& person);

  database::DatabaseUrl url_;
  std::filesystem::path sessions_folder_;
  StartPage& start_;
  FeedbackPanel& feedback_;
  std::vector<results::Person> people_;
  bool are_pins_required_ = false;
  std::optional<results::Person> person_;
  std::optional<results::Person> asked_;  ///< Whose PIN is being entered.
  bool has_entry_ = false;                ///< What was entered is being checked.
  bool is_held_ = false;
  bool has_warned_ = false;  ///< Of how the database is kept.
  Curves curves_;
  std::string task_;           ///< Of the attempt that has begun.
  std::string recorded_task_;  ///< Of the attempt that the feedback compares; empty: none.
  BackgroundJob<Found> working_;
  std::deque<Work> waiting_;
};

}  // namespace trocar::trainer
