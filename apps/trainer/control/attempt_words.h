#pragma once

#include <QString>

#include "attempt/live/attempt_view.h"

namespace trocar::trainer {

/// What the needle does, or why it cannot: "in the body", "forces stopped".
QString phase_text(const attempt::AttemptView& view);
/// What the attempt does in its first and last phase, with its progress: "Measuring, 40 %".
QString progress_text(const attempt::AttemptView& view);

}  // namespace trocar::trainer
