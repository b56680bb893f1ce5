#pragma once

#include <QDoubleSpinBox>

namespace trocar::trainer {

/// A number that people type as they are used to: with a decimal point or a comma, whatever the locale. There are no
/// group separators: "1.234" and "1,234" are both 1.234. Shown with the locale's sign, without zeros at the end.
class DecimalField : public QDoubleSpinBox {
  Q_OBJECT

 public:
  using QDoubleSpinBox::QDoubleSpinBox;

  QValidator::State validate(QString& text, int& position) const override;
  double valueFromText(const QString& text) const override;
  QString textFromValue(double value) const override;
  /// Qt's own takes the locale's group separators out, which would make 35 of "3.5".
  void fixup(QString& text) const override;

 protected:
  /// A key that the number has no place for is not taken; what the field takes is then shown beside it.
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QString without_affixes(const QString& text) const;
};

}  // namespace trocar::trainer
