#include "panels/status_strip.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QHelpEvent>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QToolButton>
#include <QToolTip>
#include <algorithm>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr int kBesideSymbol_px = 4;  ///< Between symbol and words.
constexpr int kMost_px = 440;        ///< Width of a line of figures.

QColor color_of(Health health) {
  const Theme& t = theme();
  switch (health) {
    case Health::kOff:
    case Health::kStarting:
      return t.dim;
    case Health::kGood:
      return t.good;
    case Health::kStopped:
    case Health::kSlow:
      return t.warning;
    case Health::kInterrupted:
      return t.bad;
  }
  return t.dim;
}

/// Disc: good; ring: off; triangle: slow; square: stopped or interrupted. The shape says it without the colour.
QIcon symbol_of(Health health, int side, double pixel_ratio) {
  QPixmap picture(QSize(side + kBesideSymbol_px, side) * pixel_ratio);
  picture.setDevicePixelRatio(pixel_ratio);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor color = color_of(health);
  const QRectF box = QRectF(0, 0, side, side).adjusted(1.5, 1.5, -1.5, -1.5);
  painter.setPen(QPen(color, 2.0));
  painter.setBrush(health == Health::kOff || health == Health::kStarting ? QBrush(Qt::NoBrush) : QBrush(color));
  if (health == Health::kSlow) {
    const QPointF top(box.center().x(), box.top());
    painter.drawPolygon(QPolygonF({top, box.bottomRight(), box.bottomLeft()}));
  } else if (health == Health::kStopped || health == Health::kInterrupted) {
    painter.drawRect(box);
  } else {
    painter.drawEllipse(box);
  }
  painter.end();
  return QIcon(picture);
}

}  // namespace

StatusStrip::StatusStrip(QWidget* parent)
    : QFrame(parent), keys_(*this, [this](const QKeyEvent& key, const KeyPlace& place) {
        if (key.key() != Qt::Key_Escape || place.is_aside || !shows_details()) return false;
        set_details_shown(false);
        return true;
      }) {
  setObjectName(QStringLiteral("status-strip"));
  setProperty("role", "bar");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 6, 8, 6);
  row->setSpacing(12);
  indicator_ = make_tool_button("status-health", {}, {});
  indicator_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  indicator_->setFocusPolicy(Qt::NoFocus);
  indicator_->setCheckable(true);
  reason_ = make_label({}, "dim");
  reason_->setObjectName(QStringLiteral("status-reason"));
  row->addWidget(indicator_);
  row->addWidget(reason_);
  row->addStretch();
  stop_ = make_button("force-stop", tr("STOP FORCES"),
                      tr("Switches all forces off at once; press again to switch them on (Space)"));
  stop_->setProperty("role", "stop");
  stop_->setFocusPolicy(Qt::NoFocus);
  row->addWidget(stop_);
  details_ = new QFrame(this);
  details_->setObjectName(QStringLiteral("status-details"));
  details_->setProperty("role", "card");
  auto* content = new QVBoxLayout(details_);
  figures_ = make_label({});
  figures_->setObjectName(QStringLiteral("status-figures"));
  figures_->setWordWrap(true);
  content->addWidget(figures_);
  details_->hide();
  connect(stop_, &QPushButton::clicked, this, &StatusStrip::toggle_requested);
  connect(indicator_, &QToolButton::toggled, this, &StatusStrip::set_details_shown);
  report_.health = Health::kInterrupted;  // differs from the state at the start, so that it is displayed
  show_forces(false, false);
}

void StatusStrip::show_servers(const std::vector<ServerLine>& servers) {
  if (servers == input_.servers) return;
  input_.servers = servers;
  const bool are_connected =
      std::all_of(servers.begin(), servers.end(), [](const ServerLine& line) { return line.is_connected; });
  input_.has_started = !servers.empty() && (input_.has_started || are_connected);
  update_health();
}

void StatusStrip::show_frames(const FrameFigures& frames) {
  if (input_.frames && *input_.frames == frames) return;
  input_.frames = frames;
  update_health();
}

void StatusStrip::show_forces(bool is_attempt, bool are_stopped) {
  input_.is_attempt = is_attempt;
  input_.are_forces_stopped = are_stopped;
  if (stop_->isEnabled() != is_attempt) stop_->setEnabled(is_attempt);
  const QString text = is_attempt && are_stopped ? tr("RESUME FORCES") : tr("STOP FORCES");
  if (stop_->text() != text) stop_->setText(text);
  update_health();
}

void StatusStrip::update_health() {
  constexpr qint64 kEvery_ms = 500;  // slow enough to be read
  if (shows_details() && refreshed_.hasExpired(kEvery_ms)) {
    refreshed_.start();
    if (const QString text = health_details(input_); text != figures_->text()) {
      figures_->setText(text);
      place_details();
    }
  }
  const HealthReport report = assess_health(input_);
  if (report == report_) return;
  report_ = report;
  indicator_->setText(report_.words);
  indicator_->setAccessibleName(tr("State of forces and display: %1").arg(report_.words));
  indicator_->setAccessibleDescription(report_.reason);
  reason_->setText(report_.reason);
  reason_->setToolTip(report_.reason);
  update_symbol();
}

void StatusStrip::update_symbol() {
  const int side = fontMetrics().ascent();
  indicator_->setIconSize({side + kBesideSymbol_px, side});
  indicator_->setIcon(symbol_of(report_.health, side, devicePixelRatioF()));
  reason_->setVisible(indicator_->sizeHint().width() + reason_->sizeHint().width() + stop_->sizeHint().width() +
                          4 * layout()->spacing() + 16 <=
                      width());
}

bool StatusStrip::shows_details() const {
  return !details_->isHidden();
}

void StatusStrip::set_details_shown(bool are_shown) {
  if (indicator_->isChecked() != are_shown) return indicator_->setChecked(are_shown);
  if (are_shown) {
    // In the window the frame covers the views above the strip, and is mirrored with them; alone, the strip has no room
    // for it.
    QWidget* area = parentWidget() != nullptr ? parentWidget() : this;
    if (details_->parentWidget() != area) details_->setParent(area);
    refreshed_.start();
    figures_->setText(health_details(input_));
  }
  details_->setVisible(are_shown);
  place_details();
}

void StatusStrip::place_details() {
  if (!shows_details()) return;
  QWidget* around = details_->parentWidget();
  figures_->setFixedWidth(std::min(kMost_px, around->width() - 60));
  details_->adjustSize();
  const QPoint corner = mapTo(around, QPoint(8, -8));
  details_->move(corner.x(), std::max(0, corner.y() - details_->height()));
  details_->raise();
}

bool StatusStrip::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    const auto* help = static_cast<QHelpEvent*>(event);
    if (indicator_->geometry().contains(help->pos())) {
      QToolTip::showText(help->globalPos(), health_details(input_), this);
      return true;
    }
  }
  return QFrame::event(event);
}

void StatusStrip::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  update_symbol();
  place_details();
}

void StatusStrip::moveEvent(QMoveEvent* event) {
  QFrame::moveEvent(event);
  place_details();
}

void StatusStrip::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() != QEvent::FontChange && event->type() != QEvent::StyleChange) return;
  update_symbol();
  place_details();
}

}  // namespace trocar::trainer
