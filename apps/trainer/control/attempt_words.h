#pragma once

#include <QString>

#include "attempt/live/attempt_view.h"
#include "cases/open_case.h"

namespace trocar::trainer {

/// What the needle does, or why it cannot: "in the body", "forces stopped".
QString phase_text(const attempt::AttemptView& view);
/// True if the needle entered a structure at risk of the task.
bool is_risk(const cases::Case& the_case, const attempt::AttemptEvent& event);

}  // namespace trocar::trainer
