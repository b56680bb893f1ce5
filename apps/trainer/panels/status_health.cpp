#include "panels/status_health.h"

#include <QCoreApplication>
#include <algorithm>
#include <functional>

namespace trocar::trainer {
namespace {

class StatusHealthText {
  Q_DECLARE_TR_FUNCTIONS(StatusHealthText)
};

std::optional<HealthReport> find_interruption(const HealthInput& input) {
  for (const ServerLine& line : input.servers) {
    if (!line.fault.isEmpty())
      return HealthReport{
          Health::kInterrupted, StatusHealthText::tr("Interrupted"),
          StatusHealthText::tr("The safety gate of \"%1\" switched its forces off: %2.").arg(line.tool, line.fault)};
    if (line.is_connected) continue;
    const QString reason =
        line.waits_for_resume
            ? StatusHealthText::tr("The server of \"%1\" is not connected: it is restarted when you resume the forces.")
            : StatusHealthText::tr("The server of \"%1\" is not connected; it is being restarted.");
    return HealthReport{Health::kInterrupted, StatusHealthText::tr("Interrupted"), reason.arg(line.tool)};
  }
  return std::nullopt;
}

std::optional<HealthReport> find_slow_forces(const HealthInput& input, const HealthLimits& limits) {
  for (const ServerLine& line : input.servers)
    if (line.served < limits.least_served || line.lateness_p99_us > limits.most_lateness_p99_us)
      return HealthReport{
          Health::kSlow, StatusHealthText::tr("Slow forces"),
          StatusHealthText::tr("The forces of \"%1\" are late: the computer is too busy.").arg(line.tool)};
  return std::nullopt;
}

std::optional<HealthReport> find_slow_pictures(const HealthInput& input, const HealthLimits& limits) {
  if (!input.frames) return std::nullopt;
  if (input.frames->per_s >= limits.least_frames_per_s && input.frames->slowest_ms <= limits.slowest_frame_ms)
    return std::nullopt;
  return HealthReport{Health::kSlow, StatusHealthText::tr("Slow display"),
                      StatusHealthText::tr("The display is slow: the computer is too busy.")};
}

QString row(const QString& title, const QStringList& cells) {
  QString text = QStringLiteral("<tr><td>%1</td>").arg(title.toHtmlEscaped());
  for (const QString& cell : cells) text += QStringLiteral("<td>%1</td>").arg(cell.toHtmlEscaped());
  return text + QStringLiteral("</tr>");
}

QString server_rows(const std::vector<ServerLine>& servers) {
  const auto cells = [&](const std::function<QString(const ServerLine&)>& cell) {
    QStringList all;
    for (const ServerLine& line : servers) all << (line.is_connected ? cell(line) : QStringLiteral("–"));
    return all;
  };
  QString text = QStringLiteral("<tr><td></td>");
  for (const ServerLine& line : servers) text += QStringLiteral("<td><b>%1</b></td>").arg(line.tool.toHtmlEscaped());
  text += QStringLiteral("</tr>");
  QStringList states;
  for (const ServerLine& line : servers)
    states << (!line.fault.isEmpty() ? StatusHealthText::tr("fault: %1").arg(line.fault)
               : line.is_connected   ? StatusHealthText::tr("connected")
                                     : StatusHealthText::tr("not connected"));
  text += row(StatusHealthText::tr("Server"), states);
  text += row(StatusHealthText::tr("Rate"),
              cells([](const ServerLine& line) { return StatusHealthText::tr("%1 Hz").arg(line.rate_hz, 0, 'f', 0); }));
  text += row(StatusHealthText::tr("Periods on time"), cells([](const ServerLine& line) {
                return StatusHealthText::tr("%1 %").arg(100.0 * line.served, 0, 'f', 2);
              }));
  text += row(StatusHealthText::tr("Lateness, 99 % below"), cells([](const ServerLine& line) {
                return StatusHealthText::tr("%1 µs").arg(line.lateness_p99_us, 0, 'f', 0);
              }));
  text += row(StatusHealthText::tr("Ticks lost"),
              cells([](const ServerLine& line) { return QString::number(line.ticks_missing); }));
  text += row(StatusHealthText::tr("Real-time scheduling"), cells([](const ServerLine& line) {
                return line.is_real_time ? StatusHealthText::tr("yes") : StatusHealthText::tr("no");
              }));
  text += row(StatusHealthText::tr("Granted by the system"), cells([](const ServerLine& line) { return line.grant; }));
  return text;
}

}  // namespace

HealthReport assess_health(const HealthInput& input, const HealthLimits& limits) {
  if (!input.is_attempt || input.servers.empty())
    return {Health::kOff, StatusHealthText::tr("Forces off"),
            StatusHealthText::tr("No attempt is running: forces are off.")};
  const bool has_fault = std::any_of(input.servers.begin(), input.servers.end(),
                                     [](const ServerLine& line) { return !line.fault.isEmpty(); });
  if (!input.has_started && !has_fault)
    return {Health::kStarting, StatusHealthText::tr("Starting"), StatusHealthText::tr("The haptic servers start.")};
  if (auto found = find_interruption(input)) return *std::move(found);
  if (input.are_forces_stopped)
    return {Health::kStopped, StatusHealthText::tr("Stopped"),
            StatusHealthText::tr("The forces are stopped; Space switches them on.")};
  if (auto found = find_slow_forces(input, limits)) return *std::move(found);
  if (auto found = find_slow_pictures(input, limits)) return *std::move(found);
  return {Health::kGood, StatusHealthText::tr("Good"), {}};
}

QString health_details(const HealthInput& input) {
  QString text = QStringLiteral("<table cellspacing='0' cellpadding='3'>");
  if (!input.servers.empty()) text += server_rows(input.servers);
  if (input.frames) {
    const FrameFigures& frames = *input.frames;
    text += row(StatusHealthText::tr("Display"), {StatusHealthText::tr("%1 frames/s").arg(frames.per_s, 0, 'f', 0)});
    text +=
        row(StatusHealthText::tr("Slowest frame"), {StatusHealthText::tr("%1 ms").arg(frames.slowest_ms, 0, 'f', 0)});
    if (frames.judged > 0)
      text += row(StatusHealthText::tr("Frames over %1 ms").arg(1e3 * FrameCount::kLate_s, 0, 'f', 0),
                  {StatusHealthText::tr("%1 of %2 late").arg(frames.late).arg(frames.judged)});
  }
  return text + QStringLiteral("</table>");
}

}  // namespace trocar::trainer
