#include "ui_kit/page_keys.h"

#include <gtest/gtest.h>

#include <QAbstractItemView>
#include <QApplication>
#include <QComboBox>
#include <QCoreApplication>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QRadioButton>
#include <QSlider>
#include <QSpinBox>
#include <QVBoxLayout>

#include "control/tool_gestures.h"
#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {

/// A window with a view and controls of every kind.
struct KeysTest : ::testing::Test {
  KeysTest() {
    auto* column = new QVBoxLayout(&window);
    choice->addItems({QStringLiteral("aorta"), QStringLiteral("spleen"), QStringLiteral("vena cava")});
    list->addItems({QStringLiteral("aorta"), QStringLiteral("spleen")});
    view->setFocusPolicy(Qt::StrongFocus);
    for (QWidget* widget : std::initializer_list<QWidget*>{view, choice, list, radio, button, slider, text, number})
      column->addWidget(widget);
    window.show();
    QCoreApplication::processEvents();
  }
  void strike(QWidget& widget, int key) {
    widget.setFocus();
    press_key(widget, key);
  }

  QWidget window;
  QWidget* view = new QWidget;
  QComboBox* choice = new QComboBox;
  QListWidget* list = new QListWidget;
  QRadioButton* radio = new QRadioButton;
  QPushButton* button = new QPushButton;
  QSlider* slider = new QSlider(Qt::Horizontal);
  QLineEdit* text = new QLineEdit;
  QSpinBox* number = new QSpinBox;
};

TEST_F(KeysTest, ReceivesKeysBeforeEveryControl) {
  int seen = 0;
  PageKeys keys(window,
                [&](const QKeyEvent& key, const KeyPlace&) { return key.key() == Qt::Key_Space && ++seen > 0; });
  for (QWidget* widget : std::initializer_list<QWidget*>{view, choice, list, radio, button, slider, text, number})
    strike(*widget, Qt::Key_Space);
  EXPECT_EQ(seen, 8);
  EXPECT_FALSE(radio->isChecked());
  EXPECT_TRUE(text->text().isEmpty());
  QWidget other;
  press_key(other, Qt::Key_Space);
  EXPECT_EQ(seen, 8);
  QWidget floating(&window, Qt::Window);
  press_key(floating, Qt::Key_Space);
  EXPECT_EQ(seen, 9);
}

TEST_F(KeysTest, ReportsTheWidgetOfAKeyPress) {
  KeyPlace place;
  PageKeys keys(window, [&](const QKeyEvent&, const KeyPlace& p) {
    place = p;
    return true;
  });
  strike(*text, Qt::Key_A);
  EXPECT_TRUE(place.is_text);
  strike(*number, Qt::Key_A);
  EXPECT_TRUE(place.is_text);
  strike(*choice, Qt::Key_A);
  EXPECT_FALSE(place.is_text);
  EXPECT_TRUE(place.takes_space);
  strike(*button, Qt::Key_A);
  EXPECT_EQ(place.button, button);
  EXPECT_FALSE(place.is_unclaimed);
}

// Qt closes an open list at the override event of a key, and gives the key to the list's box.
TEST_F(KeysTest, KeyThatClosesAListDoesNothingElse) {
  int seen = 0, aside = 0;
  PageKeys keys(window, [&](const QKeyEvent&, const KeyPlace& place) {
    ++seen;
    aside += place.is_aside ? 1 : 0;
    return false;
  });
  unsigned long time = 100;
  for (const int key : {Qt::Key_Return, Qt::Key_Enter, Qt::Key_Escape}) {
    choice->setFocus();
    choice->showPopup();
    QWidget* popup = QApplication::activePopupWidget();
    ASSERT_NE(popup, nullptr);
    QKeyEvent override_event(QEvent::ShortcutOverride, key, Qt::NoModifier);
    override_event.setTimestamp(++time);
    QCoreApplication::sendEvent(choice->view(), &override_event);
    choice->hidePopup();  // Qt 6 leaves it to the key
    ASSERT_EQ(QApplication::activePopupWidget(), nullptr);
    QKeyEvent down(QEvent::KeyPress, key, Qt::NoModifier);
    down.setTimestamp(time);
    seen = aside = 0;
    QCoreApplication::sendEvent(choice, &down);
    EXPECT_GT(seen, 0);
    EXPECT_EQ(aside, seen) << key;
    QKeyEvent up(QEvent::KeyRelease, key, Qt::NoModifier);
    QCoreApplication::sendEvent(choice, &up);
    seen = aside = 0;
    QKeyEvent next_override(QEvent::ShortcutOverride, key, Qt::NoModifier);
    next_override.setTimestamp(++time);
    QCoreApplication::sendEvent(choice, &next_override);
    QKeyEvent next(QEvent::KeyPress, key, Qt::NoModifier);
    next.setTimestamp(time);
    QCoreApplication::sendEvent(choice, &next);
    EXPECT_EQ(aside, 0) << "the next key acts again";
  }
}

TEST_F(KeysTest, RefusesEndingInsideAList) {
  const ActionRow& end = row_of(Action::kEnd);
  KeyPlace place;
  place.is_choice = true;
  EXPECT_EQ(judge_key(end, QKeyEvent(QEvent::KeyPress, Qt::Key_E, Qt::NoModifier), place), KeyVerdict::kRefuse);
  const ActionRow& yes = row_of(Action::kConfirm);
  EXPECT_NE(judge_key(yes, QKeyEvent(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier), place), KeyVerdict::kPerform);
}

TEST_F(KeysTest, ToolKeysWorkWithAnyFocusAndArrowsThenMoveTheTool) {
  ToolGestures gestures;
  gestures.watch(*view, [] { return ViewScale{}; });
  int moved = 0, fired = 0, clicked = 0, refused = 0;
  PageKeys keys(window, [&](const QKeyEvent& key, const KeyPlace& place) {
    if (press_focused_button(key, place)) return true;
    const auto found = find_action(Scope::kPuncture, key);
    if (!found) return false;
    const KeyVerdict verdict = judge_key(row_of(found->action), key, place);
    if (verdict == KeyVerdict::kRefuse) ++refused;
    if (verdict != KeyVerdict::kPerform) return verdict != KeyVerdict::kPass;
    if (found->action == Action::kFire) return ++fired > 0;
    return gestures.handle_action(*found, place);
  });
  QObject::connect(&gestures, &ToolGestures::gestured, [&] { ++moved; });
  QObject::connect(button, &QPushButton::clicked, [&] { ++clicked; });
  for (QWidget* widget : std::initializer_list<QWidget*>{choice, list, radio, button, slider}) {
    strike(*widget, Qt::Key_S);
    EXPECT_EQ(gestures.active_tool(), ActiveTool::kTransducer) << widget->metaObject()->className();
    EXPECT_EQ(choice->currentText(), QStringLiteral("aorta"));
    press_key(*window.focusWidget(), Qt::Key_PageUp);
    strike(*widget, Qt::Key_A);
    EXPECT_EQ(gestures.active_tool(), ActiveTool::kNeedle) << widget->metaObject()->className();
  }
  EXPECT_EQ(moved, 5);
  // Arrows belong to the control that has the focus.
  choice->setCurrentIndex(0);
  strike(*choice, Qt::Key_Down);
  EXPECT_EQ(choice->currentIndex(), 1);
  slider->setValue(10);
  strike(*slider, Qt::Key_Right);
  EXPECT_EQ(slider->value(), 11);
  EXPECT_EQ(moved, 5);
  strike(*text, Qt::Key_S);
  strike(*number, Qt::Key_S);
  EXPECT_EQ(gestures.active_tool(), ActiveTool::kNeedle);
  for (QWidget* widget : std::initializer_list<QWidget*>{choice, list, slider})
    for (const int key : {Qt::Key_Return, Qt::Key_Enter}) strike(*widget, key);
  EXPECT_EQ(fired, 0) << "Enter in a list chooses";
  EXPECT_EQ(refused, 6);
  strike(*text, Qt::Key_Return);
  strike(*number, Qt::Key_Return);
  EXPECT_EQ(fired, 0);
  strike(*button, Qt::Key_Return);
  EXPECT_EQ(clicked, 1);
  EXPECT_EQ(fired, 0);
  strike(*view, Qt::Key_Return);
  EXPECT_EQ(fired, 1);
}

}  // namespace
}  // namespace trocar::trainer
