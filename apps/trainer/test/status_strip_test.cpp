#include "panels/status_strip.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>

#include "script/cut_off.h"

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

TEST(StatusStrip, TheForceStopIsWholeAtEveryWidth) {
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

TEST(StatusStrip, ItsButtonSaysWhatAPressDoes) {
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

}  // namespace
}  // namespace trocar::trainer
