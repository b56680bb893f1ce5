#include "views/ultrasound/scanner_view.h"

#include <QBoxLayout>

#include "views/ultrasound/ultrasound_controls.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
namespace {

constexpr int kLeastPicture_px = 300;

}  // namespace

ScannerView::ScannerView(UltrasoundView& view, UltrasoundControls& controls)
    : controls_(controls), parts_(new QBoxLayout(QBoxLayout::LeftToRight, this)) {
  parts_->setContentsMargins(0, 0, 0, 0);
  parts_->setSpacing(0);
  parts_->addWidget(&view, 1);
  parts_->addWidget(&controls);
  controls.hide();
}

void ScannerView::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  const bool is_narrow = width() < controls_.sizeHint().width() + kLeastPicture_px;
  parts_->setDirection(is_narrow ? QBoxLayout::TopToBottom : QBoxLayout::LeftToRight);
  // One below the other, each has half of the height.
  parts_->setStretch(1, is_narrow ? 1 : 0);
}

}  // namespace trocar::trainer
