#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "tasks/action.h"
#include "telemetry/tick_sample.h"

namespace trocar::scoring {

/// What of a recording decides where the attempt ended.
struct EndData {
  std::span<const telemetry::TickSample> samples;
  std::span<const std::size_t> shots;  ///< Samples at which the gun was fired, in order.
  std::span<const tasks::Action> actions;
  bool is_biopsy = false;
  tasks::Substance confirmed_by = tasks::Substance::kNothing;  ///< Of the task.
};

/// Time at which the substance that confirms the position came back; empty: it did not.
std::optional<double> confirmation_s(const EndData& data);

/// The sample at which the needle was at its end: of a gun the first shot in the body; of other needles the moment at
/// which the substance that confirms the position came back, without that the place at which the trainee gave up: the
/// last look for it, or the deepest sample of the last insertion if the needle went on after it. Empty: a gun that was
/// not fired in the body (then the deepest sample counts), or a needle that never was in the body. docs/physics.md, E1.
std::optional<std::size_t> end_of_attempt(const EndData& data);

}  // namespace trocar::scoring
