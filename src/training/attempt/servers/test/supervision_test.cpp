// One test for each row of the tables in docs/supervision.md: a server that ends, falls silent, returns or has a fault,
// in a test's own time.
#include "attempt/servers/test/supervision_lab.h"
#include "cases/scene_request.h"

namespace trocar::attempt {
namespace {

using link::ServerCommand;
using telemetry::GateFault;
using telemetry::GateMode;

const link::SetParameters kHarderSkin = cases::tissue_parameters({{"skin", "fp", 6.0}});
const link::SetParameters kProxyModel{.force_model = "proxy"};

TEST_F(SupervisionTest, PlacesTheToolThenSwitchesTheForcesOn) {
  start();
  EXPECT_EQ(server->scenes, 1);
  EXPECT_EQ(server->count(ServerCommand::kStart), 1);
  EXPECT_EQ(server->gate(), GateMode::kOn);
  ASSERT_TRUE(server->target);
  EXPECT_EQ(server->target->X_PN.p(), X_PN.p());
  EXPECT_TRUE(server->target->is_rigid);
  EXPECT_EQ(tool->activations(), 1);
  EXPECT_TRUE(tool->banner().empty()) << tool->banner();
  ticks = 0;
  run_for(0.1);
  EXPECT_NEAR(static_cast<double>(ticks), 100.0, 1.0);
}

TEST_F(SupervisionTest, WaitsForControlThenReconnects) {
  supervise();
  server->has_control = false;
  run_for(2.5);
  EXPECT_EQ(server->connections, 1);
  ASSERT_TRUE(run_until([&] { return server->connections == 2; }, 2.0));
  EXPECT_TRUE(has_note("nother client controls"));
  server->has_control = true;
  EXPECT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_EQ(server->restarts, 0);
}

TEST_F(SupervisionTest, GivesUpOnAServerThatEndsBeforeItsFirstMessage) {
  supervise();
  server->end("no gamepad is connected");
  run_for(0.1);
  EXPECT_TRUE(has_given_up());
  EXPECT_EQ(tool->failure().what, "no gamepad is connected");
  EXPECT_EQ(server->restarts, 0);
}

TEST_F(SupervisionTest, AnnouncesThenRestartsAServerThatEnded) {
  start();
  server->end("the server was killed by signal 9");
  run_for(0.001);
  EXPECT_TRUE(shows("killed by signal 9. It is being restarted")) << tool->banner();
  EXPECT_EQ(server->restarts, 0) << "the banner is displayed before the start blocks";
  run_for(0.001);
  EXPECT_EQ(server->restarts, 1);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  ASSERT_EQ(recoveries.size(), 1u);
  EXPECT_NE(recoveries[0].find("was restarted. The forces are on again"), std::string::npos) << recoveries[0];
  EXPECT_EQ(tool->view().restarts, 1);
  EXPECT_EQ(tool->activations(), 2);
  EXPECT_TRUE(tool->banner().empty()) << tool->banner();
}

TEST_F(SupervisionTest, RestoresTheLastToolPose) {
  start();
  const Pose deeper = X_PN * Pose::translation({0.0, 0.0, 25.0});
  tool->place_at(deeper);
  server->end("it ended");
  run_for(0.01);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_EQ(server->target->X_PN.p(), deeper.p());
}

TEST_F(SupervisionTest, GivesUpOnAServerThatCannotRestart) {
  start();
  server->restarts_well = fail("no trocar-hapticd", "here", "install it");
  server->end("it ended");
  run_for(0.01);
  EXPECT_TRUE(has_given_up());
  EXPECT_EQ(tool->failure().what, "no trocar-hapticd");
  EXPECT_TRUE(tool->view().waits_for_resume);
}

TEST_F(SupervisionTest, GivesUpOnAServerThatKeepsEnding) {
  start();
  for (int times = 0; times < 6; ++times) {
    server->end("it ended");
    run_for(0.01);
    ASSERT_TRUE(run_until([&] { return tool->is_fresh(); })) << times;
  }
  server->end("it ended");
  run_for(0.01);
  EXPECT_TRUE(has_given_up());
  EXPECT_TRUE(shows("ends repeatedly")) << tool->banner();
  tool->resume_forces();
  EXPECT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
}

TEST_F(SupervisionTest, ForgetsReturnsOlderThanAMinute) {
  start();
  for (int times = 0; times < 9; ++times) {
    server->end("it ended");
    run_for(15.0);
    ASSERT_TRUE(tool->is_fresh()) << times;
  }
}

TEST_F(SupervisionTest, RestartsASilentSleepingServer) {
  start();
  server->is_silent = true;
  run_for(0.4);
  EXPECT_FALSE(tool->is_fresh());
  EXPECT_TRUE(shows("does not respond")) << tool->banner();
  EXPECT_EQ(server->restarts, 0);
  run_for(kTimeout_s);
  EXPECT_EQ(server->restarts, 1);
  EXPECT_TRUE(run_until([&] { return tool->is_fresh(); }));
}

TEST_F(SupervisionTest, WaitsFourTimesLongerForAServerWithoutProcessor) {
  start();
  server->is_silent = server->has_no_processor = true;
  run_for(3.9 * kTimeout_s);
  EXPECT_EQ(server->restarts, 0);
  EXPECT_TRUE(shows("gets no processor time")) << tool->banner();
  run_for(0.2 * kTimeout_s);
  EXPECT_EQ(server->restarts, 1);
}

TEST_F(SupervisionTest, ContinuesWithAServerThatRegainsProcessorTime) {
  start();
  server->is_silent = server->has_no_processor = true;
  run_for(2.0 * kTimeout_s);
  server->is_silent = server->has_no_processor = false;
  run_for(0.01);
  EXPECT_TRUE(tool->is_fresh());
  EXPECT_TRUE(tool->banner().empty()) << tool->banner();
  EXPECT_EQ(tool->activations(), 1);
  EXPECT_EQ(server->connections, 1);
}

TEST_F(SupervisionTest, PreparesAServerThatReturnedByItself) {
  start();
  server->come_back();
  run_for(0.02);
  EXPECT_TRUE(has_note("was unavailable"));
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_EQ(server->scenes, 2);
  EXPECT_EQ(tool->activations(), 2);
  EXPECT_EQ(server->connections, 1);
  EXPECT_EQ(tool->view().restarts, 0);
  EXPECT_EQ(tool->figures().returns, 1);
}

TEST_F(SupervisionTest, ResetsStallFaultsAnyNumberOfTimes) {
  start();
  for (int times = 1; times <= 8; ++times) {
    server->set_fault(times % 2 == 0 ? GateFault::kLoopSlow : GateFault::kLoopStalled);
    run_for(0.01);
    EXPECT_TRUE(has_note("stopped because this machine is too busy"));
    ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
    EXPECT_EQ(tool->activations(), 1 + times);
  }
  EXPECT_EQ(server->connections, 1);
  EXPECT_EQ(tool->view().restarts, 0);
  EXPECT_EQ(tool->figures().returns, 8);
}

TEST_F(SupervisionTest, ResetsAnotherFaultOverANewConnection) {
  start();
  server->set_fault(GateFault::kRunaway);
  run_for(0.01);
  EXPECT_TRUE(has_note("latched a fault"));
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_GE(server->count(ServerCommand::kResetFault), 1);
  EXPECT_EQ(server->connections, 2);
  EXPECT_EQ(server->restarts, 0);
  EXPECT_EQ(tool->view().restarts, 1);
}

TEST_F(SupervisionTest, GivesUpOnAPermanentFault) {
  start();
  server->is_fault_permanent = true;
  server->set_fault(GateFault::kEncoderStuck);
  EXPECT_TRUE(run_until([&] { return has_given_up(); }, 10.0 * kTimeout_s)) << tool->banner();
}

TEST_F(SupervisionTest, ReopensALostDeviceUntilItReturns) {
  start("gamepad");
  server->is_device_gone = true;
  server->set_fault(GateFault::kDeviceLost);
  run_for(0.01);
  EXPECT_TRUE(shows("gamepad is disconnected. Plug it in to continue")) << tool->banner();
  run_for(3.5);
  EXPECT_GE(server->count(ServerCommand::kReconnect), 3);
  EXPECT_LE(server->count(ServerCommand::kReconnect), 5);
  server->is_device_gone = false;
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }, 5.0)) << tool->banner();
  EXPECT_EQ(server->restarts, 0);
  ASSERT_EQ(recoveries.size(), 1u);
}

TEST_F(SupervisionTest, NeverSwitchesForcesOnInAPersonsHand) {
  start("openhaptics");
  for (const GateFault fault : {GateFault::kLoopStalled, GateFault::kRunaway, GateFault::kDeviceSilent}) {
    server->set_fault(fault);
    run_for(1.0);
    EXPECT_TRUE(tool->view().waits_for_resume) << to_string(fault);
    EXPECT_FALSE(tool->is_fresh());
    EXPECT_EQ(server->count(ServerCommand::kResetFault), 0);
    server->commands.clear();
    tool->resume_forces();
    ASSERT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
    server->commands.clear();
  }
}

TEST_F(SupervisionTest, RetriesStallsBeforeTheFirstForcesUnasked) {
  for (const ServerState state : {ServerState::kLoading, ServerState::kStarting, ServerState::kSettling})
    for (const GateFault fault : {GateFault::kLoopStalled, GateFault::kLoopSlow, GateFault::kDeviceSilent}) {
      supervise("openhaptics");
      ASSERT_TRUE(run_until([&] { return tool->state() == state; }, 5.0));
      server->set_fault(fault);
      EXPECT_TRUE(run_until([&] { return tool->is_fresh(); }, 5.0)) << to_string(fault) << tool->banner();
    }
  supervise("openhaptics");
  ASSERT_TRUE(run_until([&] { return tool->state() == ServerState::kLoading; }));
  server->set_fault(GateFault::kRunaway);
  run_for(1.0);
  EXPECT_TRUE(tool->view().waits_for_resume) << "a fault that is no stall";
  const auto stall = [&](ServerState state, int times) {
    for (int stalls = 0; stalls < times; ++stalls) {
      ASSERT_TRUE(run_until([&] { return tool->state() == state; }, 5.0)) << stalls;
      server->set_fault(GateFault::kDeviceSilent);
      run_for(0.002);
    }
  };
  supervise("openhaptics");
  stall(ServerState::kStarting, 6);
  EXPECT_TRUE(tool->view().waits_for_resume) << "five stalls while the forces are switched on are too many";
  supervise("openhaptics");
  stall(ServerState::kLoading, 20);
  EXPECT_FALSE(tool->view().waits_for_resume) << "a machine that loads is busy";
  tool->hold_start(true);
  run_for(31.0);
  stall(ServerState::kPlacing, 6);
  EXPECT_TRUE(tool->view().waits_for_resume) << "but not for so long";
}

TEST_F(SupervisionTest, HeldStartWaitsWithoutATimeout) {
  for (const char* device : {"virtual:premium", "openhaptics"}) {
    supervise(device);
    EXPECT_TRUE(tool->is_loading());
    tool->hold_start(true);
    run_for(10.0 * kTimeout_s);
    EXPECT_EQ(tool->state(), ServerState::kPlacing) << tool->banner();
    EXPECT_FALSE(tool->is_loading());
    EXPECT_EQ(server->count(ServerCommand::kStart), 0);
    tool->hold_start(false);
    EXPECT_TRUE(run_until([&] { return tool->is_fresh(); }, 5.0)) << tool->banner();
  }
}

TEST_F(SupervisionTest, DeviceSilentBeforeFirstForcesWaitsForResume) {
  supervise("openhaptics");
  server->is_fault_permanent = true;
  ASSERT_TRUE(run_until([&] { return tool->state() == ServerState::kLoading; }));
  server->set_fault(GateFault::kDeviceSilent);
  ASSERT_TRUE(run_until([&] { return tool->view().waits_for_resume; }, 10.0));
  EXPECT_TRUE(shows("which moves the needle, sends no data. Check its cable")) << tool->banner();
  EXPECT_EQ(server->count(ServerCommand::kStart), 0);
}

TEST_F(SupervisionTest, LostDeviceOfAPersonWaitsForResume) {
  start("openhaptics");
  server->is_device_gone = true;
  server->set_fault(GateFault::kDeviceLost);
  run_for(1.0);
  EXPECT_TRUE(shows("which moves the needle, is disconnected. Plug it in again")) << tool->banner();
  EXPECT_EQ(server->count(ServerCommand::kReconnect), 0);
  tool->resume_forces();
  run_for(0.1);
  EXPECT_EQ(server->count(ServerCommand::kReconnect), 1);
  EXPECT_TRUE(shows("resume to try again")) << tool->banner();
  run_for(2.0);
  EXPECT_EQ(server->count(ServerCommand::kReconnect), 1);
  server->is_device_gone = false;
  tool->resume_forces();
  EXPECT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
}

TEST_F(SupervisionTest, DoesNotMoveAPersonsDevice) {
  supervise("openhaptics");
  server->is_device_fixed = true;
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
  EXPECT_FALSE(server->target && server->target->is_placed);
}

TEST_F(SupervisionTest, StoppedForcesStayOffThroughASilence) {
  start();
  tool->stop_forces();
  run_for(0.01);
  EXPECT_EQ(server->gate(), GateMode::kOff);
  EXPECT_TRUE(tool->is_fresh()) << "ticks and targets continue";
  server->commands.clear();
  server->come_back();
  run_for(1.0);
  EXPECT_EQ(server->count(ServerCommand::kStart), 0);
  EXPECT_TRUE(shows("resume when you are ready")) << tool->banner();
  tool->resume_forces();
  EXPECT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
  EXPECT_EQ(server->gate(), GateMode::kOn);
}

TEST_F(SupervisionTest, StoppedForcesResumeWithoutANewPreparation) {
  start();
  tool->stop_forces();
  run_for(0.5);
  tool->resume_forces();
  run_for(0.01);
  EXPECT_EQ(server->gate(), GateMode::kOn);
  EXPECT_EQ(tool->activations(), 1);
}

TEST_F(SupervisionTest, ResumeRestartsAServerThatEndedWhileStopped) {
  start();
  tool->stop_forces();
  run_for(0.01);
  server->end("it ended");
  run_for(1.0);
  EXPECT_EQ(server->restarts, 0);
  EXPECT_TRUE(shows("it is restarted when you resume")) << tool->banner();
  tool->resume_forces();
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
  EXPECT_EQ(server->restarts, 1);
}

TEST_F(SupervisionTest, ResumePreparesAToolStoppedDuringPreparation) {
  supervise();
  run_for(0.003);
  tool->stop_forces();
  run_for(1.0);
  EXPECT_FALSE(tool->is_fresh());
  EXPECT_NE(server->gate(), GateMode::kOn);
  tool->resume_forces();
  EXPECT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
}

TEST_F(SupervisionTest, SendsParametersNowAndBeforeTheForcesReturn) {
  start();
  tool->set_parameters(kHarderSkin);
  tool->set_parameters(kProxyModel);
  run_for(0.05);
  EXPECT_EQ(server->parameters, (std::vector<link::SetParameters>{kHarderSkin, kProxyModel}));
  EXPECT_EQ(messages.size(), 2u);
  server->parameters.clear();
  server->end("it ended");
  run_for(0.01);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  link::SetParameters both = kHarderSkin;
  both.force_model = kProxyModel.force_model;
  EXPECT_EQ(server->parameters, (std::vector<link::SetParameters>{both}));
}

TEST_F(SupervisionTest, ForgetsParametersThatWereRefused) {
  start();
  tool->set_parameters(kHarderSkin);
  run_for(0.05);
  server->refuses_parameters = "no such number";
  tool->set_parameters(cases::tissue_parameters({{"skin", "colour", 9.0}}));
  run_for(0.05);
  EXPECT_EQ(messages.back(), "no such number");
  server->refuses_parameters.clear();
  server->parameters.clear();
  server->come_back();
  run_for(0.01);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_EQ(server->parameters, (std::vector<link::SetParameters>{kHarderSkin}));
}

TEST_F(SupervisionTest, ContinuesWithoutRefusedParameters) {
  start();
  tool->set_parameters(kHarderSkin);
  run_for(0.05);
  server->refuses_parameters = "no such number";
  server->come_back();
  run_for(0.01);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_EQ(messages.back(), "no such number");
}

TEST_F(SupervisionTest, SendsParametersThatChangedWhileItPrepared) {
  supervise();
  ASSERT_TRUE(run_until([&] { return server->count(ServerCommand::kStart) == 1; }));
  tool->set_parameters(kHarderSkin);
  EXPECT_TRUE(server->parameters.empty());
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  run_for(0.01);
  EXPECT_EQ(server->parameters, (std::vector<link::SetParameters>{kHarderSkin}));
}

TEST_F(SupervisionTest, DoesNotCountTimeWithoutPollsAsServerDelay) {
  supervise("virtual:premium");
  server->is_device_fixed = true;  // it is never where it was put
  run_for(0.1);
  clock.advance(std::chrono::seconds(10));
  run_for(0.1);
  EXPECT_FALSE(has_given_up());
  EXPECT_EQ(server->connections, 1);
  ASSERT_TRUE(run_until([&] { return server->connections == 2; }, 2.0 * kTimeout_s));
}

TEST_F(SupervisionTest, GivesUpOnARefusedScene) {
  supervise();
  server->refuses_scene = "no such patient";
  EXPECT_TRUE(run_until([&] { return has_given_up(); }, 10.0)) << tool->banner();
  EXPECT_TRUE(shows("no such patient")) << tool->banner();
}

}  // namespace
}  // namespace trocar::attempt
