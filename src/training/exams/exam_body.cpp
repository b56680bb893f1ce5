#include "exams/exam_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "cases/prepare_case.h"
#include "core/parallel.h"
#include "core/random.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_folder.h"
#include "learning/history.h"
#include "phantom/phantom.h"
#include "results/attempts.h"
#include "storage/session_file.h"

namespace trocar::exams {
namespace {

constexpr std::uint64_t kFirstDrawn = 1000, kLastDrawn = 9999;

}  // namespace

Result<ExamBody> draw_body(const std::string& patient, std::span<const SeenBody> history, std::uint64_t random_seed,
                           const FitCheck& check) {
  std::set<std::uint64_t> known;
  for (const SeenBody& seen : history)
    if (seen.patient == patient) known.insert(seen.seed);
  Random random(random_seed);
  ExamBody body;
  Result<std::string> fit = fail("all bodies are known", patient, "choose another patient");
  constexpr std::uint64_t kNumbers = kLastDrawn - kFirstDrawn + 1;
  std::uint64_t number = kFirstDrawn + random.next() % kNumbers;
  // One after the other, so that every number is tried at most once.
  for (std::uint64_t n = 0; n < kNumbers && body.unfit.size() < kMostTries; ++n, ++number) {
    if (number > kLastDrawn) number = kFirstDrawn;
    if (known.contains(number)) continue;
    fit = check(number);
    if (fit && !is_known_body(history, {patient, number, *fit})) {
      body.number = number;
      return body;
    }
    if (fit)
      fit = fail("the body is known by another name", fmt::format("{}, number {}", patient, number),
                 "choose another patient");
    body.unfit.push_back(number);
  }
  return tl::unexpected(std::move(fit).error());
}

Result<ExamBody> find_body(const ExaminedBody& body, std::span<const SeenBody> history, std::string_view person_id,
                           const FitCheck& check) {
  const std::uint64_t number = body.seed;
  if (number <= kPractisedNumber || number > kMostNumber)
    return fail_usage(fmt::format("there is no exam {}", number), "exam number",
                      fmt::format("choose {} to {}", kPractisedNumber + 1, kMostNumber));
  const Result<std::string> fit = check(number);
  if (!fit)
    return fail(fmt::format("exam {} cannot be held: {}", number, fit.error().what), body.patient,
                "choose another number, or let one be drawn");
  return ExamBody{number, is_known_body(history, {body.patient, number, *fit}, person_id)};
}

FitCheck fit_check(const std::string& task, const std::string& patient, const std::filesystem::path& cache_folder,
                   const Progress& progress) {
  return [=](std::uint64_t number) -> Result<std::string> {
    TROCAR_TRY(anatomy::VirtualPatient body, io::open_patient({patient, number, cache_folder}, progress));
    std::string hash = body.content_hash;
    cases::CaseOptions options;
    options.task = task;
    options.patient_folder = patient;
    TROCAR_TRY_STATUS(
        cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(body)), options, progress));
    return hash;
  };
}

Result<std::string> patient_of_difficulty(const std::string& task, int difficulty) {
  for (const phantom::PhantomInfo& info : phantom::embedded_patients())
    if (info.difficulty == difficulty && std::find(info.tasks.begin(), info.tasks.end(), task) != info.tasks.end())
      return info.name;
  return fail_usage(fmt::format("there is no patient of difficulty {} for {}", difficulty, task), "--difficulty",
                    "see trocar patient list");
}

namespace fs = std::filesystem;
namespace {

Result<SeenBody> load_seen(const fs::path& file) {
  TROCAR_TRY(const storage::SessionSummary session, storage::load_summary(file));
  const storage::SessionInfo& info = session.info;
  const auto begin = learning::parse_utc(info.started_utc);
  if (!begin) return fail("the session has no time of its begin", file.string(), "record it again");
  return SeenBody{info.attempt_id,  info.person_id, info.patient_source, info.patient_seed, *begin, {},
                  info.patient_hash};
}

}  // namespace

Result<SeenBodies> seen_on_station(const fs::path& folder) {
  TROCAR_TRY(const std::vector<fs::path> files, learning::find_sessions(folder));
  std::vector<std::optional<Result<SeenBody>>> read(files.size());
  parallel_for(files.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) read[n] = load_seen(files[n]);
  });
  SeenBodies seen;
  for (auto& attempt : read) {
    if (*attempt) {
      seen.attempts.push_back(**std::move(attempt));
    } else {
      seen.damaged.push_back(attempt->error().text());
    }
  }
  return seen;
}

Result<std::vector<SeenBody>> seen_by_person(results::Repository& repository, std::string_view person_id) {
  std::vector<SeenBody> seen;
  if (person_id.empty()) return seen;
  TROCAR_TRY(const std::vector<results::Attempt> attempts,
             results::list_attempts(repository, {.person_id = std::string(person_id)}));
  for (const results::Attempt& attempt : attempts)
    seen.push_back({attempt.id,
                    attempt.person_id,
                    attempt.the_case.patient,
                    attempt.the_case.seed,
                    attempt.started,
                    attempt.sequence,
                    {}});
  return seen;
}

bool is_known_body(std::span<const SeenBody> attempts, const ExaminedBody& body, std::string_view person_id) {
  return std::ranges::any_of(attempts, [&](const SeenBody& seen) {
    const bool is_named = seen.patient == body.patient && (seen.seed == body.seed || io::is_path(body.patient));
    const bool is_same = !body.hash.empty() && seen.hash == body.hash;
    return (is_named || is_same) && (person_id.empty() || seen.person_id == person_id);
  });
}

std::vector<SeenBody> before(std::span<const SeenBody> attempts, const ExamInHistory& exam) {
  std::optional<std::int64_t> own;  // where the exam itself is in the order of recording
  for (const SeenBody& seen : attempts)
    if (seen.sequence && !exam.attempt_id.empty() && seen.attempt_id == exam.attempt_id) own = seen.sequence;
  std::vector<SeenBody> earlier;
  std::ranges::copy_if(attempts, std::back_inserter(earlier), [&](const SeenBody& seen) {
    if (!exam.attempt_id.empty() && seen.attempt_id == exam.attempt_id) return false;
    const bool is_recorded_before = seen.sequence && own && *seen.sequence < *own;
    return is_recorded_before || seen.begin <= exam.begin;
  });
  return earlier;
}

}  // namespace trocar::exams
