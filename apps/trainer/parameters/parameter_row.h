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

/// A slider whose groove marks the default and the plausible range of its source. The wheel moves it only while it has
/// the focus, so that a list of sliders can be scrolled.
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

/// A field for a number. Ctrl+Z undoes unfinished input; without such input, the panel handles it. Escape restores the
/// previous text.
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

/// Row of one number: name, field, unit, reset, and a slider below. Object names, with NAME = "parameter-liver-k": NAME
/// (field), NAME-slider, NAME-reset, NAME-refused. Keys: Enter applies the number, Escape restores the last one, arrows
/// and page keys move the slider.
class ParameterRow : public QWidget {
  Q_OBJECT

 public:
  /// `parameter` includes its default.
  ParameterRow(const anatomy::TissueParameter& parameter, const QString& name, QWidget* parent = nullptr);
  const anatomy::TissueParameter& parameter() const noexcept { return parameter_; }
  void show_value(double value);
  /// False dims the row: the selected force model does not use the parameter.
  void set_felt(bool is_felt);
  /// Shows the reason below the field; empty hides it.
  void show_refusal(const QString& text);

 Q_SIGNALS:
  /// `joins`: true for further changes while the slider is held.
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
  bool is_held_ = false;  ///< The slider was moved since it was pressed.
  QLabel* caption_;
  NumberField* field_;
  MarkedSlider* slider_;
  QToolButton* reset_;
  QLabel* refusal_;
};

}  // namespace trocar::trainer
