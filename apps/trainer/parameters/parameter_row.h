#pragma once

#include <QLineEdit>
#include <QSlider>
#include <QString>
#include <QWidget>

#include "anatomy/tissue/tissue_parameters.h"
#include "parameters/parameter_scale.h"

class QLabel;
class QToolButton;

namespace trocar::trainer {

/// A slider whose groove marks the default and the range that its source thinks possible. The wheel turns it only
/// while it has the focus, so that a list of sliders can be scrolled.
class MarkedSlider : public QSlider {
  Q_OBJECT

 public:
  explicit MarkedSlider(QWidget* parent = nullptr);
  /// Positions of the slider; low == high: no range is known.
  void set_marks(int default_position, int low, int high);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  double x_of(int position) const;
  int default_ = 0, low_ = 0, high_ = 0;
};

/// A field for a number. Ctrl+Z undoes typing while something is typed, else it is the panel's. Escape gives back what
/// was there.
class NumberField : public QLineEdit {
  Q_OBJECT

 public:
  using QLineEdit::QLineEdit;
  void show_number(const QString& text);

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QString shown_;
};

/// One number: name, field, unit, reset, and a slider below. Object names, with NAME = "parameter-liver-k": NAME
/// (field), NAME-slider, NAME-reset, NAME-refused. Keys: Enter takes the number, Escape gives the last one back, arrows
/// and page keys move the slider.
class ParameterRow : public QWidget {
  Q_OBJECT

 public:
  /// `parameter`: with its default.
  ParameterRow(const anatomy::TissueParameter& parameter, const QString& name, QWidget* parent = nullptr);
  const anatomy::TissueParameter& parameter() const noexcept { return parameter_; }
  void show_value(double value);
  /// Dimmed: the chosen force model does not feel it.
  void set_felt(bool is_felt);
  /// Under the field; empty hides it.
  void show_refusal(const QString& text);

 Q_SIGNALS:
  /// `joins`: with the last one, while the slider is held.
  void edited(double value, bool joins);
  void reset_asked();

 private:
  void make_parts(const QString& name);
  QString tooltip() const;
  void take_text();
  void take_slider(int position);

  anatomy::TissueParameter parameter_;
  ParameterScale scale_;
  double value_;
  bool is_held_ = false;  ///< The slider has moved since it was pressed.
  QLabel* caption_;
  NumberField* field_;
  MarkedSlider* slider_;
  QToolButton* reset_;
  QLabel* refusal_;
};

}  // namespace trocar::trainer
