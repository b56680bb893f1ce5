#include "learning/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/files/list_folder.h"
#include "core/parallel.h"
#include "core/parse_number.h"

namespace trocar::learning {
namespace fs = std::filesystem;
namespace {

bool is_session_name(const fs::path& path) {
  return path.extension() == ".trocar" || path.extension() == ".session";
}

Result<PastAttempt> load_attempt(const fs::path& file) {
  TROCAR_TRY(const storage::SessionSummary session, storage::load_summary(file));
  auto attempt = attempt_of(session);
  if (!attempt) attempt.error().where = file.string();
  return attempt;
}

}  // namespace

bool was_in_body(const scoring::Outcome& outcome) {
  for (const metrics::MetricValue& measure : outcome.measures)
    if (measure.name == kInBodyMetric && measure.value) return *measure.value > 0.0;
  // Sessions of older programs have no measures; these were their words.
  return outcome.not_scored != "the needle never touched the skin" &&
         outcome.not_scored != "the needle did not pierce the skin";
}

Ending ending_of(const storage::SessionSummary& session) {
  if (!session.outcome) return Ending::kLost;
  const scoring::Outcome& outcome = *session.outcome;
  if (outcome.is_scored()) return std::isfinite(outcome.score) ? Ending::kScored : Ending::kLost;
  return was_in_body(outcome) ? Ending::kUnscored : Ending::kNeverBegan;
}

std::optional<std::chrono::sys_seconds> parse_utc(std::string_view text) {
  constexpr std::string_view kPattern = "0000-00-00T00:00:00Z";
  if (text.size() != kPattern.size()) return std::nullopt;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool is_digit = text[n] >= '0' && text[n] <= '9';
    if (kPattern[n] == '0' ? !is_digit : text[n] != kPattern[n]) return std::nullopt;
  }
  const auto number = [&](std::size_t at, std::size_t digits) {
    int value = 0;
    for (const char digit : text.substr(at, digits)) value = 10 * value + (digit - '0');
    return value;
  };
  const std::chrono::year_month_day day{std::chrono::year(number(0, 4)),
                                        std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                        std::chrono::day(static_cast<unsigned>(number(8, 2)))};
  const int hour = number(11, 2), minute = number(14, 2), second = number(17, 2);
  if (!day.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  return std::chrono::sys_days(day) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
         std::chrono::seconds(second);
}

Result<std::vector<fs::path>> find_sessions(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return std::vector<fs::path>();
  auto files = list_folder(folder);
  if (!files) return fail("cannot be read: " + files.error().what, folder.string(), "name the folder of the sessions");
  std::erase_if(*files, [](const fs::path& file) { return !is_session_name(file); });
  return files;
}

Result<PastAttempt> attempt_of(const storage::SessionSummary& session) {
  const storage::SessionInfo& info = session.info;
  const auto when = parse_utc(info.started_utc);
  if (!when) return fail("the session has no time of its begin", {}, "record it again");
  PastAttempt attempt{info.task, info.patient_source, info.patient_seed, find_training_mode(info.level), *when};
  attempt.ending = ending_of(session);
  if (attempt.ending != Ending::kScored) return attempt;
  attempt.score = std::clamp(session.outcome->score, 0.0, 100.0);
  attempt.is_passed = session.outcome->is_passed;
  for (const scoring::ScorePart& part : session.outcome->parts)
    if (!scoring::is_deduction(part) && std::isfinite(part.points / part.max_points))
      attempt.part_shares[part.name] = std::clamp(part.points / part.max_points, 0.0, 1.0);
  return attempt;
}

Result<History> read_history(const fs::path& folder, const std::stop_token& stop) {
  TROCAR_TRY(const std::vector<fs::path> files, find_sessions(folder));
  std::vector<std::optional<Result<PastAttempt>>> read(files.size());
  parallel_for(files.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last && !stop.stop_requested(); ++n) read[n] = load_attempt(files[n]);
  });
  History history;
  if (stop.stop_requested()) return history;
  for (auto& attempt : read) {
    if (!attempt) continue;
    if (*attempt) {
      history.attempts.push_back(**std::move(attempt));
    } else {
      history.damaged.push_back(attempt->error().text());
    }
  }
  std::stable_sort(history.attempts.begin(), history.attempts.end(),
                   [](const PastAttempt& a, const PastAttempt& b) { return a.when < b.when; });
  return history;
}

}  // namespace trocar::learning
