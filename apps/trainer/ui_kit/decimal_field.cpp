#include "ui_kit/decimal_field.h"

#include <QKeyEvent>
#include <QLineEdit>
#include <QLocale>
#include <QRegularExpression>
#include <QToolTip>

namespace trocar::trainer {

QString DecimalField::without_affixes(const QString& text) const {
  QString bare = text;
  if (!prefix().isEmpty() && bare.startsWith(prefix())) bare.remove(0, prefix().size());
  if (!suffix().isEmpty() && bare.endsWith(suffix())) bare.chop(suffix().size());
  return bare.trimmed();
}

QValidator::State DecimalField::validate(QString& text, int& position) const {
  Q_UNUSED(position)
  static const QRegularExpression kNumber(QStringLiteral("^-?\\d{0,9}(?:[.,](\\d*))?$"));
  const QString bare = without_affixes(text);
  const QRegularExpressionMatch match = kNumber.match(bare);
  if (!match.hasMatch() || match.capturedLength(1) > decimals()) return QValidator::Invalid;
  if (bare.startsWith(QLatin1Char('-')) && minimum() >= 0.0) return QValidator::Invalid;
  if (!bare.contains(QRegularExpression(QStringLiteral("\\d")))) return QValidator::Intermediate;
  const double number = valueFromText(text);
  if (number > maximum() && maximum() >= 0.0) return QValidator::Invalid;  // more digits do not make it smaller
  return number >= minimum() && number <= maximum() ? QValidator::Acceptable : QValidator::Intermediate;
}

double DecimalField::valueFromText(const QString& text) const {
  QString plain = without_affixes(text);
  return QLocale::c().toDouble(plain.replace(QLatin1Char(','), QLatin1Char('.')));
}

QString DecimalField::textFromValue(double value) const {
  QLocale locale = this->locale();
  locale.setNumberOptions(QLocale::OmitGroupSeparator);
  QString text = locale.toString(value, 'f', decimals());
  const int sign = text.indexOf(locale.decimalPoint());
  if (sign < 0) return text;
  while (text.endsWith(locale.zeroDigit())) text.chop(1);
  if (text.size() == sign + 1) text.chop(1);
  return text;
}

void DecimalField::fixup(QString& text) const {
  Q_UNUSED(text)
}

void DecimalField::keyPressEvent(QKeyEvent* event) {
  const QString before = text();
  const bool is_sign = !event->text().isEmpty() && event->text().at(0).isPrint() && !lineEdit()->hasSelectedText();
  QDoubleSpinBox::keyPressEvent(event);
  if (!is_sign || text() != before) return;
  const QString range = tr("%1 to %2, decimals: at most %3")
                            .arg(textFromValue(minimum()), textFromValue(maximum()), locale().toString(decimals()));
  QToolTip::showText(mapToGlobal(QPoint(0, height())), range, this);
}

}  // namespace trocar::trainer
