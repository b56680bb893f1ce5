// Real processes that get no processor: a stopped server, and this very program. The rules of stalls are tested in
// simulated time (stall_test.cpp).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "servers/live_attempt_lab.h"

namespace trocar::servers_test {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStall{500};       ///< Twice the hole that a server's loop may have.
constexpr double kRestingCreep_mm = 0.5;  ///< Of a needle that rests in tissue.

/// This very process gets no processor for so long: only another one can wake it.
void stall_myself(milliseconds duration) {
  const std::string pid = std::to_string(::getpid());
  const std::string seconds = fmt::format("{}", 0.001 * static_cast<double>(duration.count()));
  auto waker = link::ServerProcess::start(
      "/bin/sh", {"-c", "kill -STOP " + pid + "; sleep " + seconds + "; kill -CONT " + pid}, "/dev/null");
  ASSERT_TRUE(waker) << waker.error().text();
  EXPECT_TRUE(wait_for([&] { return !waker->is_running(); }));
}

class ProcessStalls : public LiveAttemptTest {
 protected:
  /// The needle is pushed in and rests.
  void start_inside() {
    attempt::AttemptOptions chosen = options();
    chosen.device_needle = chosen.device_probe = "mouse";
    chosen.timeout = milliseconds(1000);
    start(chosen);
    ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
    const Segment& path_P = open->the_case.plan.line_P;
    const Pose hand = needle_pose(path_P.a + 20.0 * path_P.direction(), path_P.direction());
    double rest_s = 0.0;
    ASSERT_TRUE(wait_for([&] {
      attempt->set_goal(attempt::Tool::kNeedle, hand);
      const attempt::AttemptView view = attempt->view();
      const bool is_at_rest = view.needle.depth_mm > 10.0 && std::abs(view.needle.speed_mm_s) < 0.2;
      if (!is_at_rest) rest_s = view.session_s;
      return view.session_s > rest_s + 0.5;
    })) << where();
    rest_P = attempt->view().needle.X_PN.p();
    pid = attempt->view().servers[0].pid;
  }
  void expect_going_on() {
    ASSERT_TRUE(wait_for([&] {
      const attempt::AttemptView view = attempt->view();
      return view.phase == attempt::AttemptPhase::kInBody && view.banner.empty() &&
             view.servers[0].gate == telemetry::GateMode::kOn;
    })) << where();
    EXPECT_LT((attempt->view().needle.X_PN.p() - rest_P).norm(), kRestingCreep_mm);
    EXPECT_EQ(attempt->view().servers[0].pid, pid) << "a slow server was ended";
    EXPECT_EQ(attempt->view().servers[0].restarts, 0);
  }

  Vec3 rest_P;
  int pid = 0;
};

TEST_F(ProcessStalls, WaitForASuspendedServer) {
  start_inside();
  ::kill(pid, SIGSTOP);
  EXPECT_TRUE(wait_phase(attempt::AttemptPhase::kServerLost)) << where();
  const auto end = std::chrono::steady_clock::now() + kStall;
  wait_for([&] { return std::chrono::steady_clock::now() > end; });
  ::kill(pid, SIGCONT);
  expect_going_on();
}

TEST_F(ProcessStalls, DoNotCountAgainstServersIfThisProgramStalls) {
  start_inside();
  stall_myself(kStall);
  expect_going_on();
}

}  // namespace
}  // namespace trocar::servers_test
