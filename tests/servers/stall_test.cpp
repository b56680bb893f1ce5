// Servers and clients that get no processor for a while: nothing died, so nothing may be ended or moved for it.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <future>

#include "attempt/live/realtime_session.h"
#include "attempt/servers/remote_server.h"
#include "attempt/servers/server_supervisor.h"
#include "cases/prepare_case.h"
#include "servers/live_attempt_lab.h"
#include "storage/session_file.h"

namespace trocar::servers_test {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kImpatient{1000};  ///< A stall is meant to be longer than this.
constexpr milliseconds kLongStall{2500};
constexpr milliseconds kShortStall{500};  ///< Twice the hole that a server's loop may have, shorter than any patience.
/// A needle that rests in tissue creeps by some hundredths; the hole of a jump would be millimetres.
constexpr double kCreep_mm = 0.5;

/// No processor for a process: it is stopped, and goes on when this ends.
class Stall {
 public:
  explicit Stall(int pid) : pid_(pid) { ::kill(pid, SIGSTOP); }
  ~Stall() { ::kill(pid_, SIGCONT); }
  Stall(const Stall&) = delete;
  Stall& operator=(const Stall&) = delete;
  void lasts(milliseconds duration) const {
    const auto end = std::chrono::steady_clock::now() + duration;
    wait_for([&] { return std::chrono::steady_clock::now() > end; });
  }

 private:
  int pid_;
};

/// This very process gets no processor for so long: only another one can wake it.
void stall_myself(milliseconds duration) {
  const std::string pid = std::to_string(::getpid());
  const std::string seconds = std::to_string(0.001 * static_cast<double>(duration.count()));
  auto waker = link::ServerProcess::start(
      "/bin/sh", {"-c", "kill -STOP " + pid + "; sleep " + seconds + "; kill -CONT " + pid}, "/dev/null");
  ASSERT_TRUE(waker) << waker.error().text();
  EXPECT_TRUE(wait_for([&] { return !waker->is_running(); }));
}

class Stalls : public LiveAttemptTest {
 protected:
  attempt::AttemptOptions impatient(const std::string& device) const {
    attempt::AttemptOptions chosen = options();
    chosen.device_needle = device;
    chosen.device_probe = "mouse";
    chosen.timeout = kImpatient;
    return chosen;
  }
  /// The hand goes to that depth on the planned path and stays; false: the needle did not come to rest there.
  bool push_to(double depth_mm) {
    const Segment& path_P = open->the_case.plan.line_P;
    hand_ = needle_pose(path_P.a + depth_mm * path_P.direction(), path_P.direction());
    double rest_s = 0.0;
    return wait_for([&] {
      attempt->set_goal(attempt::HandTool::kNeedle, hand_);
      const attempt::AttemptView view = attempt->view();
      const bool is_at_rest = view.needle.depth_mm > 0.5 * depth_mm && std::abs(view.needle.speed_mm_s) < 0.2;
      if (!is_at_rest) rest_s = view.session_s;
      return view.session_s > rest_s + 0.5;
    });
  }
  /// And has done so for a while: what a stall brings shows some ticks after its end.
  bool goes_on() {
    auto since = std::chrono::steady_clock::now();
    return wait_for([&] {
      const attempt::AttemptView view = attempt->view();
      const bool is_well =
          view.phase == attempt::AttemptPhase::kInBody && view.banner.empty() && view.servers[0].gate == "on";
      const auto now = std::chrono::steady_clock::now();
      if (!is_well) since = now;
      return now - since > milliseconds(300);
    });
  }
  const Vec3& tip_P() { return (view_ = attempt->view()).needle.X_PN.p(); }
  /// What the session says: the tip never leapt, and after no pause did the force leap.
  void expect_smooth_session() {
    const auto session = storage::load_session(options().session);
    ASSERT_TRUE(session) << session.error().text();
    double furthest_mm = 0.0, largest_rise_n = 0.0;
    for (std::size_t i = 1; i < session->samples.size(); ++i) {
      const telemetry::TickSample& before = session->samples[i - 1];
      const telemetry::TickSample& now = session->samples[i];
      const double dt_s = now.time_s - before.time_s;
      if (now.phase == telemetry::InsertionPhase::kOutside) continue;
      // A hand makes 60 mm/s.
      if (dt_s > 0.1) furthest_mm = std::max(furthest_mm, (now.tip_mm - before.tip_mm).norm());
      // Of neighbours alone: where the machine skipped periods the force goes on from where it would be.
      if (dt_s < 0.0015) largest_rise_n = std::max(largest_rise_n, now.device_f_n.norm() - before.device_f_n.norm());
    }
    EXPECT_LT(furthest_mm, kCreep_mm);
    EXPECT_LT(largest_rise_n, 0.5) << "N in one tick";
  }

  Pose hand_;
  attempt::AttemptView view_;
};

TEST_F(Stalls, AServerThatIsStoppedIsWaitedForAndTheNeedleStays) {
  open = abdomen_case();
  for (const char* device : {"mouse", "virtual:premium"}) {
    SCOPED_TRACE(device);
    start(impatient(device));
    ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
    ASSERT_TRUE(push_to(20.0)) << where();
    const Vec3 rest_P = tip_P();
    const int pid = attempt->view().servers[0].pid;
    for (const milliseconds duration : {kShortStall, kLongStall}) {
      {
        const Stall stall(pid);
        stall.lasts(duration);
        EXPECT_EQ(attempt->view().phase, attempt::AttemptPhase::kServerLost);
        EXPECT_NE(attempt->view().banner.find("does not respond"), std::string::npos) << attempt->view().banner;
      }
      ASSERT_TRUE(goes_on()) << where();
      EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm) << duration.count() << " ms";
      EXPECT_EQ(attempt->view().servers[0].pid, pid) << "a slow server was ended";
    }
    attempt->finish();
    finished();
    expect_smooth_session();
    std::filesystem::remove(options().session);
  }
}

TEST_F(Stalls, AServerThatNeverGoesOnIsReplacedAtLast) {
  start(impatient("mouse"));
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(push_to(20.0)) << where();
  const Vec3 rest_P = tip_P();
  const int pid = attempt->view().servers[0].pid;
  ::kill(pid, SIGSTOP);
  ASSERT_TRUE(wait_for([&] { return attempt->view().servers[0].pid != pid; })) << where();
  ASSERT_TRUE(goes_on()) << where();
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

TEST_F(Stalls, ServersAreNotBlamedWhenTheSeatItselfStoodStill) {
  start(impatient("mouse"));
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(push_to(20.0)) << where();
  const Vec3 rest_P = tip_P();
  const int pids[] = {attempt->view().servers[0].pid, attempt->view().servers[1].pid};
  for (int stall = 0; stall < 3; ++stall) {  // whichever thread is first afterwards
    stall_myself(kLongStall);
    ASSERT_TRUE(goes_on()) << where();
  }
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
  for (const int tool : {0, 1}) {
    EXPECT_EQ(attempt->view().servers[tool].pid, pids[tool]) << attempt->view().servers[tool].tool;
    EXPECT_EQ(attempt->view().servers[tool].restarts, 0) << attempt->view().servers[tool].tool;
  }
  attempt->finish();
  finished();
  expect_smooth_session();
}

TEST_F(Stalls, NoNumberOfStallsIsTooMuch) {
  start(impatient("mouse"));
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(push_to(20.0)) << where();
  const Vec3 rest_P = tip_P();
  const int pid = attempt->view().servers[0].pid;
  for (int stall = 0; stall < 8; ++stall) {
    Stall(pid).lasts(kShortStall);
    ASSERT_TRUE(goes_on()) << where() << " after stall " << stall;
  }
  EXPECT_EQ(attempt->view().servers[0].pid, pid);
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

TEST_F(Stalls, KillsBeforeTheServerIsBackLeaveTheNeedleWhereItWas) {
  start(impatient("mouse"));
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(push_to(20.0)) << where();
  const Vec3 rest_P = tip_P();
  for (int killed = 0; killed < 3; ++killed) {
    const int pid = attempt->view().servers[0].pid;
    ::kill(pid, SIGKILL);
    ASSERT_TRUE(wait_for([&] { return attempt->view().servers[0].pid != pid; })) << where();
  }
  ASSERT_TRUE(goes_on()) << where();
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
  EXPECT_EQ(attempt->view().servers[0].restarts, 3);
}

/// A hand that goes on while nothing answers would find the needle elsewhere when it does.
TEST_F(Stalls, WhatTheHandDoesMeanwhileIsForgotten) {
  start(impatient("mouse"));
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  ASSERT_TRUE(push_to(20.0)) << where();
  const Vec3 rest_P = tip_P();
  {
    const Stall stall(attempt->view().servers[0].pid);
    ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kServerLost)) << where();
    attempt->set_goal(attempt::HandTool::kNeedle, hand_ * Pose::translation({0.0, 0.0, 15.0}));
    stall.lasts(kShortStall);
  }
  ASSERT_TRUE(goes_on()) << where();
  const double since_s = attempt->view().session_s;
  ASSERT_TRUE(wait_for([&] { return attempt->view().session_s > since_s + 0.5; }));
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

/// A client that went away without a word holds its server for a while: the next one waits for that.
TEST(SupervisorStalls, WaitsForControlThatIsNotFreeYet) {
  LiveServer server;
  auto gone = std::make_unique<link::HapticClient>(connect(server.url()));
  ASSERT_TRUE(wait_for([&] { return gone->view().welcome.has_control; }));
  SteadyClock clock;
  attempt::RemoteServer host(server.url(), {});
  attempt::ServerSupervisor supervisor(host, {attempt::Recovery::kReturnsOnly, kPatience}, clock);
  ASSERT_TRUE(wait_for([&] {
    supervisor.poll();
    return supervisor.client().welcome.session != 0;
  }));
  gone.reset();
  EXPECT_TRUE(wait_for([&] {
    supervisor.poll();
    return supervisor.state() == attempt::ServerState::kIdle;
  }));
}

class RealtimeStalls : public ::testing::Test {
 protected:
  /// `trocar run --realtime` on a thread of its own; a watcher sees how deep its needle is.
  void begin(milliseconds patience) {
    auto prepared = cases::prepare_case(abdomen_case()->the_case.patient, {});
    ASSERT_TRUE(prepared) << prepared.error().text();
    the_case_.emplace(*std::move(prepared));
    attempt::RunOptions run;
    run.operator_name = "expert";
    run.patient_source = "abdomen";
    run.session = folder_ / "live.session";
    attempt::RealtimeOptions realtime;
    realtime.endpoints = {server_.url()};
    realtime.timeout = patience;
    result_ = std::async(std::launch::async, [this, run, realtime] {
      return attempt::run_realtime_session(*the_case_, run, realtime, {});
    });
  }
  bool wait_deeper(double depth_mm) {
    return wait_for([&] {
      const auto newest = watcher_.newest();
      return newest && newest->depth_mm > depth_mm;
    });
  }
  double furthest_mm() const {
    const auto session = storage::load_session(folder_ / "live.session");
    EXPECT_TRUE(session) << session.error().text();
    double furthest = 0.0;
    for (std::size_t i = 1; session && i < session->samples.size(); ++i)
      furthest = std::max(furthest, (session->samples[i].tip_mm - session->samples[i - 1].tip_mm).norm());
    return furthest;
  }

  TemporaryFolder folder_;
  LiveServer server_;
  link::HapticClient watcher_ = connect(server_.url(), false);
  std::optional<cases::Case> the_case_;
  std::future<Result<attempt::RunResult>> result_;
};

TEST_F(RealtimeStalls, AnAttemptOutlivesAServerThatStoodStill) {
  begin(kPatience);
  ASSERT_TRUE(wait_deeper(20.0));
  {
    Stall stall(server_.process().pid());
    stall.lasts(kShortStall);
  }
  const auto result = result_.get();
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_TRUE(result->outcome.target_reached);
  EXPECT_GT(result->outcome.score, 80.0);
  EXPECT_FALSE(result->warnings.empty());
  EXPECT_LT(furthest_mm(), 2.0) << "where it was put again";
}

TEST_F(RealtimeStalls, AnAttemptThatStoodStillItselfDoesNotBlameItsServer) {
  begin(kImpatient);
  ASSERT_TRUE(wait_deeper(20.0));
  stall_myself(kLongStall);
  const auto result = result_.get();
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_TRUE(result->outcome.target_reached);
}

}  // namespace
}  // namespace trocar::servers_test
