#include "views/plots/time_line.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QToolButton>
#include <cmath>

#include "test/widget_actions.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

struct ShownTimeLine {
  ShownTimeLine() {
    line.resize(900, 60);
    line.set_duration(20.0);
    line.set_events({{12.0, "liver capsule", TimeMark::kPuncture},
                     {3.0, "entered the skin", TimeMark::kEnter},
                     {8.0, "close to a vessel", TimeMark::kWorst},
                     {15.5, "fired", TimeMark::kFire}});
    line.set_phases({{0.0, 3.0, "planning", QColor(0x50, 0x60, 0x70)},
                     {3.0, 15.0, "insertion", QColor(0x3a, 0x80, 0xa0)},
                     {15.0, 20.0, "retraction", QColor(0x60, 0x50, 0x80)}});
    std::vector<QPointF> curve;
    for (int n = 0; n < 20000; ++n)
      curve.push_back({0.001 * n, n < 3000 ? 0.0 : std::abs(std::sin(0.0004 * n)) * (n > 16000 ? -0.5 : 1.5)});
    line.set_curve(curve);
    line.show();
    QCoreApplication::processEvents();
    QObject::connect(&line, &TimeLine::time_changed, [this](double time_s) { times_s.push_back(time_s); });
  }
  TimeTrack& track() { return *line.findChild<TimeTrack*>("time-track"); }
  TimeLine line;
  std::vector<double> times_s;
};

TEST(TimeLine, PlaysAtItsSpeedAndStopsAtTheEnd) {
  ShownTimeLine shown;
  shown.line.advance(1.0);
  EXPECT_EQ(shown.line.time_s(), 0.0);  // It stands.
  press_key(shown.line, Qt::Key_Space);
  shown.line.advance(1.0);
  EXPECT_DOUBLE_EQ(shown.line.time_s(), 1.0);
  press_key(shown.line, Qt::Key_Greater);
  shown.line.advance(1.0);
  EXPECT_DOUBLE_EQ(shown.line.time_s(), 3.0);
  shown.line.set_speed(0.2);
  EXPECT_EQ(shown.line.speed(), 0.25);
  shown.line.advance(100.0);
  EXPECT_EQ(shown.line.time_s(), 20.0);
  EXPECT_FALSE(shown.line.is_playing());
  shown.line.findChild<QToolButton*>("time-play")->click();
  EXPECT_TRUE(shown.line.is_playing());
  EXPECT_EQ(shown.line.time_s(), 0.0);  // From the beginning.
}

TEST(TimeLine, JumpsToEventsAndTheWorstMoment) {
  ShownTimeLine shown;
  std::vector<double> visited_s;
  for (int n = 0; n < 5; ++n) {
    press_key(shown.line, Qt::Key_N);
    visited_s.push_back(shown.line.time_s());
  }
  EXPECT_EQ(visited_s, (std::vector<double>{3.0, 8.0, 12.0, 15.5, 15.5}));
  press_key(shown.line, Qt::Key_P);
  EXPECT_EQ(shown.line.time_s(), 12.0);
  shown.line.set_playing(true);
  press_key(shown.line, Qt::Key_W);
  EXPECT_EQ(shown.line.time_s(), 8.0);
  EXPECT_FALSE(shown.line.is_playing());
}

TEST(TimeLine, StepsByKeysWithinItsRange) {
  ShownTimeLine shown;
  press_key(shown.line, Qt::Key_Left);
  EXPECT_TRUE(shown.times_s.empty());
  press_key(shown.line, Qt::Key_Right);
  press_key(shown.line, Qt::Key_Right, Qt::ShiftModifier);
  EXPECT_NEAR(shown.line.time_s(), 1.1, 1e-12);
  press_key(shown.line, Qt::Key_End);
  EXPECT_EQ(shown.line.time_s(), 20.0);
  press_key(shown.line, Qt::Key_Home);
  EXPECT_EQ(shown.line.time_s(), 0.0);
  EXPECT_EQ(shown.times_s.size(), 4U);
  shown.line.set_time(std::nan(""));
  EXPECT_EQ(shown.line.time_s(), 0.0);
}

TEST(TimeLine, ScrubsWithTheMouseAndHitsMarks) {
  ShownTimeLine shown;
  TimeTrack& track = shown.track();
  drag(track, {track.x_of(5.0), 30.0}, {track.x_of(10.0), 30.0}, Qt::LeftButton);
  EXPECT_NEAR(shown.line.time_s(), 10.0, 0.05);  // half a point of 900 for 20 s
  mouse(track, QEvent::MouseButtonPress, {track.x_of(12.0) + 2.0, 30.0}, Qt::LeftButton);
  EXPECT_EQ(shown.line.time_s(), 12.0);
  mouse(track, QEvent::MouseMove, {-500.0, 30.0}, Qt::LeftButton);
  EXPECT_EQ(shown.line.time_s(), 0.0);
}

TEST(TimeLine, ShowsPhasesAndMarksWhereTheyAre) {
  ShownTimeLine shown;
  shown.line.set_time(20.0);  // nothing is dimmed
  TimeTrack& track = shown.track();
  const QImage image = track.grab().toImage();
  const int phases_y = track.height() - 4;
  const auto color = [&](double time_s, int y) { return image.pixelColor(static_cast<int>(track.x_of(time_s)), y); };
  EXPECT_EQ(color(1.0, phases_y), QColor(0x50, 0x60, 0x70));
  EXPECT_EQ(color(10.0, phases_y), QColor(0x3a, 0x80, 0xa0));
  EXPECT_EQ(color(12.0, 7), theme().warning);
  EXPECT_EQ(color(15.5, 7), theme().target);
}

TEST(TimeLine, DrawsRiskMarksOverTheWorstMoment) {
  ShownTimeLine shown;
  shown.line.set_events({{4.0, "touched: lung", TimeMark::kRisk},
                         {8.0, "touched: rib", TimeMark::kRisk},
                         {8.0, "the worst", TimeMark::kWorst},
                         {12.0, "the liver", TimeMark::kEnter}});
  shown.line.set_time(20.0);
  save(shown.line, "time_line_risk.png");
  TimeTrack& track = shown.track();
  const QImage image = track.grab().toImage();
  const auto reddish = [&](double time_s) {
    const int x = static_cast<int>(track.x_of(time_s));
    int count = 0;
    for (int column = x - 9; column <= x + 9; ++column)
      for (int row = 0; row < track.height(); ++row) {
        const QColor c = image.pixelColor(column, row);
        count += c.red() > 200 && c.red() > c.green() + 60 && c.red() > c.blue() + 60 ? 1 : 0;
      }
    return count;
  };
  EXPECT_GT(reddish(4.0), 60);
  EXPECT_GT(reddish(8.0), 60);
  EXPECT_LT(reddish(12.0), 10);
}

TEST(TimeLine, OffersTheWorstMomentOnlyIfItExists) {
  ShownTimeLine shown;
  EXPECT_TRUE(shown.line.findChild<QToolButton*>("time-worst")->isVisible());
  shown.line.set_events({});
  EXPECT_FALSE(shown.line.findChild<QToolButton*>("time-worst")->isVisible());
  press_key(shown.line, Qt::Key_W);
  press_key(shown.line, Qt::Key_N);
  EXPECT_EQ(shown.line.time_s(), 0.0);
}

TEST(TimeLine, DoesNotPlayWithoutASession) {
  TimeLine line;
  line.set_playing(true);
  EXPECT_FALSE(line.is_playing());
  line.resize(400, 60);
  EXPECT_FALSE(line.grab().isNull());
}

TEST(TimeLine, RendersToAnImage) {
  ShownTimeLine shown;
  shown.line.set_time(9.2);
  save(shown.line, "time_line.png");
  shown.line.resize(520, 60);
  QCoreApplication::processEvents();
  save(shown.line, "time_line_small.png");
  EXPECT_GE(shown.track().width(), 100);
}

}  // namespace
}  // namespace trocar::trainer
