#include "script/script.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QEventLoop>
#include <QMenu>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QThread>
#include <QTimer>
#include <QVBoxLayout>
#include <QWidgetAction>

#include "script/script_player.h"
#include "script/widget_events.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

std::string error_of(const char* text) {
  const auto steps = parse_script(QString::fromUtf8(text), QStringLiteral("steps.txt"));
  return steps ? std::string() : steps.error().text();
}

TEST(Script, StepsCommentsAndQuotationsAreRead) {
  const auto steps =
      parse_script(QStringLiteral("# first\n\nclick start\nchoose patients \"a b\"  # then\nwheel view-3d -3\n"),
                   QStringLiteral("s"));
  ASSERT_TRUE(steps);
  ASSERT_EQ(steps->size(), 3u);
  EXPECT_EQ((*steps)[1].line, 4);
  EXPECT_EQ((*steps)[1].arguments, QStringList({QStringLiteral("patients"), QStringLiteral("a b")}));
  EXPECT_EQ((*steps)[2].arguments[1], QStringLiteral("-3"));
}

TEST(Script, ColourCodesAreNotComments) {
  const auto steps = parse_script(QStringLiteral("expect-pixels view #54d1c4 12 0.1  # the path\n#all of it\n"), {});
  ASSERT_TRUE(steps);
  ASSERT_EQ(steps->size(), 1u);
  EXPECT_EQ(steps->front().arguments.size(), 4);
}

TEST(Script, ErrorsNameTheirLine) {
  EXPECT_NE(error_of("click start\nclock start\n").find("steps.txt:2"), std::string::npos);
  EXPECT_NE(error_of("click\n").find("0 arguments"), std::string::npos);
  EXPECT_NE(error_of("wait soon\n").find("is not a number"), std::string::npos);
  EXPECT_NE(error_of("wheel view-3d many\n").find("is not a number"), std::string::npos);
  EXPECT_NE(error_of("expect depth_mm = 3\n").find("is not a comparison"), std::string::npos);
  EXPECT_NE(error_of("type \"abc\n").find("quotation"), std::string::npos);
  EXPECT_NE(error_of("# nothing\n"), "");
}

/// A small window to play on.
struct SmallStage : ::testing::Test {
  SmallStage() {
    auto* column = new QVBoxLayout(&window);
    button = make_button("push", QStringLiteral("Push"), QStringLiteral("Counts"));
    button->setShortcut(QKeySequence(QStringLiteral("Ctrl+K")));
    slider = new QSlider(Qt::Horizontal);
    slider->setObjectName(QStringLiteral("slide"));
    slider->setRange(0, 100);
    column->addWidget(button);
    column->addWidget(slider);
    QObject::connect(button, &QPushButton::clicked, button, [this] { ++pushed; });
    window.resize(300, 120);
    window.show();
  }

  /// What the player says at the end.
  QString play(const char* text) {
    const auto steps = parse_script(QString::fromUtf8(text), QStringLiteral("s"));
    EXPECT_TRUE(steps) << steps.error().text();
    ScriptPlayer player(*steps, {&window, [this] { return facts(); }, [](const QString&) {}, [] {}, default_timeout_s});
    QEventLoop loop;
    QString said;
    QObject::connect(&player, &ScriptPlayer::finished, &loop, [&](const QString& error) {
      said = error;
      loop.quit();
    });
    player.start();
    loop.exec();
    return said;
  }
  QVariantMap facts() const { return {{QStringLiteral("pushed"), pushed}, {QStringLiteral("value"), slider->value()}}; }

  QWidget window;
  QPushButton* button = nullptr;
  QSlider* slider = nullptr;
  int pushed = 0;
  double default_timeout_s = 10.0;
};

TEST_F(SmallStage, ClicksKeysAndValuesReachTheWidgets) {
  EXPECT_EQ(
      play("click push\nclick push\nkey Ctrl+K\nwait-for pushed >= 3 within 5\nset slide 40\nexpect value is 40\n"),
      QString());
  EXPECT_EQ(pushed, 3);
}

TEST_F(SmallStage, ReachesMenuEntriesWhileTheMenuIsClosed) {
  auto* menu = new QMenu(&window);
  auto* entry = menu->addAction(QStringLiteral("Entry"), &window, [this] { ++pushed; });
  entry->setObjectName(QStringLiteral("menu-entry"));
  auto* number = new QSpinBox(menu);
  number->setObjectName(QStringLiteral("menu-number"));
  auto* row = new QWidgetAction(menu);
  row->setDefaultWidget(number);
  menu->addAction(row);
  EXPECT_EQ(play("click menu-entry\nset menu-number 7\nexpect pushed is 1\n"), QString());
  EXPECT_EQ(number->value(), 7);
  entry->setEnabled(false);
  default_timeout_s = 0.05;
  EXPECT_TRUE(play("click menu-entry\n").contains(QStringLiteral("disabled")));
}

TEST_F(SmallStage, TurnsTheWheelUntilAConditionHolds) {
  EXPECT_EQ(play("wheel-until slide 50 value >= 30 within 10\n"), QString());
  EXPECT_GE(slider->value(), 30);
}

TEST_F(SmallStage, ExtendsTheTimeoutOfABusyWindow) {
  // Each event takes the window 0.3 s: 20 of them are due in a second, and 8 fit into the 2.4 s that they take.
  QObject::connect(slider, &QSlider::valueChanged, slider, [] { QThread::msleep(300); });
  slider->setSingleStep(1);
  EXPECT_EQ(play("wheel-until slide 20 value >= 24 within 1.5\n"), QString());
  EXPECT_GE(slider->value(), 24);
  EXPECT_LE(slider->value(), 26) << "no notch after the condition held";
}

TEST_F(SmallStage, WaitsForAWidgetToAppear) {
  button->setEnabled(false);
  slider->hide();
  QTimer::singleShot(100, &window, [this] { button->setEnabled(true); });
  QTimer::singleShot(200, &window, [this] { slider->show(); });
  QTimer::singleShot(300, &window, [this] { slider->setValue(9); });
  QTimer::singleShot(400, &window, [this] { window.setStyleSheet(QStringLiteral("background: #ff00ff")); });
  EXPECT_EQ(play("click push\nwheel slide 0\nexpect value is 9\nexpect-pixels window #ff00ff 2 0.2\n"), QString());
  EXPECT_EQ(pushed, 1);
}

TEST_F(SmallStage, FailureNamesItsLine) {
  default_timeout_s = 0.05;
  EXPECT_TRUE(play("click push\nexpect pushed is 7\n").startsWith(QStringLiteral("s line 2:")));
  EXPECT_TRUE(play("click nothing\n").contains(QStringLiteral("nothing")));
  EXPECT_TRUE(play("wait-for pushed > 99 within 0.1\n").contains(QStringLiteral("did not become true")));
  EXPECT_TRUE(play("expect unheard is 1\n").contains(QStringLiteral("unknown fact")));
  button->setEnabled(false);
  EXPECT_TRUE(play("click push\n").contains(QStringLiteral("disabled")));
}

TEST(SharePixels, CountsPixelsNearAColour) {
  QImage image(10, 10, QImage::Format_RGB32);
  image.fill(QColor(10, 20, 30));
  for (int x = 0; x < 10; ++x) image.setPixelColor(x, 0, QColor(200, 0, 0));
  EXPECT_DOUBLE_EQ(share_near(image, QColor(198, 2, 0), 3), 0.1);
  EXPECT_DOUBLE_EQ(share_near(image, QColor(190, 2, 0), 3), 0.0);
}

}  // namespace
}  // namespace trocar::trainer
