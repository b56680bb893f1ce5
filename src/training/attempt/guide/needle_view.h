#pragma once

#include "attempt/case/prepare_case.h"
#include "attempt/live/attempt_view.h"

namespace trocar::attempt {

/// What a page shows of a tick of the needle. `X_PN_hand`: where the hand wants it.
NeedleView needle_view(const Case& the_case, const telemetry::TickSample& sample, const Pose& X_PN_hand);

}  // namespace trocar::attempt
