// trocar-trainer: the desktop that a trainee sits at.
#include <QApplication>

#include "shell/theme.h"

int main(int argc, char** argv) {
  QApplication application(argc, argv);
  trocar::trainer::apply_theme(application);
  return 0;
}
