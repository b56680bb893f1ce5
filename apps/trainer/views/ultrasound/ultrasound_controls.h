#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "ultrasound/scanner/display_settings.h"
#include "views/ultrasound/ultrasound_view.h"

class QBoxLayout;
class QCheckBox;
class QComboBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QSlider;

namespace trocar::trainer {

/// Controls of an ultrasound view: transducer and preset, freeze and cine loop, image, TGC, measurements, needle guide,
/// Doppler. Always displays the settings of the view. Scrolls if there is not enough space.
class UltrasoundControls : public QWidget {
  Q_OBJECT
 public:
  explicit UltrasoundControls(UltrasoundView& view, QWidget* parent = nullptr);

  QSize sizeHint() const override { return {288, 640}; }

 private:
  /// A slider for one number of the settings.
  struct Control {
    QSlider* slider = nullptr;
    QLabel* value = nullptr;
    double step = 1.0;
    std::function<double&(UltrasoundSettings&)> number;
    std::function<QString(double)> text;
  };
  struct Check {
    QCheckBox* box = nullptr;
    std::function<bool&(UltrasoundSettings&)> flag;
  };
  struct ControlSpec {
    const char* name;
    QString label, tooltip;
    double low, high, step;
    std::function<double&(UltrasoundSettings&)> number;
    std::function<QString(double)> text;
    std::function<void(double)> set = {};  ///< Empty: sets `number`.
  };

  void load_tables();
  QWidget* make_source();
  QWidget* make_freeze();
  QWidget* make_picture();
  QWidget* make_tgc();
  QWidget* make_measuring();
  QWidget* make_guide();
  QWidget* make_doppler();
  void add_control(QGridLayout& grid, const ControlSpec& spec);
  QCheckBox* add_check(QBoxLayout& box, const char* name, const QString& text, const QString& tooltip,
                       std::function<bool&(UltrasoundSettings&)> flag);
  void apply_preset(int index);
  void set_ranges();
  void show_view();

  UltrasoundView& view_;
  std::vector<ultrasound::Transducer> transducers_;
  std::vector<ultrasound::ScanPreset> presets_;
  std::vector<Control> controls_;
  std::vector<Check> checks_;
  QComboBox *transducer_ = nullptr, *engine_ = nullptr;
  QComboBox* preset_ = nullptr;
  QComboBox* gray_map_ = nullptr;
  QPushButton *zoom_out_ = nullptr, *zoom_reset_ = nullptr;
  QPushButton* automatic_ = nullptr;
  QPushButton* freeze_ = nullptr;
  QSlider* cine_ = nullptr;
  QWidget* cine_row_ = nullptr;
  QPushButton* play_ = nullptr;
  std::vector<QPushButton*> tools_;
  QPushButton* undo_ = nullptr;
  QPushButton* remove_ = nullptr;
  QPushButton* clear_ = nullptr;
  QWidget* guide_ = nullptr;
  QCheckBox* axis_ = nullptr;
  QWidget* doppler_controls_ = nullptr;
  QCheckBox* doppler_ = nullptr;
  QCheckBox* harmonic_ = nullptr;
};

}  // namespace trocar::trainer
