#include "ui_kit/banner.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QEvent>
#include <QLineEdit>
#include <QTabBar>
#include <algorithm>
#include <utility>
#include <vector>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr int kBannerMargin_px = 8;
constexpr int kPlaceStep_px = 8;
constexpr int kWidest_px = 900;

/// A part of the window that should not be covered.
struct Obstacle {
  QRect place;
  double weight;  ///< Cost of a covered pixel.
};

double weight_of(const QWidget& widget) {
  constexpr double kControl = 1.0, kText = 0.02;
  const auto is_a = [&](auto* type) { return qobject_cast<decltype(type)>(&widget) != nullptr; };
  if (is_a(static_cast<const QAbstractButton*>(nullptr)) || is_a(static_cast<const QComboBox*>(nullptr)) ||
      is_a(static_cast<const QLineEdit*>(nullptr)) || is_a(static_cast<const QAbstractSpinBox*>(nullptr)) ||
      is_a(static_cast<const QAbstractSlider*>(nullptr)) || is_a(static_cast<const QAbstractItemView*>(nullptr)) ||
      is_a(static_cast<const QTabBar*>(nullptr)))
    return kControl;
  const auto* label = qobject_cast<const QLabel*>(&widget);
  return label != nullptr && !label->text().isEmpty() ? kText : 0.0;
}

std::vector<Obstacle> obstacles_in(const QWidget& area, const QWidget& banner) {
  std::vector<Obstacle> found;
  for (const QWidget* widget : area.findChildren<QWidget*>()) {
    if (widget == &banner || !widget->isVisible()) continue;
    const double weight = weight_of(*widget);
    if (weight <= 0.0) continue;
    found.push_back({QRect(widget->mapTo(&area, QPoint(0, 0)), widget->size()), weight});
  }
  return found;
}

double covered(const std::vector<Obstacle>& obstacles, const QRect& place) {
  double sum = 0.0;
  for (const Obstacle& obstacle : obstacles) {
    const QRect both = obstacle.place.intersected(place);
    if (!both.isEmpty()) sum += obstacle.weight * both.width() * both.height();
  }
  return sum;
}

QColor color_of(BannerKind kind) {
  switch (kind) {
    case BannerKind::kError:
      return theme().bad;
    case BannerKind::kWarning:
      return theme().warning;
    case BannerKind::kSuccess:
      break;
  }
  return theme().good;
}

}  // namespace

Banner::Banner(QWidget& area) : QLabel(&area), area_(area) {
  setObjectName(QStringLiteral("banner"));
  setAlignment(Qt::AlignCenter);
  setWordWrap(true);
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hide();
  area.installEventFilter(this);
  message_timer_.setSingleShot(true);
  connect(&message_timer_, &QTimer::timeout, this, [this] { display(state_); });
  constexpr int kPlaceEvery_ms = 500;  // docks and panels appear and disappear below it
  placing_.setInterval(kPlaceEvery_ms);
  connect(&placing_, &QTimer::timeout, this, &Banner::place);
}

void Banner::set_state(const QString& text, BannerKind kind) {
  if (state_.text == text && state_.kind == kind) return;
  state_ = {text, kind};
  if (text.isEmpty() && message_timer_.isActive()) return;
  message_timer_.stop();
  display(state_);
}

void Banner::show_message(const QString& text, BannerKind kind) {
  message_timer_.start(kMessage_ms);
  display({text, kind});
}

void Banner::display(const Message& message) {
  setVisible(!message.text.isEmpty());
  if (message.text.isEmpty()) return placing_.stop();
  setText(message.text);
  setStyleSheet(QStringLiteral("background: %1; color: %2; font-weight: 600; padding: 6px 14px; border-radius: 6px;")
                    .arg(color_of(message.kind).name(), theme().ground.name()));
  place();
  raise();
  placing_.start();
}

void Banner::place() {
  if (isHidden()) return;
  const int widest = std::min(area_.width() - 2 * kBannerMargin_px, kWidest_px);
  setWordWrap(false);
  int width = sizeHint().width();
  setWordWrap(true);
  width = std::min(width, widest);
  setGeometry(free_place({width, heightForWidth(width)}));
}

/// The first position with the least covered area, from top to bottom; the centre is preferred to the sides.
QRect Banner::free_place(const QSize& size) const {
  const std::vector<Obstacle> obstacles = obstacles_in(area_, *this);
  const int middle = (area_.width() - size.width()) / 2;
  const int right = area_.width() - size.width() - kBannerMargin_px;
  QRect best(QPoint(middle, kBannerMargin_px), size);
  double least = covered(obstacles, best);
  for (int y = kBannerMargin_px; y + size.height() + kBannerMargin_px <= area_.height() && least > 0.0;
       y += kPlaceStep_px) {
    for (const int x : {middle, right, kBannerMargin_px}) {
      const QRect place(QPoint(x, y), size);
      const double now = covered(obstacles, place);
      if (now >= least) continue;
      least = now;
      best = place;
    }
  }
  return best;
}

bool Banner::eventFilter(QObject* watched, QEvent* event) {
  if (watched == &area_ && event->type() == QEvent::Resize) place();
  return QLabel::eventFilter(watched, event);
}

}  // namespace trocar::trainer
