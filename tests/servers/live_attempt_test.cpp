// A trainee's attempt through servers that it starts and looks after itself.
#include "attempt/live/live_attempt.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>

#include "attempt/hands/hand_motion.h"
#include "attempt/offline/run_session.h"
#include "attempt/record/attempt_replay.h"
#include "core/files/temporary_folder.h"
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
  ASSERT_TRUE(wait_for([&] { return attempt->view().has_fired; }));
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

TEST_F(LiveAttemptTest, GoesOnWhereItWasWhenTheNeedlesServerIsKilled) {
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
    EXPECT_TRUE(attempt->view().banner.empty()) << attempt->view().banner;
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

TEST_F(LiveAttemptTest, StopsTheForcesAndGoesOn) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->perform(expert());
  ASSERT_TRUE(wait_deeper(10.0)) << where();
  attempt->stop_forces();
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kStopped));
  ASSERT_TRUE(wait_for([&] { return attempt->view().servers[0].gate == "off"; })) << attempt->view().servers[0].gate;
  EXPECT_FALSE(attempt->view().banner.empty());
  attempt->resume_forces();
  ASSERT_TRUE(wait_for([&] { return attempt->view().servers[0].gate == "on"; })) << attempt->view().servers[0].gate;
  ASSERT_TRUE(wait_for([&] { return !attempt->view().is_performing; })) << where();
  attempt->finish();
  EXPECT_GT(finished().outcome.score, 0.0);
}

TEST_F(LiveAttemptTest, StaysStoppedWhenTheServerDiesMeanwhile) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->stop_forces();
  ASSERT_TRUE(wait_for([&] { return attempt->view().servers[0].gate == "off"; }));
  const int pid = attempt->view().servers[0].pid;
  ::kill(pid, SIGKILL);
  ASSERT_TRUE(wait_for([&] { return attempt->view().banner.find("resume") != std::string::npos; })) << where();
  EXPECT_EQ(attempt->view().phase, attempt::AttemptPhase::kStopped);
  EXPECT_EQ(attempt->view().servers[0].restarts, 0);
  attempt->resume_forces();
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_NE(attempt->view().servers[0].pid, pid);
}

TEST_F(LiveAttemptTest, TheHandLeadsTheNeedleAndAClampedOneDoesNot) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  const Pose from = attempt->view().needle.X_PN;
  const Pose aside = attempt::moved(from, Vec3(6.0, 0.0, 0.0), Vec3::Zero());
  ASSERT_TRUE(wait_for([&] {
    attempt->set_goal(attempt::HandTool::kNeedle, aside);
    return (attempt->view().needle.X_PN.p() - aside.p()).norm() < 0.5;
  })) << where();
  attempt->clamp(attempt::HandTool::kNeedle, true);
  ASSERT_TRUE(wait_for([&] { return attempt->view().needle.is_clamped; }));
  attempt->set_goal(attempt::HandTool::kNeedle, from);
  const Pose probe = attempt->view().probe.X_PT;
  attempt->set_goal(attempt::HandTool::kProbe, attempt::moved(probe, Vec3(0.0, -20.0, 0.0), Vec3::Zero()));
  ASSERT_TRUE(wait_for([&] { return attempt->view().probe.contact_n == 0.0; }));  // lifted off
  EXPECT_LT((attempt->view().needle.X_PN.p() - aside.p()).norm(), 1.0);
}

TEST_F(LiveAttemptTest, TheReplayMovesTheTransducerAsItWasMoved) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(wait_for([&] { return attempt->view().probe.contact_n > 0.1; }));
  const Pose from = attempt->view().probe.X_PT;
  const double pressed_s = attempt->view().session_s;
  const Pose aside = attempt::moved(from, Vec3(12.0, 0.0, 0.0), Vec3::Zero());
  attempt->set_goal(attempt::HandTool::kProbe, aside);
  ASSERT_TRUE(wait_for([&] { return (attempt->view().probe.X_PT.p() - aside.p()).norm() < 1.0; })) << where();
  const double moved_s = attempt->view().session_s;
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > moved_s + 0.2; }));
  attempt->finish();
  finished();
  const auto replay = attempt::AttemptReplay::load(options().session, layered_case());
  ASSERT_TRUE(replay) << replay.error().text();
  ASSERT_TRUE(replay->transducer_at(0.0));
  constexpr double kLate_mm = 2.0;  // what a hand moves while a tick travels and is looked at
  EXPECT_LT((replay->transducer_at(pressed_s)->p() - from.p()).norm(), kLate_mm);
  EXPECT_LT((replay->transducer_at(moved_s + 0.2)->p() - aside.p()).norm(), kLate_mm);
  const auto& moments = replay->session().transducer;
  EXPECT_LE(static_cast<double>(moments.size()), 100.0 * moments.back().time_s + 1.0);
  EXPECT_TRUE(std::any_of(moments.begin(), moments.end(), [](const auto& m) { return m.contact_n > 0.1; }));
}

TEST_F(LiveAttemptTest, ParametersReachTheServerWhileItRuns) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->set_parameters({"skin.fp=30"});
  ASSERT_TRUE(wait_for([&] { return attempt->view().message.find("changed parameters") != std::string::npos; }));
  attempt->set_parameters({"skin.colour=9"});
  ASSERT_TRUE(wait_for([&] { return attempt->view().message.find("colour") != std::string::npos; }))
      << attempt->view().message;
  // What was refused changed nothing, and a message replaces the one before it.
  attempt->set_parameters({"skin.fp=30", "liver.mu=0.2"});
  attempt->perform(expert());  // gives up at a skin that does not give way
  ASSERT_TRUE(wait_for([&] { return !attempt->view().is_performing; })) << where();
  attempt->finish();
  const attempt::RunResult result = finished();
  EXPECT_EQ(result.punctures.size(), 0u);
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  using Settings = std::vector<std::string>;
  std::vector<Settings> changes;
  for (const storage::SessionParameters& change : session->parameters) changes.push_back(change.settings);
  EXPECT_EQ(changes, (std::vector<Settings>{{}, {"skin.fp=30"}, {"liver.mu=0.2"}}));
}

/// The peak of the skin in a record.
double skin_peak_n(const std::vector<attempt::PunctureRecord>& punctures) {
  const auto skin = std::ranges::find(punctures, "skin", &attempt::PunctureRecord::layer);
  return skin == punctures.end() ? 0.0 : skin->peak_n;
}

TEST_F(LiveAttemptTest, RecordsTheTissuesThatWereFeltAndReplaysThem) {
  attempt::AttemptOptions chosen = options();
  chosen.waits_for_begin = true;
  start(chosen);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->set_parameters({"skin.fp=4"});  // before anything is recorded
  ASSERT_TRUE(wait_for([&] { return !attempt->view().message.empty(); }));
  attempt->begin();
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > 0.1; }));
  attempt->set_parameters({"skin.fp=6"});
  attempt->perform(expert());
  ASSERT_TRUE(wait_for([&] { return !attempt->view().is_performing; })) << where();
  attempt->finish();
  const attempt::RunResult felt = finished();
  EXPECT_NEAR(skin_peak_n(felt.punctures), 6.0, 0.01);

  const auto session = storage::load_session(chosen.session);
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->parameters.size(), 2u);
  EXPECT_EQ(session->parameters[0].settings, std::vector<std::string>{"skin.fp=4"});
  EXPECT_EQ(session->parameters[1].settings, std::vector<std::string>{"skin.fp=6"});
  EXPECT_GT(session->parameters[1].tick, 0u);

  attempt::RunOptions replay;
  replay.operator_name = "replay:" + chosen.session.string();
  replay.session = folder_ / "again.trocar";
  const auto again = attempt::run_session(open->the_case, replay);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_NEAR(skin_peak_n(again->punctures), 6.0, 0.01);
  if (session->interruptions.empty()) {
    EXPECT_EQ(again->punctures.size(), felt.punctures.size());
    EXPECT_NEAR(again->outcome.score, felt.outcome.score, 0.5);
  }
  const auto repeated = storage::load_session(replay.session);
  ASSERT_TRUE(repeated) << repeated.error().text();
  ASSERT_EQ(repeated->parameters.size(), 2u);
  EXPECT_EQ(repeated->parameters[1].tick, session->parameters[1].tick);
  // Where a busy machine interrupted the attempt, the insertion began anew in ticks that are not in the record.
  const auto& gaps = session->interruptions;
  const double until_s = gaps.empty() ? session->samples.back().time_s : gaps.front().from_s;
  double worst_n = 0.0;
  for (std::size_t n = 0; n < session->samples.size() && session->samples[n].time_s < until_s; ++n)
    worst_n = std::max(worst_n, std::abs(telemetry::axial_resistance_n(session->samples[n]) -
                                         telemetry::axial_resistance_n(repeated->samples[n])));
  EXPECT_LT(worst_n, 0.05);  // the server's first ticks, before the record, are not in it
}

TEST_F(LiveAttemptTest, ChangedTissuesOutliveTheirServer) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->set_parameters({"skin.fp=6"});
  ASSERT_TRUE(wait_for([&] { return !attempt->view().message.empty(); }));
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > 0.1; }));
  const int pid = attempt->view().servers[0].pid;
  ::kill(pid, SIGKILL);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kServerLost)) << where();
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  const double back_s = attempt->view().session_s;
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > back_s + 0.1; }));
  attempt->finish();
  const attempt::RunResult result = finished();
  EXPECT_LT(result.active_s, result.simulated_s);
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_FALSE(session->interruptions.empty());
  ASSERT_EQ(session->parameters.size(), 2u) << "there is no tick with the shipped numbers after the server's return";
  EXPECT_EQ(session->parameters[1].settings, std::vector<std::string>{"skin.fp=6"});
}

TEST_F(LiveAttemptTest, NextAttemptTakesTheServersOver) {
  attempt::AttemptOptions waiting = options();
  waiting.waits_for_begin = true;
  start(waiting);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_EQ(attempt->view().session_s, 0.0);
  EXPECT_FALSE(std::filesystem::exists(waiting.session));
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

TEST_F(LiveAttemptTest, AnAttemptThatIsLeftKeepsWhatWasRecorded) {
  start(options());
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > 0.6; })) << where();
  attempt.reset();
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_FALSE(session->outcome);
  EXPECT_GT(session->samples.size(), 100u);
}

TEST_F(LiveAttemptTest, MovesTheMousesDeviceAsWell) {
  attempt::AttemptOptions mouse = options();
  mouse.device_needle = mouse.device_probe = "mouse";
  start(mouse);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_EQ(attempt->view().servers[0].device, "mouse");
  attempt->perform(expert());
  ASSERT_TRUE(wait_for([&] { return !attempt->view().is_performing; })) << where();
  attempt->finish();
  EXPECT_GT(finished().outcome.score, 80.0);
}

TEST_F(LiveAttemptTest, SaysWhyItCannotStart) {
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
