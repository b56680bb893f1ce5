#include "panels/puncture_panel.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QListWidget>
#include <QPushButton>
#include <cmath>

#include "attempt/guide/gun_shot.h"
#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {

/// As wide as beside the views; events come while it is shown.
struct Shown {
  Shown() {
    panel.resize(238, 700);
    panel.begin(8.0, true);
    panel.show();
    QCoreApplication::processEvents();
  }
  QListWidget& events() { return *panel.findChild<QListWidget*>(QStringLiteral("events")); }
  QRect place_of(int row) { return events().visualItemRect(events().item(row)); }
  /// Whether the last line of a row's height holds text.
  bool is_last_line_used(int row) {
    const QRect place = place_of(row);
    const int high = events().fontMetrics().lineSpacing();
    const QImage image = events().viewport()->grab(place.adjusted(4, place.height() - high, -4, 0)).toImage();
    const QColor ground = image.pixelColor(image.width() - 1, 0);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (std::abs(qGray(image.pixel(x, y)) - qGray(ground.rgb())) > 60) return true;
    return false;
  }
  PuncturePanel panel;
};

TEST(PuncturePanel, NoRowOfEventsHasABlankLine) {
  // Longer and longer: some text ends where the scroll bar would be.
  Shown shown;
  QString text = QStringLiteral("3.7 s  through the");
  for (int longer = 0; longer < 24; ++longer) {
    shown.panel.begin(8.0, true);
    shown.panel.add_event(text);
    shown.panel.add_event(QStringLiteral("3.9 s  into the fat"));
    QCoreApplication::processEvents();
    EXPECT_TRUE(shown.is_last_line_used(0)) << text.toStdString();
    EXPECT_EQ(shown.place_of(1).top(), shown.place_of(0).bottom() + 1);
    text += longer % 5 == 0 ? QStringLiteral(" m") : QStringLiteral("i");
  }
  EXPECT_GT(shown.place_of(0).height(), shown.place_of(1).height()) << "the longest breaks";
  shown.panel.begin(8.0, true);
  shown.panel.add_event(QStringLiteral("3.7 s  through the skin at 2.8 N"));
  shown.panel.add_event(QStringLiteral("3.9 s  into the fat"));
  QCoreApplication::processEvents();
  save(shown.panel, "puncture_panel.png");
}

TEST(PuncturePanel, AimsOnlyWhereThePlanMayBeTold) {
  Shown shown;
  auto* aim = shown.panel.findChild<QPushButton*>(QStringLiteral("aim"));
  EXPECT_TRUE(aim->isEnabled());
  shown.panel.begin(8.0, false);
  EXPECT_FALSE(aim->isEnabled());
  EXPECT_TRUE(aim->toolTip().contains(QStringLiteral("guided attempts only")));
}

TEST(PuncturePanel, TheNewestEventStaysInSightWhenTheCoreIsShown) {
  Shown shown;
  for (int n = 0; n < 12; ++n)
    shown.panel.add_event(QStringLiteral("%1.0 s  through the liver capsule at 1.5 N").arg(n));
  shown.panel.add_event(QStringLiteral("12.0 s  the gun was fired at 52 mm"));
  QCoreApplication::processEvents();
  attempt::GunShot shot;
  shot.depth_mm = 52.0;
  shot.pieces = {{scoring::CorePart::kOrgan, "liver", 0.0, 4.0},
                 {scoring::CorePart::kTarget, "liver_lesion", 4.0, 18.0}};
  shown.panel.show_core(shot);
  QCoreApplication::processEvents();
  EXPECT_TRUE(shown.events().viewport()->rect().contains(shown.place_of(12)));
}

TEST(PuncturePanel, AsksInThePlaceOfItsButtonsAndStaysAsHigh) {
  Shown shown;
  auto& question = *shown.panel.findChild<QWidget*>(QStringLiteral("question"));
  auto& end = *shown.panel.findChild<QPushButton*>(QStringLiteral("end-attempt"));
  int yes = 0;
  QObject::connect(&shown.panel, &PuncturePanel::confirmed, [&] { ++yes; });
  const auto open = [&] {
    shown.panel.ask(QStringLiteral("End the attempt and score it?"), QStringLiteral("End (Enter)"));
    QCoreApplication::processEvents();
    EXPECT_TRUE(shown.panel.is_asking());
    EXPECT_FALSE(end.isVisible());
    EXPECT_TRUE(shown.panel.rect().contains(question.geometry()));
    const auto& yes_button = *shown.panel.findChild<QPushButton*>(QStringLiteral("question-yes"));
    EXPECT_GE(yes_button.width(), yes_button.sizeHint().width()) << "its text is cut off";
  };
  open();
  save(shown.panel, "puncture_panel_question.png");
  shown.panel.findChild<QPushButton*>(QStringLiteral("question-no"))->click();
  EXPECT_FALSE(shown.panel.is_asking());
  EXPECT_TRUE(end.isVisible());
  EXPECT_EQ(yes, 0);
  open();
  shown.panel.findChild<QPushButton*>(QStringLiteral("question-yes"))->click();
  EXPECT_FALSE(shown.panel.is_asking());
  EXPECT_EQ(yes, 1);
  open();
  shown.panel.begin(8.0, true);  // another attempt
  EXPECT_FALSE(shown.panel.is_asking());
  EXPECT_EQ(yes, 1);
}

}  // namespace
}  // namespace trocar::trainer
