#include "control/results_control.h"

#include <QSettings>
#include <algorithm>
#include <chrono>
#include <utility>

#include "core/files/folders.h"
#include "pages/history_card.h"
#include "pages/person_bar.h"
#include "pages/start_page.h"
#include "panels/feedback_panel.h"
#include "panels/status_text.h"
#include "results/sessions.h"
#include "signing/password.h"
#include "tasks/task.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr const char* kLastPerson = "start/person";

results::Seconds now_s() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

PersonEntry entry_of(const results::Person& person) {
  return {to_qt(person.id), to_qt(person.name), to_qt(person.course), person.has_pin};
}

Result<learning::Curriculum> curriculum() {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  return learning::load_curriculum(data);
}

/// A database that nobody has used yet is no error: there are no people.
bool is_missing(const database::DatabaseUrl& url) {
  std::error_code error;
  return url.is_sqlite() && !std::filesystem::exists(url.file, error);
}

}  // namespace

ResultsControl::ResultsControl(database::DatabaseUrl url, std::filesystem::path sessions_folder, StartPage& start,
                               FeedbackPanel& feedback, QObject* parent)
    : QObject(parent),
      url_(std::move(url)),
      sessions_folder_(std::move(sessions_folder)),
      start_(start),
      feedback_(feedback) {
  PersonBar& bar = start_.person();
  connect(&bar, &PersonBar::person_requested, this, &ResultsControl::choose);
  connect(&bar, &PersonBar::pin_entered, this, &ResultsControl::check_pin);
  connect(&bar, &PersonBar::new_person_entered, this, &ResultsControl::add_person);
  connect(&bar, &PersonBar::entry_cancelled, this, [this] {
    asked_.reset();
    start_.person().show_message({});
  });
  connect(&start_, &StartPage::task_changed, this, &ResultsControl::show_history);
  refresh();
}

ResultsControl::~ResultsControl() = default;

Result<ResultsControl::Curves> ResultsControl::read_curves(results::Repository& repository,
                                                           const results::Person& person) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const std::vector<tasks::Task> all, tasks::load_tasks(data / "tasks"));
  Curves curves;
  for (const tasks::Task& task : all) {
    TROCAR_TRY(curves[task.name], results::learning_curve(repository, person, task.name));
  }
  return curves;
}

/// Reads all people, and the curves of one.
ResultsControl::Work ResultsControl::reading_of(const std::optional<results::Person>& person) const {
  return [person](const database::DatabaseUrl& url) -> Result<Found> {
    Found found;
    found.people.emplace();
    if (is_missing(url)) return found;
    TROCAR_TRY(results::Repository repository, results::Repository::open(url, database::Missing::kRefuse));
    found.warning = repository.database().note();
    TROCAR_TRY(found.people, results::list_people(repository));
    TROCAR_TRY(found.are_pins_required, results::are_pins_required(repository));
    if (!person) return found;
    found.read_for = person->id;
    TROCAR_TRY(const auto known, results::find_person(repository, person->id));
    if (known) {
      TROCAR_TRY(found.curves, read_curves(repository, *known));
    }
    return found;
  };
}

void ResultsControl::refresh() {
  enqueue([folder = sessions_folder_](const database::DatabaseUrl& url) -> Result<Found> {
    if (is_missing(url)) return Found();
    TROCAR_TRY(results::Repository repository, results::Repository::open(url, database::Missing::kRefuse));
    TROCAR_TRY(const learning::Curriculum known, curriculum());
    TROCAR_TRY(const results::Imported imported, results::import_left_sessions(repository, folder, known));
    Found found;
    found.has_recorded = imported.added > 0;
    return found;
  });
  enqueue(reading_of(person_));
}

void ResultsControl::choose(const QString& id) {
  asked_.reset();
  start_.person().show_message({});
  const auto found =
      std::ranges::find_if(people_, [&](const results::Person& person) { return to_qt(person.id) == id; });
  if (found == people_.end()) return practise_as({});
  if (!found->has_pin && !are_pins_required_) return practise_as(*found);
  asked_ = *found;
  start_.person().ask_for_pin(entry_of(*found), !found->has_pin);
}

void ResultsControl::check_pin(const QString& pin) {
  if (!asked_ || std::exchange(has_entry_, true)) return;
  enqueue([person = *asked_, pin = to_std(pin)](const database::DatabaseUrl& url) -> Result<Found> {
    TROCAR_TRY(results::Repository repository, results::Repository::open(url, database::Missing::kRefuse));
    Found found;
    if (!person.has_pin) {
      // Everybody has to have one: the first who practises under the name chooses it.
      if (const Status set = results::set_pin(repository, person.id, pin); !set) {
        found.refusal = set.error();
        return found;
      }
      found.person = person;
      found.person->has_pin = true;
      return found;
    }
    TROCAR_TRY(const results::PinCheck check, results::check_pin(repository, person.id, pin, now_s()));
    if (check == results::PinCheck::kRight) found.person = person;
    if (check == results::PinCheck::kWrong) found.refusal.what = "The PIN is wrong.";
    if (check == results::PinCheck::kTooManyTries)
      found.refusal.what = "Too many wrong PINs: wait, or ask your instructor.";
    return found;
  });
}

void ResultsControl::add_person(const QString& name, const QString& pin) {
  if (are_pins_required_ && pin.isEmpty()) return start_.person().show_message(tr("Choose a PIN."));
  if (std::exchange(has_entry_, true)) return;
  enqueue([name = to_std(name), pin = to_std(pin)](const database::DatabaseUrl& url) -> Result<Found> {
    Found found;
    if (!pin.empty())
      if (const Status usable = signing::check_new_pin(pin); !usable) {
        found.refusal = usable.error();
        return found;
      }
    TROCAR_TRY(results::Repository repository, results::Repository::open(url));
    const auto added = results::add_person(repository, {name}, now_s());
    if (!added && added.error().exit_status == 1) return tl::unexpected(added.error());
    if (!added) {
      found.refusal = added.error();
      return found;
    }
    if (!pin.empty()) TROCAR_TRY_STATUS(results::set_pin(repository, added->id, pin));
    found.person = *added;
    found.person->has_pin = !pin.empty();
    return found;
  });
}

bool ResultsControl::is_signing_in() const {
  return has_entry_ || start_.person().is_entry_open();
}

void ResultsControl::hold_person(bool is_held) {
  is_held_ = is_held;
}

void ResultsControl::practise_as(std::optional<results::Person> person) {
  asked_.reset();
  person_ = std::move(person);
  curves_.clear();
  // A person with a PIN has to enter it again at the next start.
  QSettings().setValue(QString::fromLatin1(kLastPerson), person_ && !person_->has_pin ? to_qt(person_->id) : QString());
  show_people();
  show_history();
  enqueue(reading_of(person_));
  Q_EMIT history_changed();
}

void ResultsControl::record_begin(const storage::SessionInfo& info) {
  task_ = info.task;
  recorded_task_.clear();
  feedback_.show_comparison({});
  if (info.person_id.empty()) return;
  enqueue([info](const database::DatabaseUrl& url) -> Result<Found> {
    TROCAR_TRY(results::Repository repository, results::Repository::open(url));
    TROCAR_TRY(const learning::Curriculum known, curriculum());
    results::Attempt attempt = results::begun_attempt(info, known);
    attempt.started = now_s();
    TROCAR_TRY_STATUS(results::begin_attempt(repository, attempt));
    return Found();
  });
}

void ResultsControl::record_end(const std::filesystem::path& session, const storage::SessionInfo& begun) {
  if (begun.person_id.empty()) return;
  enqueue([session, id = begun.attempt_id](const database::DatabaseUrl& url) -> Result<Found> {
    TROCAR_TRY(results::Repository repository, results::Repository::open(url));
    std::error_code error;
    if (!std::filesystem::exists(session, error)) {
      TROCAR_TRY_STATUS(results::forget_begun_attempt(repository, id));
      return Found();
    }
    TROCAR_TRY(const learning::Curriculum known, curriculum());
    TROCAR_TRY_STATUS(results::import_session(repository, session, {}, known));
    Found found;
    found.has_recorded = true;
    return found;
  });
  recorded_task_ = task_;
  enqueue(reading_of(person_));
}

void ResultsControl::enqueue(Work work) {
  waiting_.push_back(std::move(work));
}

void ResultsControl::poll() {
  if (auto found = working_.take()) {
    working_ = {};
    if (*found) {
      take(**std::move(found));
    } else {
      Q_EMIT warned(tr("The results cannot be recorded or read now: %1 Sessions stay on this station and are recorded "
                       "later.")
                        .arg(sentence_of(found->error())));
    }
    has_entry_ = has_entry_ && has_work();
  }
  if (working_.has_work() || waiting_.empty()) return;
  working_ = BackgroundJob<Found>([work = std::move(waiting_.front()), url = url_](const Progress&) {
    const CompleteWork complete;
    return work(url);
  });
  waiting_.pop_front();
}

void ResultsControl::take(Found found) {
  if (!found.warning.empty() && !std::exchange(has_warned_, true)) Q_EMIT warned(shown(found.warning));
  if (!found.refusal.what.empty()) start_.person().show_message(sentence_of(found.refusal));
  if (!found.people) {
    if (found.person && !is_held_) {
      start_.person().close_entry();
      practise_as(std::move(found.person));
    }
    if (found.has_recorded) Q_EMIT history_changed();
    return;
  }
  people_ = *std::move(found.people);
  std::erase_if(people_, [](const results::Person& person) { return person.is_simulated; });
  are_pins_required_ = found.are_pins_required;
  if (person_ && found.read_for == person_->id) {
    if (!found.curves) return practise_as({});  // deleted elsewhere
    curves_ = *std::move(found.curves);
  }
  show_people();
  show_history();
  if (const auto curve = curves_.find(recorded_task_); curve != curves_.end())
    feedback_.show_comparison(comparison_text(curve->second));
  if (person_ || asked_ || is_held_) return;
  const QString last = QSettings().value(QString::fromLatin1(kLastPerson)).toString();
  const auto same =
      std::ranges::find_if(people_, [&](const results::Person& person) { return to_qt(person.id) == last; });
  if (!last.isEmpty() && same != people_.end() && !same->has_pin && !are_pins_required_) practise_as(*same);
}

void ResultsControl::show_people() {
  std::vector<PersonEntry> entries;
  for (const results::Person& person : people_) entries.push_back(entry_of(person));
  const bool is_known = std::ranges::any_of(people_, [&](const auto& person) { return person.id == person_id(); });
  if (person_ && !is_known) entries.push_back(entry_of(*person_));
  start_.person().show_people(entries, to_qt(person_id()), are_pins_required_);
}

void ResultsControl::show_history() {
  const auto curve = curves_.find(start_.choice().task);
  if (person_ && curve != curves_.end()) {
    start_.show_history(curve->second);
  } else {
    start_.hide_history();
  }
}

}  // namespace trocar::trainer
