#include "shell/status_strip.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

#include "shell/parts.h"
#include "shell/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kServedWell = 0.999;
constexpr double kServedBadly = 0.98;

QString colored(const QString& text, const QColor& color) {
  return QStringLiteral("<span style='color:%1'>%2</span>").arg(color.name(), text.toHtmlEscaped());
}

QString line_text(const ServerLine& line) {
  const Theme& t = theme();
  const QString name = QStringLiteral("<b>%1</b> ").arg(line.tool.toHtmlEscaped());
  if (!line.is_connected) return name + colored(StatusStrip::tr("not connected"), t.warning);
  if (!line.fault.isEmpty()) return name + colored(StatusStrip::tr("fault: %1").arg(line.fault), t.bad);
  const QColor served = line.served >= kServedWell ? t.good : line.served >= kServedBadly ? t.warning : t.bad;
  QString text = name + colored(StatusStrip::tr("%1 Hz, %2 % in time")
                                    .arg(line.rate_hz, 0, 'f', 0)
                                    .arg(100.0 * line.served, 0, 'f', line.served >= kServedBadly ? 2 : 1),
                                served);
  text += colored(StatusStrip::tr(" · late by %1 µs").arg(line.lateness_p99_us, 0, 'f', 0), t.dim);
  if (line.ticks_missing > 0) text += colored(StatusStrip::tr(" · %1 ticks lost").arg(line.ticks_missing), t.warning);
  if (!line.is_real_time) text += colored(StatusStrip::tr(" · no real-time permission"), t.warning);
  return text;
}

}  // namespace

StatusStrip::StatusStrip(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("status-strip"));
  setProperty("role", "bar");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(16, 6, 8, 6);
  row->setSpacing(20);
  needle_ = make_label(tr("No attempt is running: no forces"), "dim");
  probe_ = make_label({});
  frames_ = make_label({}, "dim");
  needle_->setObjectName(QStringLiteral("status-needle"));
  probe_->setObjectName(QStringLiteral("status-probe"));
  frames_->setObjectName(QStringLiteral("status-frames"));
  row->addWidget(needle_);
  row->addWidget(probe_);
  row->addStretch();
  row->addWidget(frames_);
  stop_ = make_button("force-stop", tr("STOP FORCES"), tr("Turns all forces off at once; again: on (Space)"));
  stop_->setProperty("role", "stop");
  stop_->setFocusPolicy(Qt::NoFocus);
  row->addWidget(stop_);
  connect(stop_, &QPushButton::clicked, this, [this] { are_on_ ? Q_EMIT stop_wanted() : Q_EMIT resume_wanted(); });
  show_forces(false, false);
}

void StatusStrip::show_servers(const std::vector<ServerLine>& servers) {
  if (servers == shown_) return;
  shown_ = servers;
  QLabel* labels[] = {needle_, probe_};
  for (std::size_t s = 0; s < 2; ++s) {
    labels[s]->setText(s < servers.size() ? line_text(servers[s]) : QString());
    labels[s]->setToolTip(s < servers.size() ? tr("Granted by the system: %1").arg(servers[s].grant) : QString());
  }
  if (servers.empty()) needle_->setText(tr("No attempt is running: no forces"));
}

void StatusStrip::show_frames(double frames_per_s, std::uint64_t dropped) {
  QString text = tr("%1 frames/s").arg(frames_per_s, 0, 'f', 0);
  if (dropped > 0) text += tr(" · %1 late").arg(dropped);
  if (frames_->text() != text) frames_->setText(text);
}

void StatusStrip::show_forces(bool are_possible, bool are_on) {
  are_on_ = are_on;
  stop_->setEnabled(are_possible);
  const QString text = !are_possible || are_on ? tr("STOP FORCES") : tr("FORCES ON AGAIN");
  if (stop_->text() != text) stop_->setText(text);
}

}  // namespace trocar::trainer
