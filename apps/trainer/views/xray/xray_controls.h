#pragma once

#include <QWidget>
#include <vector>

class QCheckBox;
class QComboBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QSlider;

namespace trocar::trainer {

class XrayView;

/// Controls of an X-ray view: pedal, contrast agent, C-arm, field and collimation, pulses and dose, subtraction and
/// road map. Always displays the settings of the view. Scrolls if there is not enough space. In a replay only the
/// display of the image can be changed.
class XrayControls : public QWidget {
  Q_OBJECT
 public:
  explicit XrayControls(XrayView& view, QWidget* parent = nullptr);

  QSize sizeHint() const override { return {270, 600}; }

 private:
  QWidget* make_pedals();
  QWidget* make_c_arm();
  QWidget* make_exposure();
  QWidget* make_image();
  QSlider* add_slider(QGridLayout& grid, const char* name, const QString& label, const QString& tooltip, int low,
                      int high, QLabel*& value);
  QComboBox* add_choice(QGridLayout& grid, const char* name, const QString& label, const QString& tooltip);
  void show_view();

  XrayView& view_;
  std::vector<QWidget*> live_;  ///< Disabled in a replay.
  QPushButton *pedal_ = nullptr, *inject_ = nullptr;
  QSlider *lao_ = nullptr, *cranial_ = nullptr, *across_ = nullptr, *along_ = nullptr, *table_ = nullptr;
  QLabel *lao_value_ = nullptr, *cranial_value_ = nullptr, *across_value_ = nullptr, *along_value_ = nullptr,
         *table_value_ = nullptr;
  QComboBox *field_ = nullptr, *pulses_ = nullptr, *dose_ = nullptr, *mode_ = nullptr;
  QCheckBox* inverted_ = nullptr;
};

}  // namespace trocar::trainer
