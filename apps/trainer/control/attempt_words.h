#pragma once

#include <QString>

#include "attempt/live/attempt_view.h"

namespace trocar::trainer {

/// What the needle does, or why it cannot: "in the body", "forces stopped".
QString phase_text(const attempt::AttemptView& view);

}  // namespace trocar::trainer
