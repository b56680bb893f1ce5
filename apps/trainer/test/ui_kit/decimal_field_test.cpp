#include "ui_kit/decimal_field.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QKeyEvent>
#include <QLocale>
#include <QToolTip>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

/// Types over the whole text, key by key, and leaves the field with Enter.
double typed(DecimalField& field, const char* text) {
  field.selectAll();
  for (const char* c = text; *c != '\0'; ++c) {
    QKeyEvent press(QEvent::KeyPress, 0, Qt::NoModifier, QString(QLatin1Char(*c)));
    QCoreApplication::sendEvent(&field, &press);
  }
  QKeyEvent enter(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier);
  QCoreApplication::sendEvent(&field, &enter);
  return field.value();
}

struct Field : ::testing::TestWithParam<const char*> {
  Field() {
    field.setLocale(QLocale(QString::fromLatin1(GetParam())));
    field.setRange(0.0, 50.0);
    field.setDecimals(1);
    field.setSuffix(QStringLiteral(" mm"));
    field.setValue(7.0);
  }
  DecimalField field;
};

TEST_P(Field, TakesPointAndComma) {
  EXPECT_EQ(typed(field, "3.5"), 3.5);
  EXPECT_EQ(typed(field, "4,5"), 4.5);
  EXPECT_EQ(typed(field, "12"), 12.0);
  EXPECT_EQ(typed(field, ",5"), 0.5);
  EXPECT_EQ(typed(field, "0.1"), 0.1);
  EXPECT_EQ(typed(field, "6."), 6.0);
}

TEST_P(Field, KeepsItsRangeAndDecimals) {
  EXPECT_EQ(typed(field, "99"), 9.0) << "the second 9 is not taken";
  EXPECT_EQ(typed(field, "3.55"), 3.5) << "the second decimal is not taken";
  EXPECT_EQ(typed(field, "1.2,3"), 1.2) << "a second sign is not taken";
  EXPECT_EQ(typed(field, "-4"), 4.0) << "no negative numbers";
  EXPECT_EQ(typed(field, "2x"), 2.0);
  field.setRange(-20.0, 50.0);
  EXPECT_EQ(typed(field, "-4,5"), -4.5);
}

TEST_P(Field, ShowsTheValidRangeWhenAKeyIsRefused) {
  field.show();
  QToolTip::hideText();
  typed(field, "12.5");
  EXPECT_EQ(to_std(QToolTip::text()), "");
  typed(field, "1.234,5");
  const QString range = QToolTip::text();
  EXPECT_TRUE(range.startsWith(QLatin1Char('0')) && range.contains(QStringLiteral("50"))) << to_std(range);
  QToolTip::hideText();
}

TEST_P(Field, AcceptsItsOwnTextAndStepsByKeys) {
  field.setValue(4.5);
  EXPECT_EQ(to_std(field.cleanText()), to_std(field.locale().toString(4.5, 'f', 1)));
  field.setValue(4.0);
  EXPECT_EQ(to_std(field.cleanText()), to_std(field.locale().toString(4)));
  const QString shown = field.text();
  QString text = shown;
  int position = 0;
  EXPECT_EQ(field.validate(text, position), QValidator::Acceptable) << to_std(shown);
  field.stepUp();
  EXPECT_EQ(field.value(), 5.0);
  field.setRange(0.0, 5000.0);
  field.setValue(1234.5);
  text = field.text();
  EXPECT_EQ(field.valueFromText(text), 1234.5) << to_std(text);
}

INSTANTIATE_TEST_SUITE_P(Locales, Field, ::testing::Values("C", "en_US", "de_DE", "fr_FR", "tr_TR", "ja_JP", "pt_BR"));

}  // namespace
}  // namespace trocar::trainer
