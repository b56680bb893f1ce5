#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/clock.h"

namespace trocar {
inline namespace core {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Writes a line to standard error with its time and level. Not for real-time code, which returns flags and counts.
/// Lines that another program can cause are logged within a LimitedLog (below).
void log(LogLevel level, std::string_view text);
/// The lowest level that is written; kWarning at start.
void set_log_level(LogLevel level);

template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace core
inline namespace core {

/// `text` for one line of the log: control characters, characters that change the order of others and bytes that are
/// not UTF-8 are escaped ("\x0a"), and it is cut to `most_characters`; a cut line states the length of the whole text.
std::string log_line(std::string_view text, std::size_t most_characters);

/// Limit for the lines of the log that other programs can cause: kAtOnce lines, then one every kInterval, each cut to
/// kMostCharacters. Lines above it are left out and counted; the next line states their number. Thread-safe.
class LogLimit {
 public:
  static constexpr double kAtOnce = 10.0;
  static constexpr Clock::Duration kInterval = std::chrono::seconds(6);
  static constexpr std::size_t kMostCharacters = 200;

  LogLimit() = default;
  /// With the clock of a test, which must outlive it.
  explicit LogLimit(const Clock& clock) : clock_(&clock) {}

  /// The line to write; empty if it is left out.
  std::optional<std::string> pass(std::string_view text);

 private:
  Clock::TimePoint now() const noexcept { return clock_ == nullptr ? SteadyClock().now() : clock_->now(); }

  const Clock* clock_ = nullptr;
  std::mutex mutex_;
  double lines_ = kAtOnce;  ///< Lines that may be written now.
  std::optional<Clock::TimePoint> filled_;
  std::uint64_t left_out_ = 0;
};

/// While it exists, the lines that this thread logs pass a limit. Scopes nest; the innermost one counts.
class LimitedLog {
 public:
  explicit LimitedLog(LogLimit& limit) noexcept;
  ~LimitedLog();
  LimitedLog(const LimitedLog&) = delete;
  LimitedLog& operator=(const LimitedLog&) = delete;
  /// Of the calling thread; null: none.
  static LogLimit* current() noexcept;

 private:
  LogLimit* outer_;
};

}  // namespace core
}  // namespace trocar
