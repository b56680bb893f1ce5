#include "ui_kit/wheel_guard.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <memory>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

constexpr int kNotch = 120;

/// Controls in a scroll area that is too low for them.
struct WheelGuardTest : ::testing::Test {
  WheelGuardTest() {
    qApp->installEventFilter(&guard);
    auto* content = new QWidget;
    auto* column = new QVBoxLayout(content);
    choice->addItems({QStringLiteral("one"), QStringLiteral("two"), QStringLiteral("three")});
    for (QWidget* widget : std::initializer_list<QWidget*>{slider, choice, number}) column->addWidget(widget);
    column->addSpacing(1000);
    area.reset(make_scrolled(*content));
    area->resize(200, 200);
    area->show();
    QCoreApplication::processEvents();
  }
  /// True where the widget or the guard kept the event; else the window system offers it to the parents, which scroll.
  bool turn(QWidget& widget) {
    const QPointF at(widget.rect().center());
    QWheelEvent event(at, QPointF(widget.mapToGlobal(at.toPoint())), {}, {0, -kNotch}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&widget, &event);
    return event.isAccepted();
  }

  WheelGuard guard;
  QSlider* slider = new QSlider(Qt::Horizontal);
  QComboBox* choice = new QComboBox;
  QDoubleSpinBox* number = new QDoubleSpinBox;
  std::unique_ptr<QScrollArea> area;
};

TEST_F(WheelGuardTest, TheWheelScrollsOverControlsWithoutFocus) {
  slider->setValue(50);
  choice->setCurrentIndex(1);
  number->setValue(5.0);
  area->setFocus();
  for (QWidget* widget : std::initializer_list<QWidget*>{slider, choice, number})
    EXPECT_FALSE(turn(*widget)) << widget->metaObject()->className();
  turn(*area->viewport());
  EXPECT_GT(area->verticalScrollBar()->value(), 0);
  EXPECT_EQ(slider->value(), 50);
  EXPECT_EQ(choice->currentIndex(), 1);
  EXPECT_EQ(number->value(), 5.0);
}

TEST_F(WheelGuardTest, TheWheelTurnsTheControlWithTheFocus) {
  slider->setValue(50);
  slider->setFocus();
  EXPECT_TRUE(turn(*slider));
  EXPECT_LT(slider->value(), 50);
  choice->setFocus();
  EXPECT_TRUE(turn(*choice));
  EXPECT_EQ(choice->currentIndex(), 1);
  number->setValue(5.0);
  number->setFocus();
  EXPECT_TRUE(turn(*number));
  EXPECT_LT(number->value(), 5.0);
  EXPECT_EQ(area->verticalScrollBar()->value(), 0);
}

TEST_F(WheelGuardTest, TheWheelGivesNoFocus) {
  for (QWidget* widget : std::initializer_list<QWidget*>{slider, choice, number})
    EXPECT_NE(widget->focusPolicy(), Qt::WheelFocus) << widget->metaObject()->className();
}

}  // namespace
}  // namespace trocar::trainer
