#include "learning/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/files/folders.h"
#include "core/parallel.h"
#include "core/text.h"

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

const char* to_string(TrainingMode level) noexcept {
  constexpr std::array kNames{"guided", "assisted", "exam"};
  return kNames[static_cast<std::size_t>(level)];
}

std::optional<TrainingMode> find_training_mode(std::string_view name) noexcept {
  for (const TrainingMode level : kTrainingModes)
    if (name == to_string(level)) return level;
  return std::nullopt;
}

void AttemptCounts::add(Ending ending, bool is_passed, std::int64_t count) noexcept {
  switch (ending) {
    case Ending::kScored:
      scored += count;
      passed += is_passed ? count : 0;
      break;
    case Ending::kUnscored:
      unscored += count;
      break;
    case Ending::kNeverBegan:
      never_began += count;
      break;
    case Ending::kLost:
      lost += count;
      break;
    case Ending::kRunning:
      running += count;
      break;
  }
}

void AttemptCounts::add(const AttemptCounts& other) noexcept {
  scored += other.scored;
  passed += other.passed;
  unscored += other.unscored;
  never_began += other.never_began;
  lost += other.lost;
  running += other.running;
  without_level += other.without_level;
}

std::string counts_text(const AttemptCounts& counts) {
  std::string text = fmt::format("{} attempt{} counted", counts.counted(), counts.counted() == 1 ? "" : "s");
  if (counts.unscored > 0) text += fmt::format(" ({} ended without a result)", counts.unscored);
  if (counts.left_out() == 0) return text;
  std::vector<std::string> reasons;
  const auto add = [&](std::int64_t count, const char* one, const char* more) {
    if (count > 0) reasons.push_back(fmt::format("{} {}", count, count == 1 ? one : more));
  };
  add(counts.never_began, "never began", "never began");
  add(counts.lost, "was lost to a crash", "were lost to crashes");
  add(counts.running, "is not over", "are not over");
  add(counts.without_level, "had no level of help", "had no level of help");
  return text + fmt::format(", {} left out: {}", counts.left_out(), fmt::join(reasons, ", "));
}

}  // namespace trocar::learning
