#include "ui_kit/focus_ring.h"

#include <QApplication>
#include <QEvent>
#include <QPainter>
#include <QWidget>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kWidth_px = 2.0;
constexpr double kRadius_px = 5.0;

class Ring final : public QWidget {
 public:
  explicit Ring(QWidget& target) : QWidget(&target) {
    setObjectName(QStringLiteral("focus-ring"));
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setFocusPolicy(Qt::NoFocus);
    target.installEventFilter(this);
    setGeometry(target.rect());
    show();
    raise();
  }

  bool eventFilter(QObject* watched, QEvent* event) override {
    if (watched == parent() && event->type() == QEvent::Resize) setGeometry(parentWidget()->rect());
    return false;
  }

 protected:
  /// Light with a dark line next to it, so that it is visible on any background.
  void paintEvent(QPaintEvent* /*event*/) override {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const auto draw = [&](double inset, const QColor& color, double width) {
      painter.setPen(QPen(color, width));
      painter.drawRoundedRect(QRectF(rect()).adjusted(inset, inset, -inset, -inset), kRadius_px, kRadius_px);
    };
    draw(kWidth_px + 0.5, theme().ground, 1.0);
    draw(0.5 * kWidth_px, theme().text, kWidth_px);
  }
};

bool is_page(const QWidget& widget) {
  return widget.isWindow() || widget.objectName().endsWith(QLatin1String("-page"));
}

}  // namespace

FocusRing::FocusRing(QObject* parent) : QObject(parent) {
  connect(qApp, &QApplication::focusChanged, this, [this](QWidget* /*before*/, QWidget* now) { show_on(now); });
}

FocusRing::~FocusRing() {
  delete ring_;
}

void FocusRing::show_on(QWidget* widget) {
  if (widget == target()) return;
  delete ring_;
  if (widget != nullptr && !is_page(*widget)) ring_ = new Ring(*widget);
}

QWidget* FocusRing::target() const {
  return ring_ != nullptr ? ring_->parentWidget() : nullptr;
}

}  // namespace trocar::trainer
