#include "control/learning_control.h"

#include <algorithm>
#include <chrono>
#include <random>

#include "core/files/folders.h"
#include "exams/exam_result.h"
#include "io/patient/patient_cache.h"
#include "learning/history.h"
#include "pages/start_page.h"
#include "panels/feedback_panel.h"
#include "panels/status_text.h"
#include "results/attempts.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

TrainingMode difficulty_of(learning::TrainingMode level) {
  for (const TrainingMode mode : {TrainingMode::kGuided, TrainingMode::kAssisted, TrainingMode::kExam})
    if (std::string_view(name_of(mode)) == learning::to_string(level)) return mode;
  return TrainingMode::kGuided;
}

TrainerChoice choice_of(const learning::Exercise& exercise) {
  TrainerChoice choice;
  choice.task = exercise.task;
  choice.patient = exercise.patient;
  choice.mode = difficulty_of(exercise.level);
  return choice;
}

QString joined_sentences(const std::vector<std::string>& sentences) {
  QStringList lines;
  for (const std::string& sentence : sentences) lines << shown(sentence);
  return lines.join(QLatin1Char(' '));
}

Result<learning::History> history_of(const database::DatabaseUrl& url, const std::string& person_id) {
  TROCAR_TRY(results::Repository repository, results::Repository::open(url, database::Missing::kRefuse));
  learning::History history;
  TROCAR_TRY(history.attempts, results::past_attempts(repository, person_id));
  return history;
}

/// The bodies that count for an exam: all of this station, and those of the person on other stations.
Result<std::vector<exams::SeenBody>> seen_bodies(const std::filesystem::path& state, const database::DatabaseUrl& url,
                                                 const std::string& person_id) {
  TROCAR_TRY(exams::SeenBodies seen, exams::seen_on_station(state / "sessions"));
  if (person_id.empty()) return std::move(seen.attempts);
  TROCAR_TRY(results::Repository repository, results::Repository::open(url, database::Missing::kRefuse));
  TROCAR_TRY(const std::vector<exams::SeenBody> recorded, exams::seen_by_person(repository, person_id));
  seen.attempts.insert(seen.attempts.end(), recorded.begin(), recorded.end());
  return std::move(seen.attempts);
}

}  // namespace

LearningControl::LearningControl(std::filesystem::path state_folder, StartPage& start, FeedbackPanel& feedback,
                                 QObject* parent)
    : QObject(parent), state_folder_(std::move(state_folder)), start_(start), feedback_(feedback) {
  refresh();
}

LearningControl::~LearningControl() = default;

void LearningControl::follow(const database::DatabaseUrl& url, const std::string& person_id) {
  url_ = url;
  person_id_ = person_id;
  refresh();
}

void LearningControl::refresh() {
  retired_.retire(std::exchange(advising_, {}));
  const auto work = [folder = state_folder_ / "sessions", url = url_, person = person_id_](
                        const Progress&, const std::stop_token& stop) -> Result<Advice> {
    TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
    TROCAR_TRY(const learning::Curriculum curriculum, learning::load_curriculum(data));
    TROCAR_TRY(const learning::History history,
               person.empty() ? learning::read_history(folder, stop) : history_of(url, person));
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    Advice advice{learning::next_exercise(history.attempts, curriculum, now), {}};
    if (advice.next.exercise) advice.title = learning::exercise_text(*advice.next.exercise, curriculum);
    if (!history.damaged.empty())
      advice.next.notes.push_back(std::to_string(history.damaged.size()) +
                                  " damaged sessions do not count: see trocar learn.");
    return advice;
  };
  advising_ = BackgroundJob<Advice>(work);
}

void LearningControl::find_exam_body(const TrainerChoice& choice) {
  cancel_exam_body();
  exam_ = choice;
  const auto work = [choice, state = state_folder_, url = url_,
                     person = person_id_](const Progress& progress) -> Result<exams::ExamBody> {
    auto found = seen_bodies(state, url, person);
    if (!found) found = seen_bodies(state, url, {});  // the database is away: the result will be made later
    TROCAR_TRY(const std::vector<exams::SeenBody> seen, std::move(found));
    const exams::FitCheck check = exams::fit_check(choice.task, choice.patient, io::patient_cache_folder(), progress);
    if (choice.exam_number != 0) return exams::find_body({choice.patient, choice.exam_number}, seen, person, check);
    return exams::draw_body(choice.patient, seen, std::random_device()(), check);
  };
  draw_ = [work] { return BackgroundJob<exams::ExamBody>(work); };
}

void LearningControl::cancel_exam_body() {
  draw_ = nullptr;
  retired_.retire(std::exchange(drawing_, {}));
}

void LearningControl::note_tables() {
  data_sha256_ = exams::digest_of_data(data_dir());
}

void LearningControl::seal(const std::filesystem::path& session, exams::ExamEnd end) {
  feedback_.show_result(tr("The result of the exam is being signed …"));
  const auto work = [session, end = std::move(end), data = data_sha256_, state = state_folder_,
                     url = url_](const Progress&) mutable -> Result<std::filesystem::path> {
    const CompleteWork complete;
    TROCAR_TRY(end.data_sha256, std::move(data));
    TROCAR_TRY(const auto key, signing::open_station_key(state / exams::kStationKeyFile));
    TROCAR_TRY_STATUS(exams::seal_exam(session, end, key));
    auto seen = seen_bodies(state, url, end.person.id);
    if (!seen) {
      seen.error().advice = "the exam is sealed: make its result later with trocar exam sign";
      return tl::unexpected(std::move(seen).error());
    }
    return exams::sign_exam(session, *seen, key);
  };
  signing_ = BackgroundJob<std::filesystem::path>(work);
}

void LearningControl::forget_result() {
  result_file_.clear();
  feedback_.show_result({});
}

void LearningControl::show(const Advice& advice) {
  next_title_ = shown(advice.title);
  QString why = joined_sentences(advice.next.reasons);
  if (!advice.next.notes.empty()) why += QLatin1Char(' ') + joined_sentences(advice.next.notes);
  start_.offer_next(next_title_, why, advice.next.exercise ? choice_of(*advice.next.exercise) : TrainerChoice());
  feedback_.show_next(next_title_.isEmpty() ? why : next_title_ + QStringLiteral(". ") + why);
}

void LearningControl::poll_body() {
  if (!drawing_.has_work()) return;
  const JobView view = drawing_.view();
  auto body = drawing_.take();
  if (!body) {
    if (!view.is_done) Q_EMIT exam_progress(tr("Drawing an unseen body: %1").arg(shown(view.step)), view.fraction);
    return;
  }
  drawing_ = {};
  if (!*body) {
    Q_EMIT exam_failed(shown(body->error().text()));
    return;
  }
  exam_.exam_number = exam_.patient_seed = (*body)->number;
  exam_.is_body_known = (*body)->is_known;
  Q_EMIT exam_found(exam_);
}

void LearningControl::poll_signature() {
  const auto signed_file = signing_.take();
  if (!signed_file) return;
  signing_ = {};
  if (*signed_file) {
    result_file_ = to_qt((*signed_file)->string());
    feedback_.show_result(tr("The result of the exam is signed: %1").arg(result_file_));
  } else {
    feedback_.show_result(tr("The result of the exam is not signed: %1").arg(sentence_of(signed_file->error())));
  }
  refresh();
}

void LearningControl::poll() {
  // One at a time: a body that is no longer wanted takes memory until its work has ended.
  if (retired_.sweep() == 0 && draw_) drawing_ = std::exchange(draw_, nullptr)();
  poll_body();
  poll_signature();
  const auto advice = advising_.take();
  if (!advice) return;
  advising_ = {};
  if (*advice) {
    show(**advice);
  } else {
    start_.offer_next({}, {}, {});
    feedback_.show_next(sentence_of(advice->error()));
  }
}

}  // namespace trocar::trainer
