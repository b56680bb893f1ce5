#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace trocar::learning {

/// Level of help of an attempt, from most to least.
enum class Level : std::uint8_t { kGuided, kAssisted, kExam };
inline constexpr std::array kLevels{Level::kGuided, Level::kAssisted, Level::kExam};
/// Name in a session file: "assisted".
const char* to_string(Level level) noexcept;
std::optional<Level> find_level(std::string_view name) noexcept;

/// What the learning path knows of one attempt, whatever stores it.
struct PastAttempt {
  std::string task;     ///< "liver-biopsy".
  std::string patient;  ///< Name of an embedded patient, or a folder.
  std::uint64_t patient_seed = 1;
  std::optional<Level> level;        ///< Empty: not in the trainer's window, or an older program.
  std::chrono::sys_seconds when{};   ///< Begin, UTC.
  std::optional<double> score = {};  ///< 0..100; empty: not scored, or interrupted.
  bool is_passed = false;
  /// Points of each judged part of the score over its most points, 0..1, by the names of tasks::kScoreParts.
  std::map<std::string, double, std::less<>> part_shares = {};
};

}  // namespace trocar::learning
