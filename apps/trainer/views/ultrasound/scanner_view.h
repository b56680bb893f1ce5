#pragma once

#include <QWidget>

class QBoxLayout;

namespace trocar::trainer {

class UltrasoundControls;
class UltrasoundView;

/// An ultrasound view and its controls, which are initially hidden: beside the image, or below it if the image would
/// become too narrow.
class ScannerView : public QWidget {
  Q_OBJECT

 public:
  ScannerView(UltrasoundView& view, UltrasoundControls& controls);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  UltrasoundControls& controls_;
  QBoxLayout* parts_;
};

}  // namespace trocar::trainer
