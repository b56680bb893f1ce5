#include "metrics/detail/pose_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "core/text.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics::detail {
namespace {

constexpr double kLongest_s = 86400.0;

/// The parts between separators; of an empty text one empty part.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text[n] != separator) continue;
    parts.push_back(text.substr(begin, n - begin));
    begin = n + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

bool is_limit(std::string_view name) {
  if (name == "unknown") return true;  // of a newer program
  for (int n = 0; n <= static_cast<int>(telemetry::kLastLimitReason); ++n)
    if (name == to_string(static_cast<telemetry::LimitReason>(n))) return true;
  return false;
}

/// "500-999": ticks that a damaged session lacks.
bool is_range(std::string_view text) {
  const auto first = find_leading_number<std::uint64_t>(text);
  if (!first || !first->rest.starts_with('-')) return false;
  const auto last = parse_number<std::uint64_t>(first->rest.substr(1));
  return last && *last >= first->value;
}

/// What is wrong with an event; nullptr: nothing.
const char* fault_of(std::string_view kind, std::string_view value) {
  if (kind == "puncture" || kind == "enter" || kind == "pain") return value.empty() ? "the name is missing" : nullptr;
  if (kind == "interruption") {
    const auto length_s = parse_number<double>(value);
    return length_s && *length_s >= 0.0 && *length_s <= kLongest_s ? nullptr
                                                                   : "the length is no number of seconds up to a day";
  }
  if (kind == "limit") return is_limit(value) ? nullptr : "there is no such limit";
  if (kind == "set") {
    const std::size_t sign = value.find('=');
    return sign > 0 && sign < value.size() - 1 && sign != std::string_view::npos ? nullptr : "it is not set:NAME=VALUE";
  }
  if (kind == "damaged") return is_range(value) ? nullptr : "it is not damaged:FIRST-LAST";
  if (kind == "incomplete") return value.empty() ? nullptr : "it has no value";
  return "there is no such event";
}

}  // namespace

PoseEvents read_pose_events(std::string_view field) {
  PoseEvents events;
  if (field.empty()) return events;
  for (const std::string_view event : split(field, ';')) {
    const std::vector<std::string_view> parts = split(event, ':');
    const std::string_view kind = parts.front(), value = event.substr(std::min(kind.size() + 1, event.size()));
    const char* const fault = event.empty() ? "an event is empty" : fault_of(kind, value);
    if (fault != nullptr) {
      events.fault = fmt::format("'{}': {}", event.substr(0, 60), fault);
      return events;
    }
    if (kind == "puncture") events.punctures.push_back(value);
    events.is_paused = events.is_paused || kind == "interruption";
  }
  return events;
}

}  // namespace trocar::metrics::detail
