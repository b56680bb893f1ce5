#include "panels/devices/device_check.h"

#include <QStringList>
#include <algorithm>

#include "attempt/servers/server_hosts.h"
#include "link/client/server_process.h"
#include "panels/status_text.h"
#include "telemetry/tick_sample.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kPatience_ms = 2000;  ///< Timeout for the end of the program; its device is at rest long before.

QString last_line(const QByteArray& text) {
  const QStringList lines = QString::fromUtf8(text).split('\n', Qt::SkipEmptyParts);
  return lines.isEmpty() ? QString() : lines.last();
}

}  // namespace

DeviceCheck::DeviceCheck(const QString& spec, bool is_calibrating, QObject* parent) : QObject(parent) {
  connect(&process_, &QProcess::readyReadStandardOutput, this, &DeviceCheck::read_lines);
  connect(&process_, qOverload<int, QProcess::ExitStatus>(&QProcess::finished), this, &DeviceCheck::note_end);
  const auto program = link::find_server_program();
  if (!program) {
    fail_with(sentence_of(program.error()), shown(program.error().text()));
    return;
  }
  QStringList arguments{QStringLiteral("--device"), spec, QStringLiteral("--test")};
  if (is_calibrating) arguments << QStringLiteral("--calibrate");
  process_.start(to_qt(program->string()), arguments);
}

DeviceCheck::~DeviceCheck() {
  process_.disconnect(this);
  process_.closeWriteChannel();
  if (process_.state() != QProcess::NotRunning && !process_.waitForFinished(kPatience_ms)) process_.kill();
  process_.waitForFinished(kPatience_ms);
}

void DeviceCheck::push() {
  ++pushes_;
  view_.is_push_over = false;
  view_.strongest_n = 0.0;
  view_.stop_reason.clear();
  process_.write("push\n");
}

void DeviceCheck::read_lines() {
  while (process_.canReadLine()) {
    const QStringList fields = QString::fromUtf8(process_.readLine()).trimmed().split('\t');
    if (fields.first() == QLatin1String("device")) read_device(fields);
    if (fields.first() == QLatin1String("state")) read_state(fields);
  }
  Q_EMIT changed();
}

void DeviceCheck::read_device(const QStringList& fields) {
  constexpr int kFields = 6;
  if (fields.size() < kFields) return;
  view_.state = DeviceCheckView::State::kAnswers;
  view_.text = fields[2];
  view_.push_n = fields[4].toDouble();
  view_.has_force = fields[5] == QLatin1String("1");
}

void DeviceCheck::read_state(const QStringList& fields) {
  constexpr int kFields = 12;
  if (fields.size() < kFields) return;
  for (int i = 0; i < 3; ++i) {
    view_.p_D[i] = fields[1 + i].toDouble();
    view_.axis_D[i] = fields[4 + i].toDouble();
  }
  view_.buttons = fields[7].toUInt();
  view_.state = fields[8] == QLatin1String("1") ? DeviceCheckView::State::kAnswers : DeviceCheckView::State::kUnplugged;
  view_.force_n = fields[9].toDouble();
  view_.strongest_n = std::max(view_.strongest_n, view_.force_n);
  view_.is_push_over = pushes_ > 0 && fields[11].toInt() >= pushes_;
  const bool is_stopped = pushes_ > 0 && fields[10] != QString::fromLatin1(to_string(telemetry::GateFault::kNone));
  view_.stop_reason = is_stopped ? QString(fields[10]).replace('_', ' ') : QString();
  if (!view_.has_pose) first_p_D_ = view_.p_D;
  view_.has_pose = true;
  view_.moved_mm = std::max(view_.moved_mm, (view_.p_D - first_p_D_).norm());
}

void DeviceCheck::note_end() {
  const QString line = last_line(process_.readAllStandardError());
  if (const auto error = attempt::error_of_line(to_std(line))) return fail_with(sentence_of(*error), line);
  fail_with(tr("The device test ended unexpectedly."), line);
}

void DeviceCheck::fail_with(const QString& text, const QString& details) {
  view_.state = DeviceCheckView::State::kFailed;
  view_.text = text;
  view_.details = details;
  Q_EMIT changed();
}

}  // namespace trocar::trainer
