// A trainee's attempt through servers that it starts and looks after itself.
#include "attempt/live/live_attempt.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>

#include "attempt/offline/run_session.h"
#include "attempt/record/attempt_replay.h"
#include "attempt/tools/tool_motion.h"
#include "cases/scene_request.h"
#include "core/files/folders.h"
#include "servers/live_attempt_lab.h"
#include "storage/session_file.h"

namespace trocar::servers_test {
namespace {

TEST_F(LiveAttemptTest, ExpertReachesTheTarget) {
  attempt::AttemptOptions guided = options();
  guided.is_guided = true;
  start(guided);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_TRUE(wait_for([&] { return !attempt->view().hint.empty(); }));  // with the first tick
  attempt->perform(expert());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kInBody)) << where();
  const attempt::AttemptView inside = attempt->view();
  EXPECT_GT(inside.since_contact_s, 0.0);
  EXPECT_FALSE(inside.needle.tissue.empty());
  EXPECT_GE(inside.needle.shaft_P.size(), 2u);
  EXPECT_EQ(inside.needle.shaft_P.back(), inside.needle.X_PN.p());
  EXPECT_GT(inside.probe.contact_n, 0.1);
  EXPECT_EQ(inside.servers[0].tool, "needle");
  EXPECT_GT(inside.servers[0].pid, 0);
  EXPECT_GT(inside.servers[1].wanted_hz, 0.0);
  ASSERT_TRUE(wait_for([&] { return attempt->view().shots > 0; }));
  ASSERT_TRUE(wait_for([&] { return !attempt->view().is_performing; }));
  attempt->finish();
  const attempt::RunResult result = finished();
  EXPECT_GT(result.outcome.score, 80.0);
  EXPECT_TRUE(result.outcome.target_reached);
  ASSERT_EQ(result.servers.size(), 2u);

  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), result.ticks);
  EXPECT_EQ(session->info.operator_name, "trainee");
  // The plot keeps every peak of the record.
  double highest_n = 0.0, plotted_n = 0.0;
  for (const telemetry::TickSample& sample : session->samples)
    highest_n = std::max(highest_n, telemetry::axial_resistance_n(sample));
  const std::vector<attempt::ForcePoint> forces = attempt->take_forces();
  for (const attempt::ForcePoint& point : forces) plotted_n = std::max(plotted_n, point.force_n);
  EXPECT_EQ(plotted_n, highest_n);
  EXPECT_LT(forces.size(), session->samples.size() / 4);
  const auto events = attempt->take_events();
  const auto is_capsule = [](const attempt::AttemptEvent& event) { return event.name == "liver_capsule"; };
  EXPECT_EQ(std::count_if(events.begin(), events.end(), is_capsule), 1);
}

TEST_F(LiveAttemptTest, ResumesAfterTheNeedleServerIsKilled) {
  open = abdomen_case();
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->perform(expert());
  int kills = 0;
  for (const double depth_mm : {15.0, 25.0, 35.0}) {
    ASSERT_TRUE(wait_deeper(depth_mm)) << where();
    const int pid = attempt->view().servers[0].pid;
    ::kill(pid, SIGKILL);
    ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kServerLost)) << where();
    EXPECT_FALSE(attempt->view().banner.empty());
    ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kInBody)) << where();
    // The probe's server may have been too late on a busy machine, and come back.
    EXPECT_TRUE(wait_for([&] { return attempt->view().banner.empty(); })) << attempt->view().banner;
    EXPECT_NE(attempt->view().servers[0].pid, pid);
    ASSERT_EQ(attempt->view().servers[0].restarts, ++kills) << "it did not come back at once";
  }
  ASSERT_TRUE(wait_for([&] { return !attempt->view().is_performing; })) << where();
  attempt->finish();
  const attempt::RunResult result = finished();
  EXPECT_GT(result.outcome.score, 80.0);
  EXPECT_TRUE(result.outcome.target_reached);
  const auto skins = std::count_if(result.punctures.begin(), result.punctures.end(),
                                   [](const attempt::PunctureRecord& puncture) { return puncture.layer == "skin"; });
  EXPECT_EQ(skins, 1);
  EXPECT_FALSE(result.warnings.empty());
}

TEST_F(LiveAttemptTest, NextAttemptReusesTheServers) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  const int pid = attempt->view().servers[0].pid;
  std::shared_ptr<attempt::HapticServers> servers = attempt->servers();
  attempt.reset();
  attempt::AttemptOptions next = options();
  next.session = folder_ / "next.trocar";
  start(next, std::move(servers));
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_EQ(attempt->view().servers[0].pid, pid);
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > 0.1; }));
  attempt->finish();
  EXPECT_EQ(finished().outcome.score, 0.0);  // nothing was punctured
  EXPECT_TRUE(storage::load_session(next.session));
}

TEST_F(LiveAttemptTest, ReportsWhyItCannotStart) {
  attempt::AttemptOptions wrong = options();
  wrong.device_needle = "virtual:nobody";
  start(wrong);
  ASSERT_TRUE(wait_for([&] { return attempt->view().phase == attempt::AttemptPhase::kFailed; })) << where();
  const auto result = attempt->take_result();
  ASSERT_TRUE(result && !*result);
  EXPECT_NE(result->error().text().find("nobody"), std::string::npos) << result->error().text();
}

}  // namespace
}  // namespace trocar::servers_test
