#include "panels/status_text.h"

#include <algorithm>

#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {

ServerLine line_of(const attempt::ServerView& server, const QString& tool) {
  ServerLine line;
  line.tool = tool;
  line.is_connected = server.is_connected;
  line.waits_for_resume = server.waits_for_resume;
  line.rate_hz = server.rate_hz;
  line.served = server.wanted_hz > 0.0 ? std::min(1.0, server.rate_hz / server.wanted_hz) : 1.0;
  line.lateness_p99_us = server.p99_us;
  line.ticks_missing = server.ticks_missing;
  if (server.fault != telemetry::GateFault::kNone) line.fault = shown(to_string(server.fault));
  line.grant = shown(server.grant);
  line.is_real_time = server.grant.find("SCHED_FIFO") != std::string::npos;
  return line;
}

QString sentence_of(const Error& error) {
  QString text = shown(error.what);
  if (error.where.starts_with('/')) text += QStringLiteral(" (%1)").arg(to_qt(error.where));
  if (!error.advice.empty()) text += QStringLiteral(": ") + shown(error.advice);
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text.endsWith('.') ? text : text + '.';
}

}  // namespace trocar::trainer
