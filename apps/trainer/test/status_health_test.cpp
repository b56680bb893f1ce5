#include "panels/status_health.h"

#include <gtest/gtest.h>

namespace trocar::trainer {
namespace {

/// An attempt in which all is well.
HealthInput running() {
  HealthInput input;
  for (const char* tool : {"Needle", "Transducer"}) {
    ServerLine line;
    line.tool = QString::fromLatin1(tool);
    line.is_connected = true;
    line.rate_hz = 1000.0;
    line.lateness_p99_us = 40.0;
    input.servers.push_back(line);
  }
  input.frames = FrameFigures{60.0, 17.0, 0, 100};
  input.is_attempt = input.has_started = true;
  return input;
}

TEST(Health, IsGoodWhenForcesAndFramesAreOnTime) {
  EXPECT_EQ(assess_health(running()).health, Health::kGood);
  EXPECT_TRUE(assess_health(running()).reason.isEmpty());
}

TEST(Health, IsOffWithoutAttemptAndStartingUntilConnected) {
  HealthInput input = running();
  input.has_started = false;
  input.servers[0].is_connected = false;
  EXPECT_EQ(assess_health(input).health, Health::kStarting);
  input.servers[1].fault = QStringLiteral("force limit");
  EXPECT_EQ(assess_health(input).health, Health::kInterrupted) << "a fault is one at any time";
  input.is_attempt = false;
  EXPECT_EQ(assess_health(input).health, Health::kOff);
  EXPECT_EQ(assess_health({}).health, Health::kOff);
}

TEST(Health, StatesHowALostServerReturns) {
  HealthInput input = running();
  input.servers[0].is_connected = false;
  EXPECT_TRUE(assess_health(input).reason.contains(QStringLiteral("is being restarted")));
  input.servers[0].waits_for_resume = true;
  EXPECT_TRUE(assess_health(input).reason.contains(QStringLiteral("when you resume the forces")));
}

TEST(Health, IsSlowBeyondTheLimitsAndNamesTheTool) {
  const HealthLimits limits;
  HealthInput input = running();
  input.servers[1].served = limits.least_served;
  EXPECT_EQ(assess_health(input).health, Health::kGood);
  input.servers[1].served = limits.least_served - 1e-6;
  EXPECT_EQ(assess_health(input).health, Health::kSlow);
  EXPECT_TRUE(assess_health(input).reason.contains(QStringLiteral("Transducer")));
  input = running();
  input.servers[0].lateness_p99_us = limits.most_lateness_p99_us + 1.0;
  EXPECT_EQ(assess_health(input).words, QStringLiteral("Slow forces"));
  input = running();
  input.frames->per_s = limits.least_frames_per_s - 0.1;
  EXPECT_EQ(assess_health(input).words, QStringLiteral("Slow display"));
  input = running();
  input.frames->slowest_ms = limits.slowest_frame_ms + 1.0;
  EXPECT_EQ(assess_health(input).words, QStringLiteral("Slow display"));
  input.frames.reset();
  EXPECT_EQ(assess_health(input).health, Health::kGood) << "not measured yet";
}

TEST(Health, TheWorstCauseDecides) {
  HealthInput input = running();
  input.frames->per_s = 3.0;
  input.servers[0].served = 0.5;
  EXPECT_EQ(assess_health(input).words, QStringLiteral("Slow forces"));
  input.are_forces_stopped = true;
  EXPECT_EQ(assess_health(input).health, Health::kStopped);
  input.servers[1].is_connected = false;
  EXPECT_EQ(assess_health(input).health, Health::kInterrupted);
}

TEST(Health, AddedFiguresNeverImproveHealth) {
  int last = static_cast<int>(Health::kGood);
  for (double served = 1.0; served > 0.0; served -= 0.001) {
    HealthInput input = running();
    input.servers[0].served = served;
    const int now = static_cast<int>(assess_health(input).health);
    EXPECT_GE(now, last) << served;
    last = now;
  }
  EXPECT_EQ(last, static_cast<int>(Health::kSlow));
}

TEST(Health, TheDetailsHaveEveryFigure) {
  HealthInput input = running();
  input.servers[0].rate_hz = 987.0;
  input.servers[0].served = 0.9876;
  input.servers[0].lateness_p99_us = 1234.0;
  input.servers[0].ticks_missing = 77;
  input.servers[0].grant = QStringLiteral("SCHED_FIFO 80");
  input.servers[1].fault = QStringLiteral("<force>");
  input.frames = FrameFigures{52.0, 140.0, 377, 9000};
  const QString text = health_details(input);
  for (const char* part : {"Needle", "Transducer", "987 Hz", "98.76 %", "1234 ", "77", "SCHED_FIFO 80", "&lt;force&gt;",
                           "52 frames/s", "140 ms", "377 of 9000 late"})
    EXPECT_TRUE(text.contains(QString::fromLatin1(part))) << part << ": " << text.toStdString();
}

}  // namespace
}  // namespace trocar::trainer
