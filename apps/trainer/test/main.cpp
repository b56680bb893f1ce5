// The tests of the trainer's views: one application for all of them, on a screen (scripts/with_display).
#include <gtest/gtest.h>

#include <QApplication>

#include "shell/theme.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QApplication application(argc, argv);
  trocar::trainer::apply_theme(application);
  return RUN_ALL_TESTS();
}
