#include "core/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "core/log_limit.h"

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
}  // namespace trocar
