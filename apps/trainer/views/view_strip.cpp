#include "views/view_strip.h"

#include <QHBoxLayout>
#include <QPainter>
#include <cmath>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr int kMargin = 8;

}  // namespace

ViewStrip::ViewStrip(QWidget& view, Paint paint) : QWidget(&view), view_(view), paint_(std::move(paint)) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(kMargin, 3, kMargin, 3);
  row->addStretch(1);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void ViewStrip::add_button(QWidget& button) {
  button_ = &button;
  layout()->addWidget(&button);
}

double ViewStrip::height_in_view() const {
  return parentWidget() == &view_ ? sizeHint().height() : 0.0;
}

void ViewStrip::follow_view() {
  if (parentWidget() == &view_) setGeometry(0, 0, view_.width(), sizeHint().height());
}

void ViewStrip::refresh(const QString& shown) {
  if (shown == shown_) return;
  shown_ = shown;
  update();
}

QSize ViewStrip::sizeHint() const {
  return {60, static_cast<int>(std::ceil(QFontMetricsF(scaled_font(0.95)).height())) + 8};
}

void ViewStrip::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const double right = button_ != nullptr ? button_->x() : width();
  paint_(painter, QRectF(kMargin, 0.0, right - 2.0 * kMargin, height()));
}

}  // namespace trocar::trainer
