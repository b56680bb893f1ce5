#pragma once

#include <QString>

#include "attempt/live/attempt_view.h"
#include "core/result.h"
#include "panels/status_strip.h"

namespace trocar::trainer {

/// A haptic server as the status strip shows it.
ServerLine line_of(const attempt::ServerView& server, const QString& tool);
/// "No gamepad is connected: plug one in."; a file or folder is named: "Cannot write (/disk/a): choose another folder."
QString sentence_of(const Error& error);

}  // namespace trocar::trainer
