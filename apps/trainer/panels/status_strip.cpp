#include "panels/status_strip.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kServedWell = 0.999;
constexpr double kServedBadly = 0.98;

QString colored(const QString& text, const QColor& color) {
  return QStringLiteral("<span style='color:%1'>%2</span>").arg(color.name(), text.toHtmlEscaped());
}

/// Figures of a server, from least to most detail.
enum Detail { kShare, kRate, kAll };

QString line_text(const ServerLine& line, int detail) {
  const Theme& t = theme();
  const QString name = QStringLiteral("<b>%1</b> ").arg(line.tool.toHtmlEscaped());
  if (!line.is_connected) return name + colored(StatusStrip::tr("not connected"), t.warning);
  if (!line.fault.isEmpty())
    return name +
           colored(detail == kAll ? StatusStrip::tr("fault: %1").arg(line.fault) : StatusStrip::tr("fault"), t.bad);
  const QColor served = line.served >= kServedWell ? t.good : line.served >= kServedBadly ? t.warning : t.bad;
  const QString share =
      StatusStrip::tr("%1 % on time").arg(100.0 * line.served, 0, 'f', line.served >= kServedBadly ? 2 : 1);
  if (detail == kShare) return name + colored(share, served);
  QString text = name + colored(StatusStrip::tr("%1 Hz, %2").arg(line.rate_hz, 0, 'f', 0).arg(share), served);
  if (detail == kRate) return text;
  text += colored(StatusStrip::tr(" · %1 µs late").arg(line.lateness_p99_us, 0, 'f', 0), t.dim);
  if (line.ticks_missing > 0) text += colored(StatusStrip::tr(" · %1 ticks lost").arg(line.ticks_missing), t.warning);
  if (!line.is_real_time) text += colored(StatusStrip::tr(" · no real-time scheduling"), t.warning);
  return text;
}

}  // namespace

StatusStrip::StatusStrip(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("status-strip"));
  setProperty("role", "bar");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(16, 6, 8, 6);
  row->setSpacing(20);
  needle_ = make_label(tr("No attempt is running: forces are off"), "dim");
  probe_ = make_label({});
  frames_ = make_label({}, "dim");
  needle_->setObjectName(QStringLiteral("status-needle"));
  probe_->setObjectName(QStringLiteral("status-probe"));
  frames_->setObjectName(QStringLiteral("status-frames"));
  frames_->setToolTip(tr("Frames of the last second and the slowest of them; late: frames of this attempt over %1 ms")
                          .arg(1e3 * FrameCount::kLate_s, 0, 'f', 0));
  row->addWidget(needle_);
  row->addWidget(probe_);
  row->addStretch();
  row->addWidget(frames_);
  stop_ = make_button("force-stop", tr("STOP FORCES"),
                      tr("Switches all forces off at once; press again to switch them on (Space)"));
  stop_->setProperty("role", "stop");
  stop_->setFocusPolicy(Qt::NoFocus);
  row->addWidget(stop_);
  for (QLabel* label : {needle_, probe_, frames_}) label->setMinimumWidth(1);  // the button is never shrunk
  connect(stop_, &QPushButton::clicked, this, &StatusStrip::toggle_requested);
  show_forces(false, false);
}

void StatusStrip::show_servers(const std::vector<ServerLine>& servers) {
  if (servers == shown_) return;
  shown_ = servers;
  fit_texts();
}

void StatusStrip::show_frames(const FrameFigures& frames) {
  QString text = tr("%1 frames/s, slowest %2 ms").arg(frames.per_s, 0, 'f', 0).arg(frames.slowest_ms, 0, 'f', 0);
  if (frames.late > 0) text += tr(" · %1 of %2 late").arg(frames.late).arg(frames.judged);
  if (frames_->text() == text) return;
  frames_->setText(text);
  fit_texts();
}

void StatusStrip::set_texts(int detail) {
  QLabel* labels[] = {needle_, probe_};
  for (std::size_t s = 0; s < 2; ++s) {
    const bool is_there = s < shown_.size();
    labels[s]->setText(is_there ? line_text(shown_[s], detail) : QString());
    labels[s]->setToolTip(is_there ? line_text(shown_[s], kAll) +
                                         tr("<br>Granted by the system: %1").arg(shown_[s].grant.toHtmlEscaped())
                                   : QString());
  }
  if (shown_.empty()) needle_->setText(tr("No attempt is running: forces are off"));
}

void StatusStrip::fit_texts() {
  frames_->show();
  for (int detail = kAll; detail >= kShare; --detail) {
    set_texts(detail);
    if (layout()->sizeHint().width() <= width()) return;
  }
  frames_->hide();
}

void StatusStrip::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  fit_texts();
}

void StatusStrip::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) fit_texts();
}

void StatusStrip::show_forces(bool is_attempt, bool are_stopped) {
  if (stop_->isEnabled() != is_attempt) stop_->setEnabled(is_attempt);
  const QString text = is_attempt && are_stopped ? tr("RESUME FORCES") : tr("STOP FORCES");
  if (stop_->text() == text) return;
  stop_->setText(text);
  fit_texts();
}

}  // namespace trocar::trainer
