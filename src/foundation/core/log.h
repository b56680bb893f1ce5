#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace trocar {
inline namespace core {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Writes a line to standard error with its time and level. Not for real-time code, which returns flags and counts.
/// Lines that another program can cause are logged within a LimitedLog (core/log_limit.h).
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
}  // namespace trocar
