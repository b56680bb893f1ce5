#include "exams/seen_bodies.h"

#include <algorithm>

#include "core/parallel.h"
#include "io/patient/patient_source.h"
#include "learning/history.h"
#include "results/attempts.h"
#include "storage/session_summary.h"

namespace trocar::exams {
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
