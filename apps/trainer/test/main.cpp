// The tests of the trainer's views: one application for all of them, on a screen (scripts/with_display). Its settings
// are the tests' own.
#include <gtest/gtest.h>

#include <QApplication>
#include <QSettings>
#include <QTemporaryDir>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/testing/run_all_tests.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QApplication application(argc, argv);
  const char* wanted = std::getenv("LC_NUMERIC");
  if (wanted != nullptr && std::string_view(std::setlocale(LC_NUMERIC, nullptr)) != wanted) {
    std::fprintf(stderr, "error: Qt did not take over the locale %s of LC_NUMERIC\n", wanted);
    return 1;
  }
  const QTemporaryDir settings;
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
  trocar::trainer::apply_theme(application);
  // As main() does; else numbers have the desktop's decimal sign.
  if (const auto status = trocar::trainer::speak(application, QStringLiteral("en")); !status) return 1;
  return trocar::testing::run_all_tests();
}
