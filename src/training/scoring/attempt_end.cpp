#include "scoring/attempt_end.h"

#include <algorithm>

#include "telemetry/tick_sample.h"

namespace trocar::scoring {
namespace {

std::optional<std::size_t> sample_at(const EndData& data, double time_s) {
  if (data.samples.empty()) return std::nullopt;
  const auto found = std::ranges::lower_bound(data.samples, time_s, {}, &telemetry::TickSample::time_s);
  return std::min<std::size_t>(static_cast<std::size_t>(found - data.samples.begin()), data.samples.size() - 1);
}

/// Where the trainee gave up.
std::optional<std::size_t> last_end(const EndData& data) {
  std::optional<std::size_t> end;
  bool was_inside = false;
  for (std::size_t n = 0; n < data.samples.size(); ++n) {
    const telemetry::TickSample& sample = data.samples[n];
    const bool is_inside = telemetry::is_in_body(sample);
    if (is_inside && (!was_inside || !(sample.depth_mm <= data.samples[*end].depth_mm))) end = n;
    was_inside = is_inside;
  }
  if (!end) return end;
  for (const tasks::Action& action : data.actions) {
    const bool is_look = action.kind == tasks::ActionKind::kDrawStylet || action.kind == tasks::ActionKind::kAspirate;
    const auto look = sample_at(data, action.time_s);
    if (is_look && look && *look > *end && telemetry::is_in_body(data.samples[*look])) end = look;
  }
  return end;
}

}  // namespace

std::optional<double> confirmation_s(const EndData& data) {
  if (data.confirmed_by == tasks::Substance::kNothing || data.samples.empty()) return std::nullopt;
  for (const tasks::Action& action : data.actions)
    if (action.result.substance == data.confirmed_by && action.result.share > 0.0) return action.time_s;
  return std::nullopt;
}

std::optional<std::size_t> end_of_attempt(const EndData& data) {
  if (data.is_biopsy) {
    const auto is_inside = [&](std::size_t shot) {
      return shot < data.samples.size() && telemetry::is_in_body(data.samples[shot]);
    };
    const auto shot = std::ranges::find_if(data.shots, is_inside);
    return shot != data.shots.end() ? std::optional(*shot) : std::nullopt;
  }
  const std::optional<double> proof_s = confirmation_s(data);
  return proof_s ? sample_at(data, *proof_s) : last_end(data);
}

}  // namespace trocar::scoring
