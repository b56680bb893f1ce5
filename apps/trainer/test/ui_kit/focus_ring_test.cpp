#include "ui_kit/focus_ring.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QListWidget>
#include <QPushButton>
#include <QRadioButton>
#include <QVBoxLayout>

#include "script/widget_events.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

TEST(FocusRing, OutlinesOnlyTheFocusedControl) {
  QWidget page;
  page.setObjectName(QStringLiteral("start-page"));
  auto* column = new QVBoxLayout(&page);
  auto* list = new QListWidget;
  auto* radio = new QRadioButton(QStringLiteral("Guided"));
  auto* button = new QPushButton(QStringLiteral("Start"));
  button->setProperty("role", "primary");
  const std::initializer_list<QWidget*> controls{list, radio, button};
  for (QWidget* control : controls) column->addWidget(control);
  page.resize(300, 300);
  page.show();
  QCoreApplication::processEvents();
  const auto ring_share = [](QWidget& widget) {
    // Of a strip along the upper edge, clear of any text.
    return share_near(widget.grab(QRect(0, 0, widget.width(), 2)).toImage(), theme().text, 20);
  };
  FocusRing ring;
  for (QWidget* shown : controls) {
    ring.show_on(shown);
    EXPECT_EQ(ring.target(), shown);
    for (QWidget* control : controls)
      EXPECT_EQ(ring_share(*control) > 0.5, control == shown) << control->metaObject()->className();
  }
  ring.show_on(&page);
  EXPECT_EQ(ring.target(), nullptr);
  ring.show_on(nullptr);
  EXPECT_EQ(ring.target(), nullptr);
}

TEST(FocusRing, FollowsResizeAndDeletionOfItsTarget) {
  QWidget window;
  auto* button = new QPushButton(QStringLiteral("Begin"), &window);
  window.show();
  FocusRing ring;
  ring.show_on(button);
  button->resize(180, 60);
  QCoreApplication::processEvents();
  EXPECT_EQ(button->findChild<QWidget*>(QStringLiteral("focus-ring"))->size(), button->size());
  delete button;
  EXPECT_EQ(ring.target(), nullptr);
  ring.show_on(nullptr);
}

}  // namespace
}  // namespace trocar::trainer
