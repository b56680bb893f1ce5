#include "core/log_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/utf8.h"

namespace trocar {
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
