#include "learning/past_attempt.h"

#include <fmt/format.h>

#include <vector>

namespace trocar::learning {

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
