#include "ui_kit/control_section.h"

#include <QGridLayout>
#include <QLabel>
#include <QVBoxLayout>
#include <QWidget>

#include "ui_kit/parts.h"

namespace trocar::trainer {

QVBoxLayout* make_section(QWidget*& widget, const QString& heading) {
  widget = new QWidget;
  auto* box = new QVBoxLayout(widget);
  box->setContentsMargins(0, 0, 0, 0);
  box->setSpacing(6);
  if (!heading.isEmpty()) box->addWidget(make_label(heading, "dim"));
  return box;
}

QGridLayout* make_control_grid() {
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(5);
  grid->setColumnStretch(1, 1);
  return grid;
}

}  // namespace trocar::trainer
