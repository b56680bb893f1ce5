// A trainee's attempt through simulated servers: what it does, records and replays, in the time of the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "attempt/offline/run_session.h"
#include "attempt/record/attempt_replay.h"
#include "cases/scene_request.h"
#include "haptics/needle_geometry.h"
#include "servers/simulated_attempt_lab.h"
#include "storage/session_file.h"

namespace trocar::servers_test {
namespace {

/// The peak of the skin in a record.
double skin_peak_n(const std::vector<attempt::PunctureRecord>& punctures) {
  const auto skin = std::ranges::find(punctures, "skin", &attempt::PunctureRecord::layer);
  return skin == punctures.end() ? 0.0 : skin->peak_n;
}

TEST_F(SimulatedAttemptTest, StopsTheForcesAndContinues) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->perform(expert());
  ASSERT_TRUE(run_until_deeper(10.0)) << where();
  attempt->stop_forces();
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kStopped));
  ASSERT_TRUE(run_until([&] { return attempt->view().servers[0].gate == telemetry::GateMode::kOff; }))
      << to_string(attempt->view().servers[0].gate);
  EXPECT_FALSE(attempt->view().banner.empty());
  attempt->resume_forces();
  ASSERT_TRUE(run_until([&] { return attempt->view().servers[0].gate == telemetry::GateMode::kOn; }))
      << to_string(attempt->view().servers[0].gate);
  ASSERT_TRUE(run_until([&] { return !attempt->view().is_performing; })) << where();
  EXPECT_GT(finished().outcome.score, 0.0);
}

TEST_F(SimulatedAttemptTest, StaysStoppedWhenTheServerDies) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->stop_forces();
  ASSERT_TRUE(run_until([&] { return attempt->view().servers[0].gate == telemetry::GateMode::kOff; }));
  const int pid = attempt->view().servers[0].pid;
  needle->kill();
  ASSERT_TRUE(run_until([&] { return attempt->view().banner.find("resume") != std::string::npos; })) << where();
  EXPECT_EQ(attempt->view().phase, attempt::AttemptPhase::kStopped);
  EXPECT_EQ(attempt->view().servers[0].restarts, 0);
  attempt->resume_forces();
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_NE(attempt->view().servers[0].pid, pid);
}

TEST_F(SimulatedAttemptTest, HandMovesTheNeedleUnlessClamped) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  const Pose from = attempt->view().needle.X_PN;
  const Pose aside = attempt::moved(from, Vec3(6.0, 0.0, 0.0), Vec3::Zero());
  ASSERT_TRUE(run_until([&] {
    attempt->set_goal(attempt::Tool::kNeedle, aside);
    return (attempt->view().needle.X_PN.p() - aside.p()).norm() < 0.5;
  })) << where();
  attempt->clamp(attempt::Tool::kNeedle, true);
  ASSERT_TRUE(run_until([&] { return attempt->view().needle.is_clamped; }));
  attempt->set_goal(attempt::Tool::kNeedle, from);
  const Pose on_skin = attempt->view().probe.X_PT;
  attempt->set_goal(attempt::Tool::kProbe, attempt::moved(on_skin, Vec3(0.0, -20.0, 0.0), Vec3::Zero()));
  ASSERT_TRUE(run_until([&] { return attempt->view().probe.contact_n == 0.0; }));  // lifted off
  EXPECT_LT((attempt->view().needle.X_PN.p() - aside.p()).norm(), 1.0);
}

/// Largest distance of a shaft's points from the line through its hub in the direction of its first span.
double bend_mm(const std::vector<Vec3>& shaft_P) {
  const Vec3 along = (shaft_P[1] - shaft_P[0]).normalized();
  double most = 0.0;
  for (const Vec3& point_P : shaft_P) most = std::max(most, (point_P - shaft_P[0]).cross(along).norm());
  return most;
}

TEST_F(SimulatedAttemptTest, ShowsAndReplaysTheComputedNeedleShape) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(run_until([&] { return attempt->view().needle.is_known; })) << where();
  EXPECT_EQ(attempt->view().needle.shaft_P.size(), 2u) << "straight outside the body";
  const Segment& path_P = open->the_case.plan.line_P;
  const Pose hand = needle_pose(path_P.a + 40.0 * path_P.direction(), path_P.direction());
  ASSERT_TRUE(run_until([&] {
    attempt->set_goal(attempt::Tool::kNeedle, hand);
    return attempt->view().needle.depth_mm > 35.0;
  })) << where();
  // The hand moves aside: the shaft outside follows it, that inside stays in its channel.
  const Pose aside = attempt::moved(hand, 5.0 * path_P.direction().unitOrthogonal(), Vec3::Zero());
  double since_s = attempt->view().session_s;
  ASSERT_TRUE(run_until([&] {
    attempt->set_goal(attempt::Tool::kNeedle, aside);
    return attempt->view().session_s > since_s + 1.0;
  })) << where();
  const attempt::NeedleView bent = attempt->view().needle;
  EXPECT_GT(bent.shaft_P.size(), 10u);
  EXPECT_GT(bend_mm(bent.shaft_P), 1.0);
  EXPECT_EQ(bent.shaft_P.back(), bent.X_PN.p());
  finished();
  const auto replay = attempt::AttemptReplay::load(this->options().session, open);
  ASSERT_TRUE(replay) << replay.error().text();
  const std::vector<Vec3> replayed_P = replay->shaft_at(bent.time_s);
  ASSERT_EQ(replayed_P.size(), bent.shaft_P.size());
  for (std::size_t i = 0; i < replayed_P.size(); ++i) EXPECT_LT((replayed_P[i] - bent.shaft_P[i]).norm(), 0.1) << i;
  EXPECT_LT(replay->session().shapes.size(), replay->session().samples.size() / 9) << "at most every 10 ms";
  EXPECT_EQ(replay->shaft_at(0.0).size(), 2u);
}

TEST_F(SimulatedAttemptTest, ReplayReproducesTransducerMotion) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(run_until([&] { return attempt->view().probe.contact_n > 0.1; }));
  const Pose from = attempt->view().probe.X_PT;
  const double pressed_s = attempt->view().session_s;
  const Pose aside = attempt::moved(from, Vec3(12.0, 0.0, 0.0), Vec3::Zero());
  attempt->set_goal(attempt::Tool::kProbe, aside);
  ASSERT_TRUE(run_until([&] { return (attempt->view().probe.X_PT.p() - aside.p()).norm() < 1.0; })) << where();
  const double moved_s = attempt->view().session_s;
  ASSERT_TRUE(run_until([&] { return attempt->view().session_s > moved_s + 0.2; }));
  finished();
  const auto replay = attempt::AttemptReplay::load(options().session, open);
  ASSERT_TRUE(replay) << replay.error().text();
  ASSERT_TRUE(replay->transducer_at(0.0));
  constexpr double kLate_mm = 2.0;  // of a hand while a tick travels and is displayed
  EXPECT_LT((replay->transducer_at(pressed_s)->p() - from.p()).norm(), kLate_mm);
  EXPECT_LT((replay->transducer_at(moved_s + 0.2)->p() - aside.p()).norm(), kLate_mm);
  const auto& moments = replay->session().transducer;
  EXPECT_LE(static_cast<double>(moments.size()), 100.0 * moments.back().time_s + 1.0);
  EXPECT_TRUE(std::any_of(moments.begin(), moments.end(), [](const auto& m) { return m.contact_n > 0.1; }));
}

TEST_F(SimulatedAttemptTest, SendsParametersToARunningServer) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->set_parameters(cases::tissue_parameters({{"skin", "fp", 30.0}}));
  ASSERT_TRUE(run_until([&] { return attempt->view().message.find("changed parameters") != std::string::npos; }));
  attempt->set_parameters(cases::tissue_parameters({{"skin", "colour", 9.0}}));
  ASSERT_TRUE(run_until([&] { return attempt->view().message.find("colour") != std::string::npos; }))
      << attempt->view().message;
  // What was refused changed nothing, and a message replaces the one before it.
  attempt->set_parameters(cases::tissue_parameters({{"skin", "fp", 30.0}, {"liver", "mu", 0.2}}));
  attempt->perform(expert());  // gives up at a skin that does not give way
  ASSERT_TRUE(run_until([&] { return !attempt->view().is_performing; })) << where();
  const attempt::RunResult result = finished();
  EXPECT_EQ(result.punctures.size(), 0u);
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  using Settings = std::vector<std::string>;
  std::vector<Settings> changes;
  for (const storage::SessionParameters& change : session->parameters) changes.push_back(change.settings);
  EXPECT_EQ(changes, (std::vector<Settings>{{}, {"skin.fp=30"}, {"liver.mu=0.2"}}));
}

TEST_F(SimulatedAttemptTest, RecordsAndReplaysChangedTissues) {
  const attempt::AttemptOptions chosen = options();
  start(chosen);
  attempt->set_parameters(cases::tissue_parameters({{"skin", "fp", 4.0}}));  // before anything is recorded
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(run_until([&] { return attempt->view().session_s > 0.1; }));
  attempt->set_parameters(cases::tissue_parameters({{"skin", "fp", 6.0}}));
  attempt->perform(expert());
  ASSERT_TRUE(run_until([&] { return !attempt->view().is_performing; })) << where();
  const attempt::RunResult felt = finished();
  const double force_n = 6.0 * haptics::needle_size_factor(open->the_case.tissues.needle_size, 0.0,
                                                           cases::needle_geometry(open->the_case.needle));
  EXPECT_NEAR(skin_peak_n(felt.punctures), force_n, 0.015);

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
  EXPECT_NEAR(skin_peak_n(again->punctures), force_n, 0.015);
  EXPECT_TRUE(session->interruptions.empty());
  EXPECT_EQ(again->punctures.size(), felt.punctures.size());
  EXPECT_NEAR(again->outcome.score, felt.outcome.score, 0.5);
  const auto repeated = storage::load_session(replay.session);
  ASSERT_TRUE(repeated) << repeated.error().text();
  ASSERT_EQ(repeated->parameters.size(), 2u);
  EXPECT_EQ(repeated->parameters[1].tick, session->parameters[1].tick);
  double worst_n = 0.0;
  for (std::size_t n = 0; n < session->samples.size(); ++n)
    worst_n = std::max(worst_n, std::abs(telemetry::axial_resistance_n(session->samples[n]) -
                                         telemetry::axial_resistance_n(repeated->samples[n])));
  EXPECT_LT(worst_n, 0.05);  // the server's first ticks, before the record, are not in it
}

TEST_F(SimulatedAttemptTest, ChangedTissuesSurviveAServerRestart) {
  start(options());
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->set_parameters(cases::tissue_parameters({{"skin", "fp", 6.0}}));
  ASSERT_TRUE(run_until([&] { return !attempt->view().message.empty(); }));
  ASSERT_TRUE(run_until([&] { return attempt->view().session_s > 0.1; }));
  needle->kill();
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kServerLost)) << where();
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  const double back_s = attempt->view().session_s;
  ASSERT_TRUE(run_until([&] { return attempt->view().session_s > back_s + 0.1; }));
  const attempt::RunResult result = finished();
  EXPECT_LT(result.active_s, result.simulated_s);
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_FALSE(session->interruptions.empty());
  ASSERT_EQ(session->parameters.size(), 2u) << "there is no tick with the shipped numbers after the server's return";
  EXPECT_EQ(session->parameters[1].settings, std::vector<std::string>{"skin.fp=6"});
}

TEST_F(SimulatedAttemptTest, LeavingAnAttemptKeepsItsRecording) {
  start(options());
  ASSERT_TRUE(run_until([&] { return attempt->view().session_s > 0.6; })) << where();
  leave();
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_FALSE(session->outcome);
  EXPECT_GT(session->samples.size(), 100u);
}

TEST_F(SimulatedAttemptTest, MovesTheMouseDevice) {
  attempt::AttemptOptions mouse = options();
  mouse.device_needle = mouse.device_probe = "mouse";
  start(mouse);
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_EQ(attempt->view().servers[0].device, "mouse");
  attempt->perform(expert());
  ASSERT_TRUE(run_until([&] { return !attempt->view().is_performing; })) << where();
  EXPECT_GT(finished().outcome.score, 80.0);
}

TEST_F(SimulatedAttemptTest, WarnsOfAFullDiskThenClosesTheSession) {
  const auto free_MB = std::make_shared<std::uintmax_t>(10'000);
  attempt::AttemptOptions watched = options();
  watched.free_bytes = [free_MB](const std::filesystem::path&) {
    return std::optional<std::uintmax_t>(*free_MB * 1'000'000);
  };
  start(watched);
  ASSERT_TRUE(run_until_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->perform(expert());
  ASSERT_TRUE(run_until_deeper(5.0)) << where();
  EXPECT_EQ(attempt->view().banner, "");
  *free_MB = 20;
  ASSERT_TRUE(run_until([&] { return attempt->view().banner.find("can still be recorded") != std::string::npos; }))
      << where();
  ASSERT_TRUE(run_until([&] { return attempt->view().shots > 0; })) << where();
  *free_MB = 1;
  const attempt::RunResult result = ended();
  EXPECT_NE(result.cut_short.find("The disk is full"), std::string::npos) << result.cut_short;
  EXPECT_FALSE(result.unsaved);
  EXPECT_TRUE(result.outcome.is_scored());
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_FALSE(session->is_incomplete);
  EXPECT_EQ(session->samples.size(), result.ticks);
  EXPECT_EQ(session->outcome->score, result.outcome.score);
}

}  // namespace
}  // namespace trocar::servers_test
