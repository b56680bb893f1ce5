// The tests of the trainer's views: one application for all of them, on a screen (scripts/with_display). Its settings
// are the tests' own.
#include <gtest/gtest.h>

#include <QApplication>
#include <QSettings>
#include <QTemporaryDir>

#include "core/testing/run_all_tests.h"
#include "ui_kit/theme.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QApplication application(argc, argv);
  const QTemporaryDir settings;
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
  trocar::trainer::apply_theme(application);
  return trocar::testing::run_all_tests();
}
