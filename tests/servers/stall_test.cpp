// Servers and clients that get no processor for a while: nothing has ended, so nothing may be ended or moved for it. In
// the time of the test; process_stall_test.cpp stops real processes.
#include <gtest/gtest.h>

#include <algorithm>

#include "attempt/live/realtime_session.h"
#include "servers/simulated_attempt_lab.h"
#include "storage/session_file.h"

namespace trocar::servers_test {
namespace {

using attempt::AttemptPhase;
using std::chrono::milliseconds;

constexpr milliseconds kImpatient{1000};  ///< A long stall is longer than this.
constexpr double kLongStall_s = 2.5;
constexpr double kShortStall_s = 0.5;  ///< Twice the hole that a server's loop may have, shorter than any timeout.
/// A needle that rests in tissue creeps by some hundredths; the hole of a jump would be millimetres.
constexpr double kCreep_mm = 0.5;

class Stalls : public SimulatedAttemptTest {
 protected:
  attempt::AttemptOptions impatient(const std::string& device) const {
    attempt::AttemptOptions chosen = options();
    chosen.device_needle = device;
    chosen.device_probe = "mouse";
    chosen.timeout = kImpatient;
    return chosen;
  }
  /// The needle is pushed in and rests.
  void start_inside(const std::string& device = "mouse") {
    start(impatient(device));
    ASSERT_TRUE(run_until_phase(AttemptPhase::kReady)) << where();
    ASSERT_TRUE(push_to(30.0)) << where();
    rest_P = tip_P();
  }
  /// The hand goes to that depth on the planned path and stays; false: the needle did not come to rest there.
  bool push_to(double depth_mm) {
    const Segment& path_P = open->the_case.plan.line_P;
    hand = needle_pose(path_P.a + depth_mm * path_P.direction(), path_P.direction());
    double rest_s = 0.0;
    return run_until([&] {
      attempt->set_goal(attempt::Tool::kNeedle, hand);
      const attempt::AttemptView view = attempt->view();
      const bool is_at_rest = view.needle.depth_mm > 0.5 * depth_mm && std::abs(view.needle.speed_mm_s) < 0.2;
      if (!is_at_rest) rest_s = view.session_s;
      return view.session_s > rest_s + 0.5;
    });
  }
  /// And has done so for a while: what a stall brings shows some ticks after its end.
  bool goes_on() {
    Clock::TimePoint since = clock->now();
    return run_until([&] {
      const attempt::AttemptView view = attempt->view();
      const bool is_well = view.phase == AttemptPhase::kInBody && view.banner.empty() &&
                           view.servers[0].gate == telemetry::GateMode::kOn;
      if (!is_well) since = clock->now();
      return clock->now() - since > milliseconds(300);
    });
  }
  Vec3 tip_P() const { return attempt->view().needle.X_PN.p(); }
  void stall_needle(double seconds) {
    needle->pause();
    run_for(seconds);
    needle->go_on();
  }
  /// What the session says: the tip never leapt, and after no pause did the force leap.
  void expect_smooth_session() {
    const auto session = storage::load_session(options().session);
    ASSERT_TRUE(session) << session.error().text();
    double furthest_mm = 0.0, largest_rise_n = 0.0, punctured_s = -1.0;
    for (std::size_t i = 1; i < session->samples.size(); ++i) {
      const telemetry::TickSample& before = session->samples[i - 1];
      const telemetry::TickSample& now = session->samples[i];
      const double dt_s = now.time_s - before.time_s;
      if (now.phase == telemetry::InsertionPhase::kOutside) continue;
      // A hand makes 60 mm/s.
      if (dt_s > 0.1) furthest_mm = std::max(furthest_mm, (now.tip_mm - before.tip_mm).norm());
      for (const telemetry::TickEvent& event : before.events)
        if (event.kind == telemetry::EventKind::kPuncture) punctured_s = before.time_s;
      constexpr double kPuncture_s = 0.02;  // the tissue's own leap
      if (now.time_s - punctured_s < kPuncture_s) continue;
      // Of neighbours alone: where the machine skipped periods the force goes on from where it would be.
      if (dt_s < 0.0015) largest_rise_n = std::max(largest_rise_n, now.device_f_n.norm() - before.device_f_n.norm());
    }
    EXPECT_LT(furthest_mm, kCreep_mm);
    EXPECT_LT(largest_rise_n, 0.5) << "N in one tick";
  }

  Pose hand;
  Vec3 rest_P;
};

TEST_F(Stalls, WaitForAStalledServerWithoutMovingTheNeedle) {
  open = prepared_case("abdomen");
  for (const char* device : {"mouse", "virtual:premium"}) {
    SCOPED_TRACE(device);
    start_inside(device);
    for (const double seconds : {kShortStall_s, kLongStall_s}) {
      needle->pause();
      run_for(seconds);
      EXPECT_EQ(attempt->view().phase, AttemptPhase::kServerLost);
      EXPECT_NE(attempt->view().banner.find("does not respond"), std::string::npos) << attempt->view().banner;
      needle->go_on();
      ASSERT_TRUE(goes_on()) << where();
      EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm) << seconds << " s";
      EXPECT_EQ(needle->restarts(), 0) << "a slow server was ended";
    }
    finished();
    expect_smooth_session();
    std::filesystem::remove(options().session);
  }
}

TEST_F(Stalls, ReplaceAServerThatNeverRecovers) {
  start_inside();
  needle->pause();
  ASSERT_TRUE(run_until([&] { return needle->restarts() == 1; })) << where();
  ASSERT_TRUE(goes_on()) << where();
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

TEST_F(Stalls, DoNotRestartServersAfterAClientStall) {
  start_inside();
  for (int stall = 0; stall < 3; ++stall) {
    stall_client(kLongStall_s);
    ASSERT_TRUE(goes_on()) << where();
  }
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
  EXPECT_EQ(needle->restarts() + probe->restarts(), 0);
  for (const int tool : {0, 1})
    EXPECT_EQ(attempt->view().servers[tool].restarts, 0) << attempt->view().servers[tool].tool;
  finished();
  expect_smooth_session();
}

TEST_F(Stalls, ContinueAfterAnyNumberOfStalls) {
  start_inside();
  for (int stall = 0; stall < 8; ++stall) {
    stall_needle(kShortStall_s);
    ASSERT_TRUE(goes_on()) << where() << " after stall " << stall;
  }
  EXPECT_EQ(needle->restarts(), 0);
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

TEST_F(Stalls, RepeatedKillsDoNotMoveTheNeedle) {
  start_inside();
  for (int killed = 1; killed <= 3; ++killed) {
    needle->kill();
    ASSERT_TRUE(run_until([&] { return needle->restarts() == killed; })) << where();
  }
  ASSERT_TRUE(goes_on()) << where();
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
  EXPECT_EQ(attempt->view().servers[0].restarts, 3);
}

/// What the needle presses on when its server dies is not pierced by coming back.
TEST_F(Stalls, RestartDoesNotPierceALoadedLayer) {
  for (const bool is_on_skin : {true, false}) {
    SCOPED_TRACE(is_on_skin ? "skin" : "muscle");
    start(impatient("mouse"));
    ASSERT_TRUE(run_until_phase(AttemptPhase::kReady)) << where();
    const auto& line_P = open->the_case.plan.line_P;
    const auto is_loading = [&] { return attempt->view().needle.phase == telemetry::InsertionPhase::kLoading; };
    double depth_mm = 0.0;
    const double from_mm = is_on_skin ? 0.0 : 8.0;
    ASSERT_TRUE(run_until([&] {  // slowly, until it presses
      depth_mm += 0.01;
      hand = needle_pose(line_P.a + depth_mm * line_P.direction(), line_P.direction());
      attempt->set_goal(attempt::Tool::kNeedle, hand);
      return attempt->view().needle.depth_mm > from_mm && is_loading();
    })) << where();
    run_for(1.0);
    ASSERT_TRUE(is_loading());
    needle->kill();
    ASSERT_TRUE(run_until([&] { return needle->restarts() == 1; })) << where();
    run_for(3.0);
    EXPECT_TRUE(is_loading()) << where();
    EXPECT_EQ(finished().punctures.size(), is_on_skin ? 0u : 1u);
    std::filesystem::remove(options().session);
  }
}

TEST_F(Stalls, AHungServerIsReplacedAfterTheTimeout) {
  start_inside();
  needle->hang();
  run_for(0.9 * std::chrono::duration<double>(kImpatient).count());
  EXPECT_EQ(needle->restarts(), 0);
  ASSERT_TRUE(run_until([&] { return needle->restarts() == 1; }, 0.5)) << where();
  ASSERT_TRUE(goes_on()) << where();
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

/// A hand that goes on while nothing answers would find the needle elsewhere when it does.
TEST_F(Stalls, DiscardHandMotionDuringAnOutage) {
  start_inside();
  needle->pause();
  ASSERT_TRUE(run_until_phase(AttemptPhase::kServerLost)) << where();
  attempt->set_goal(attempt::Tool::kNeedle, hand * Pose::translation({0.0, 0.0, 15.0}));
  run_for(kShortStall_s);
  needle->go_on();
  ASSERT_TRUE(goes_on()) << where();
  run_for(0.5);
  EXPECT_LT((tip_P() - rest_P).norm(), kCreep_mm);
}

/// The command line's attempt through one simulated server.
class RealtimeStalls : public ::testing::Test {
 protected:
  /// `stall` is called once, when the needle is so deep.
  Result<attempt::RunResult> run(milliseconds timeout, const std::function<void()>& stall) {
    auto host = needle.host();
    link::ClientOptions watching;
    watching.wants_control = false;
    const auto watcher = *host->connect(watching);
    std::vector<std::unique_ptr<attempt::ServerHost>> hosts;
    hosts.push_back(std::move(host));
    attempt::RunOptions options;
    options.patient_source = "abdomen";
    options.session = folder / "live.session";
    bool is_stalled = false;
    return attempt::run_realtime_session(open->the_case, options, std::move(hosts), timeout, clock,
                                         [&](std::string_view, double) {
                                           const auto newest = watcher->newest();
                                           // In the liver: behind a layer just punctured the needle is too fast for a
                                           // jump to be told from its way.
                                           if (is_stalled || !newest || newest->depth_mm < 45.0) return;
                                           is_stalled = true;
                                           stall();
                                         });
  }
  double furthest_mm() const {
    const auto session = storage::load_session(folder / "live.session");
    EXPECT_TRUE(session) << session.error().text();
    double furthest = 0.0;
    for (std::size_t i = 1; session && i < session->samples.size(); ++i)
      furthest = std::max(furthest, (session->samples[i].tip_mm - session->samples[i - 1].tip_mm).norm());
    return furthest;
  }

  TemporaryFolder folder;
  std::shared_ptr<const cases::OpenCase> open = prepared_case("abdomen");
  std::shared_ptr<testing::FakeClock> clock = std::make_shared<testing::FakeClock>();
  SimulatedServer needle{*clock, open->the_case.patient, {}};
  std::shared_ptr<const void> waker;
};

TEST_F(RealtimeStalls, AttemptSurvivesAStalledServer) {
  const auto result = run(milliseconds(30'000), [&] {
    needle.pause();
    const Clock::TimePoint end = clock->now() + milliseconds(500);
    waker = clock->attach([this, end] {
      if (clock->now() == end) needle.go_on();
    });
  });
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_TRUE(result->outcome.target_reached);
  EXPECT_GT(result->outcome.score, 80.0);
  EXPECT_FALSE(result->warnings.empty());
  EXPECT_LT(furthest_mm(), 2.0) << "where it was put again";
}

TEST_F(RealtimeStalls, ClientStallDoesNotRestartTheServer) {
  const auto result = run(kImpatient, [&] {
    needle.stall_client(true);
    clock->advance(std::chrono::milliseconds(2500));
    needle.stall_client(false);
  });
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_TRUE(result->outcome.target_reached);
}

}  // namespace
}  // namespace trocar::servers_test
