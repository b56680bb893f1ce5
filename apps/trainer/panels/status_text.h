#pragma once

#include <QString>

#include "attempt/live/attempt_view.h"
#include "core/result.h"
#include "panels/status_health.h"

namespace trocar::trainer {

/// Figures of a haptic server for the status strip.
ServerLine line_of(const attempt::ServerView& server, const QString& tool);
/// "No gamepad is connected: plug one in."; the sentence names a file or folder: "Cannot write (/disk/a): choose
/// another folder."
QString sentence_of(const Error& error);

}  // namespace trocar::trainer
