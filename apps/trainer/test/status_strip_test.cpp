#include "panels/status_strip.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

#include "script/cut_off.h"
#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {

ServerLine line(const char* tool) {
  ServerLine result;
  result.tool = QString::fromLatin1(tool);
  result.is_connected = true;
  result.rate_hz = 1000.0;
  result.served = 0.9987;
  result.lateness_p99_us = 1234.0;
  result.ticks_missing = 123;
  return result;
}

TEST(StatusStrip, ForceStopIsFullyVisibleAtEveryWidth) {
  StatusStrip strip;
  strip.show();
  auto* stop = strip.findChild<QPushButton*>(QStringLiteral("force-stop"));
  ASSERT_NE(stop, nullptr);
  strip.show_servers({line("Needle"), line("Transducer")});
  strip.show_frames({60.0, 1234.0, 12345, 123456});
  for (const int width : {1500, 1280, 1024, 960, 700}) {
    for (const bool are_stopped : {false, true}) {
      strip.show_forces(true, are_stopped);
      strip.resize(width, strip.sizeHint().height());
      QCoreApplication::processEvents();
      EXPECT_TRUE(is_wholly_visible(*stop)) << width;
      EXPECT_GE(stop->width(), stop->sizeHint().width()) << width;
      EXPECT_TRUE(find_cut_off(strip).isEmpty()) << width << ": " << find_cut_off(strip).join(';').toStdString();
    }
  }
}

TEST(StatusStrip, ButtonTextNamesItsEffect) {
  StatusStrip strip;
  auto* stop = strip.findChild<QPushButton*>(QStringLiteral("force-stop"));
  int presses = 0;
  QObject::connect(&strip, &StatusStrip::toggle_requested, [&] { ++presses; });
  stop->click();
  EXPECT_EQ(presses, 0);  // no attempt
  strip.show_forces(true, false);
  EXPECT_EQ(stop->text(), QStringLiteral("STOP FORCES"));
  stop->click();
  strip.show_forces(true, true);
  EXPECT_EQ(stop->text(), QStringLiteral("RESUME FORCES"));
  stop->click();
  EXPECT_EQ(presses, 2);
}

TEST(StatusStrip, ShowsTheStateAsTextAndSymbol) {
  StatusStrip strip;
  auto* indicator = strip.findChild<QToolButton*>(QStringLiteral("status-health"));
  auto* reason = strip.findChild<QLabel*>(QStringLiteral("status-reason"));
  const auto symbol = [&] { return indicator->icon().pixmap(indicator->iconSize()).toImage(); };
  EXPECT_EQ(indicator->text(), QStringLiteral("Forces off"));
  const QImage off = symbol();
  ServerLine good = line("Needle");
  good.lateness_p99_us = 50.0;
  ServerLine lost = good;
  lost.is_connected = false;
  strip.show_forces(true, false);
  strip.show_servers({lost});
  EXPECT_EQ(strip.report().health, Health::kStarting) << "never connected in this attempt";
  strip.show_servers({good});
  EXPECT_EQ(indicator->text(), QStringLiteral("Good"));
  EXPECT_TRUE(indicator->accessibleName().contains(QStringLiteral("Good")));
  EXPECT_NE(symbol(), off);
  const QImage disc = symbol();
  strip.show_servers({lost});
  EXPECT_EQ(indicator->text(), QStringLiteral("Interrupted"));
  EXPECT_TRUE(reason->text().contains(QStringLiteral("Needle")));
  // The shapes differ where colours do not count: in the coverage of the pixels.
  const QImage square = symbol();
  int differing = 0;
  for (int y = 0; y < disc.height(); ++y)
    for (int x = 0; x < disc.width(); ++x)
      if ((qAlpha(disc.pixel(x, y)) > 127) != (qAlpha(square.pixel(x, y)) > 127)) ++differing;
  EXPECT_GT(differing, 4);
  strip.show_servers({});
  strip.show_forces(false, false);
  EXPECT_EQ(indicator->text(), QStringLiteral("Forces off"));
}

TEST(StatusStrip, ClickShowsFiguresAboveTheBarWithoutTakingFocus) {
  QWidget window;
  window.resize(900, 500);
  StatusStrip strip(&window);
  strip.setGeometry(0, 460, 900, 40);
  window.show();
  strip.show_forces(true, false);
  strip.show_servers({line("Needle"), line("Transducer")});
  auto* indicator = strip.findChild<QToolButton*>(QStringLiteral("status-health"));
  EXPECT_FALSE(strip.shows_details());
  indicator->click();
  ASSERT_TRUE(strip.shows_details());
  QCoreApplication::processEvents();
  const auto* details = window.findChild<QFrame*>(QStringLiteral("status-details"));
  const auto* figures = window.findChild<QLabel*>(QStringLiteral("status-figures"));
  EXPECT_TRUE(is_wholly_visible(*figures));
  EXPECT_LE(details->geometry().bottom(), strip.y());
  EXPECT_TRUE(window.rect().contains(details->geometry()));
  EXPECT_TRUE(figures->text().contains(QStringLiteral("99.87 %")));
  EXPECT_FALSE(indicator->hasFocus() || details->hasFocus());
  press_key(window, Qt::Key_Escape);
  EXPECT_FALSE(strip.shows_details());
  EXPECT_FALSE(indicator->isChecked());
  strip.show_frames({41.0, 30.0, 1, 99});
  indicator->click();
  EXPECT_TRUE(figures->text().contains(QStringLiteral("41 frames/s"))) << "they follow";
  indicator->click();
  EXPECT_FALSE(strip.shows_details());
}

}  // namespace
}  // namespace trocar::trainer
