#pragma once

#include "attempt/live/attempt_view.h"
#include "cases/prepare_case.h"
#include "telemetry/needle_shape.h"

namespace trocar::attempt {

/// Display data of a needle tick. `shape`: the newest one. `X_PN_goal`: target pose of the hand.
NeedleView needle_view(const cases::Case& the_case, const telemetry::TickSample& sample,
                       const telemetry::NeedleShape& shape, const Pose& X_PN_goal);

}  // namespace trocar::attempt
