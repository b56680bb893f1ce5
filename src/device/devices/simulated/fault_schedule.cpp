#include "devices/simulated/fault_schedule.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "core/parse_number.h"

namespace trocar::devices {
namespace {

/// Range of the number after the colon; high = 0 for kinds without one.
struct FaultKind {
  DeviceFault fault;
  const char* name;
  const char* unit;
  double high;
};
constexpr std::array kFaults{
    FaultKind{DeviceFault::kJitter, "jitter", "mm", 1000.0},
    FaultKind{DeviceFault::kDropped, "dropped", "", 0.0},
    FaultKind{DeviceFault::kNan, "nan", "", 0.0},
    FaultKind{DeviceFault::kStuck, "stuck", "", 0.0},
    FaultKind{DeviceFault::kJump, "jump", "mm", 10000.0},
    FaultKind{DeviceFault::kDisconnect, "disconnect", "", 0.0},
    FaultKind{DeviceFault::kSlowWrite, "slow_write", "ms", kMaxSlow_ms},
    FaultKind{DeviceFault::kSlowRead, "slow_read", "ms", kMaxSlow_ms},
};
constexpr double kMaxTime_s = 1e6;

const FaultKind* find_fault(std::string_view name) noexcept {
  for (const FaultKind& kind : kFaults)
    if (name == kind.name) return &kind;
  return nullptr;
}

/// A number from 0 to `high`.
std::optional<double> parse_number_below(std::string_view text, double high) noexcept {
  const auto value = parse_number<double>(text);
  return value && *value >= 0.0 && *value <= high ? value : std::nullopt;
}

tl::unexpected<Error> refuse(std::string_view text, std::string what) {
  return fail_usage(
      std::move(what), fmt::format("fault \"{}\"", text),
      "write KIND[:AMOUNT]@FROM_S[+FOR_S], as in jitter:0.3@1+2; kinds are jitter:MM, dropped, nan, stuck, "
      "jump:MM, disconnect, slow_write:MS, slow_read:MS");
}

}  // namespace

const char* to_string(DeviceFault fault) noexcept {
  for (const FaultKind& kind : kFaults)
    if (kind.fault == fault) return kind.name;
  return "";
}

Result<ScheduledFault> parse_fault(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos) return refuse(text, "the fault has no start time");
  const std::string_view what = text.substr(0, at);
  const std::string_view when = text.substr(at + 1);
  const std::size_t colon = what.find(':');
  const FaultKind* kind = find_fault(what.substr(0, colon));
  if (kind == nullptr) return refuse(text, "unknown fault");

  ScheduledFault fault;
  fault.fault = kind->fault;
  const bool takes_amount = kind->high > 0.0;
  if (takes_amount != (colon != std::string_view::npos)) {
    return refuse(text, takes_amount ? fmt::format("{} needs an amount in {}", kind->name, kind->unit)
                                     : fmt::format("{} takes no amount", kind->name));
  }
  if (takes_amount) {
    const auto amount = parse_number_below(what.substr(colon + 1), kind->high);
    if (!amount) return refuse(text, fmt::format("the amount is not a number of 0..{} {}", kind->high, kind->unit));
    fault.amount = *amount;
  }

  const std::size_t plus = when.find('+');
  const auto from_s = parse_number_below(when.substr(0, plus), kMaxTime_s);
  if (!from_s) return refuse(text, fmt::format("the start is not a number of 0..{} s", kMaxTime_s));
  fault.from_s = *from_s;
  fault.for_s = std::numeric_limits<double>::infinity();
  if (plus == std::string_view::npos) return fault;
  const auto for_s = parse_number_below(when.substr(plus + 1), kMaxTime_s);
  if (!for_s) return refuse(text, fmt::format("its duration is not a number of 0..{} s", kMaxTime_s));
  fault.for_s = *for_s;
  return fault;
}

}  // namespace trocar::devices
