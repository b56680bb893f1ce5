#pragma once

#include <QWidget>

class QBoxLayout;

namespace trocar::trainer {

class UltrasoundControls;
class UltrasoundView;

/// An ultrasound view and its controls, hidden at first: beside the picture, or below it where the picture would become
/// too narrow.
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
