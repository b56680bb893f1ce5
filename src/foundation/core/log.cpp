#include "core/log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/text.h"

namespace trocar {
inline namespace core {
namespace {

spdlog::level::level_enum spd_level(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

spdlog::logger& logger() {
  static const auto instance = [] {
    auto made = std::make_shared<spdlog::logger>("trocar", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%H:%M:%S.%e %l: %v");
    made->set_level(spdlog::level::warn);
    return made;
  }();
  return *instance;
}

}  // namespace

void log(LogLevel level, std::string_view text) {
  if (!logger().should_log(spd_level(level))) return;
  LogLimit* const limit = LimitedLog::current();
  if (limit == nullptr) return logger().log(spd_level(level), "{}", text);
  if (const auto line = limit->pass(text)) logger().log(spd_level(level), "{}", *line);
}

void set_log_level(LogLevel level) {
  logger().set_level(spd_level(level));
}

}  // namespace core
inline namespace core {
namespace {

thread_local LogLimit* current_limit = nullptr;

}  // namespace

std::string log_line(std::string_view text, std::size_t most_characters) {
  std::string line;
  std::size_t characters = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const auto character = first_character(rest);
    const std::size_t bytes = character ? character->bytes : 1;
    const bool is_plain = character && is_printable(character->code_point);
    constexpr std::size_t kEscaped = 4;  // characters of "\x0a"
    characters += is_plain ? 1 : kEscaped * bytes;
    if (characters > most_characters) return line + fmt::format("… ({} bytes)", text.size());
    if (is_plain) {
      line += rest.substr(0, bytes);
    } else {
      for (const char byte : rest.substr(0, bytes))
        fmt::format_to(std::back_inserter(line), "\\x{:02x}", static_cast<unsigned char>(byte));
    }
    rest.remove_prefix(bytes);
  }
  return line;
}

std::optional<std::string> LogLimit::pass(std::string_view text) {
  const std::lock_guard lock(mutex_);
  const Clock::TimePoint time = now();
  constexpr double kInterval_s = std::chrono::duration<double>(kInterval).count();
  if (filled_) lines_ = std::min(kAtOnce, lines_ + std::max(0.0, seconds_between(*filled_, time)) / kInterval_s);
  filled_ = time;
  constexpr double kRounding = 1e-9;
  if (lines_ < 1.0 - kRounding) {
    ++left_out_;
    return {};
  }
  lines_ -= 1.0;
  std::string line = log_line(text, kMostCharacters);
  if (left_out_ > 0) line += fmt::format(" ({} lines before were left out)", std::exchange(left_out_, 0));
  return line;
}

LimitedLog::LimitedLog(LogLimit& limit) noexcept : outer_(std::exchange(current_limit, &limit)) {}

LimitedLog::~LimitedLog() {
  current_limit = outer_;
}

LogLimit* LimitedLog::current() noexcept {
  return current_limit;
}

}  // namespace core
}  // namespace trocar
