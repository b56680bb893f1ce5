// Supervision for the command line: servers are only prepared again, all else is a failure.
#include "attempt/servers/test/supervision_lab.h"

namespace trocar::attempt {
namespace {

using link::ServerCommand;
using telemetry::GateFault;

class ReturnsOnly : public SupervisionTest {
 protected:
  ReturnsOnly() { recovery = Recovery::kReturnsOnly; }
};

TEST_F(ReturnsOnly, PreparesARestartedOrStalledServerAgain) {
  start();
  server->come_back();
  run_for(0.01);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  server->set_fault(GateFault::kLoopStalled);
  run_for(0.01);
  ASSERT_TRUE(run_until([&] { return tool->is_fresh(); }));
  EXPECT_EQ(tool->activations(), 3);
  EXPECT_EQ(tool->figures().returns, 2);
}

TEST_F(ReturnsOnly, FailsWhenAServerEnds) {
  start();
  server->end("it ended");
  run_for(0.01);
  EXPECT_TRUE(has_given_up());
  EXPECT_EQ(tool->failure().what, "it ended");
  EXPECT_EQ(server->restarts, 0);
}

TEST_F(ReturnsOnly, FailsAfterTheTimeoutEvenWithoutProcessorTime) {
  start();
  server->is_silent = server->has_no_processor = true;
  run_for(0.9 * kTimeout_s);
  EXPECT_FALSE(has_given_up());
  run_for(0.2 * kTimeout_s);
  EXPECT_TRUE(has_given_up());
  EXPECT_NE(tool->failure().what.find("has not responded"), std::string::npos) << tool->failure().what;
}

TEST_F(ReturnsOnly, FailsWithAnyOtherFault) {
  start();
  server->set_fault(GateFault::kRunaway);
  run_for(0.01);
  EXPECT_TRUE(has_given_up());
  EXPECT_EQ(server->count(ServerCommand::kResetFault), 0);
}

TEST_F(ReturnsOnly, FailsOnAFaultThatExistedBefore) {
  supervise();
  server->set_fault(GateFault::kRunaway);
  EXPECT_TRUE(run_until([&] { return has_given_up(); }, 1.0));
}

TEST_F(ReturnsOnly, FailsWhereAnotherClientHasControl) {
  supervise();
  server->has_control = false;
  ASSERT_TRUE(run_until([&] { return has_given_up(); }, 5.0));
  EXPECT_EQ(tool->failure().what, "another client controls this server");
}

}  // namespace
}  // namespace trocar::attempt
