// An attempt through live servers: the same as in-process, and whole up to where a server went away.

#include "attempt/live/realtime_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "attempt.h"
#include "cases/testing/phantom_case.h"
#include "live_server.h"

namespace trocar::testing {
namespace {

using std::chrono::milliseconds;

constexpr const char* kQuickOperator = "constant-velocity:60";
constexpr milliseconds kShort{700};     // ends before a quick attempt does
constexpr milliseconds kMedium{1'500};  // a slow build's server answers within it
constexpr milliseconds kLong{20'000};   // a machine under load

bool has_event(const storage::Session& session, telemetry::LimitReason reason) {
  return std::any_of(session.samples.begin(), session.samples.end(), [reason](const telemetry::TickSample& sample) {
    return std::any_of(sample.events.begin(), sample.events.end(), [reason](const telemetry::TickEvent& event) {
      return event.kind == telemetry::EventKind::kLimit && event.id == static_cast<std::uint8_t>(reason);
    });
  });
}

class RealtimeSession : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto prepared = phantom_case("abdomen");
    ASSERT_TRUE(prepared.has_value()) << prepared.error().text();
    the_case = new cases::Case(*std::move(prepared));
  }
  static void TearDownTestSuite() {
    delete the_case;
    the_case = nullptr;
  }
  static inline cases::Case* the_case = nullptr;

  attempt::RunOptions run_options(const std::string& operator_name) const {
    attempt::RunOptions options;
    options.operator_name = operator_name;
    options.patient_source = the_case->patient->name;
    options.session = folder_ / "live.session";
    return options;
  }
  Result<attempt::RunResult> perform_live(const std::string& operator_name, const std::vector<std::string>& endpoints,
                                          milliseconds timeout, const Progress& progress = {}) const {
    attempt::RealtimeOptions realtime;
    realtime.endpoints = endpoints;
    realtime.timeout = timeout;
    return attempt::run_realtime_session(*the_case, run_options(operator_name), realtime, progress);
  }
  storage::Session recorded() const {
    auto session = storage::load_session(folder_ / "live.session");
    EXPECT_TRUE(session.has_value()) << (session ? "" : session.error().text());
    return session ? *std::move(session) : storage::Session{};
  }
  bool has_session() const { return std::filesystem::exists(folder_ / "live.session"); }

  /// Calls `act` once, when so much of the attempt is done.
  static Progress once_after(double attempt_s, std::function<void()> act) {
    return [attempt_s, act = std::move(act), is_done = std::make_shared<bool>(false)](std::string_view step,
                                                                                      double fraction) {
      constexpr double kLongest_s = 120.0;  // the fraction's whole
      if (*is_done || step != "performing" || fraction * kLongest_s < attempt_s) return;
      *is_done = true;
      act();
    };
  }

  TemporaryFolder folder_;
};

TEST_F(RealtimeSession, ExpertThroughTwoServersMatchesInProcess) {
  const Attempt in_process = perform(*the_case, "expert");
  const LiveServer needle(*the_case, "needle", folder_);
  const LiveServer probe(*the_case, "probe", folder_);
  const auto live = perform_live("expert", {probe.url(), needle.url()}, kLong);  // told apart by what they hold
  ASSERT_TRUE(live.has_value()) << live.error().text();

  Attempt attempt{*live, recorded()};
  ASSERT_EQ(layers_of(attempt), layers_of(in_process));
  // Measured: 0.01 N and 0.4 points in eight attempts. A puncture is noticed at a tick: ten missed ones while the hand
  // presses at 9 mm/s against 1 N/mm are 0.09 N. The score's steps are voxels in the core, 0.4 points each.
  constexpr double kPeakShare = 0.05;
  for (std::size_t i = 0; i < live->punctures.size(); ++i)
    EXPECT_NEAR(live->punctures[i].peak_n, in_process.result.punctures[i].peak_n,
                kPeakShare * in_process.result.punctures[i].peak_n)
        << live->punctures[i].layer;
  constexpr double kPoints = 3.0;
  EXPECT_NEAR(live->outcome.score, in_process.result.outcome.score, kPoints);
  EXPECT_TRUE(live->outcome.target_reached);

  EXPECT_EQ(attempt.session.samples.size(), live->ticks);
  EXPECT_EQ(attempt.session.samples.front().time_s, 0.0);
  const auto& transducer = attempt.session.transducer;
  ASSERT_FALSE(transducer.empty());
  EXPECT_TRUE(std::any_of(transducer.begin(), transducer.end(), [](const auto& m) { return m.contact_n > 0.1; }));
  EXPECT_NE(attempt.session.info.device.find("through trocar-hapticd"), std::string::npos);
  ASSERT_EQ(live->servers.size(), 2u);
  EXPECT_EQ(live->servers[0].tool, "needle");
  EXPECT_EQ(live->servers[1].tool, "probe");
  for (const attempt::ServerFigures& server : live->servers) EXPECT_GT(server.ticks_received, 0u) << server.tool;
}

TEST_F(RealtimeSession, ResumesAtTheNeedlePoseAfterAServerRestart) {
  LiveServer needle(*the_case, "needle", folder_);
  const auto live = perform_live(kQuickOperator, {needle.url()}, kLong, once_after(1.0, [&] {
                                   needle.end();
                                   needle.start();
                                 }));
  ASSERT_TRUE(live.has_value()) << live.error().text();
  EXPECT_GE(live->servers.at(0).returns, 1);  // a busy machine may add one
  EXPECT_FALSE(live->warnings.empty());
  const storage::Session session = recorded();
  ASSERT_TRUE(session.outcome.has_value());
  EXPECT_TRUE(has_event(session, telemetry::LimitReason::kResumedInside));
  EXPECT_EQ(layers_of({*live, session}), (std::vector<std::string>{"skin", "muscle", "liver_capsule"}));  // none twice
  double furthest_mm = 0.0;
  for (std::size_t i = 1; i < session.samples.size(); ++i) {
    ASSERT_GT(session.samples[i].time_s, session.samples[i - 1].time_s);
    furthest_mm = std::max(furthest_mm, (session.samples[i].device_mm - session.samples[i - 1].device_mm).norm());
  }
  EXPECT_LT(furthest_mm, 10.0);  // the pause of a second would be 60 mm at this speed
  EXPECT_TRUE(live->outcome.target_reached);
}

/// The hand of an operator that feels is soft: without forces it would let the stylus sag out of the needle's channel.
TEST_F(RealtimeSession, NeedleStaysInItsChannelDuringAServerOutage) {
  const Attempt in_process = perform(*the_case, "expert");
  const auto& samples = in_process.session.samples;
  const auto is_deep = [](const auto& sample) { return sample.depth_mm > 25.0; };
  const auto deep = std::find_if(samples.begin(), samples.end(), is_deep);
  ASSERT_NE(deep, samples.end());
  LiveServer needle(*the_case, "needle", folder_);
  const auto live = perform_live("expert", {needle.url()}, kLong, once_after(deep->time_s, [&] {
                                   needle.end();
                                   needle.start();
                                 }));
  ASSERT_TRUE(live.has_value()) << live.error().text();
  EXPECT_GE(live->servers.at(0).returns, 1);  // a busy machine may add one
  EXPECT_EQ(layers_of({*live, recorded()}), layers_of(in_process));
  constexpr double kPoints = 5.0;  // the pause costs time
  EXPECT_NEAR(live->outcome.score, in_process.result.outcome.score, kPoints);
}

TEST_F(RealtimeSession, ContinuesWithoutTheProbeServer) {
  const LiveServer needle(*the_case, "needle", folder_);
  LiveServer probe(*the_case, "probe", folder_);
  const auto live =
      perform_live(kQuickOperator, {needle.url(), probe.url()}, kShort, once_after(1.0, [&] { probe.end(); }));
  ASSERT_TRUE(live.has_value()) << live.error().text();
  EXPECT_TRUE(live->outcome.target_reached);
  EXPECT_EQ(live->servers.size(), 2u);
  EXPECT_TRUE(std::ranges::any_of(live->warnings, [](const std::string& warning) {  // a busy machine adds one
    return warning.find("without the probe") != std::string::npos;
  })) << fmt::format("{}", fmt::join(live->warnings, "; "));
}

TEST_F(RealtimeSession, KeepsTheRecordingWhenTheNeedleServerStaysLost) {
  LiveServer needle(*the_case, "needle", folder_);
  const auto live = perform_live(kQuickOperator, {needle.url()}, kMedium, once_after(1.0, [&] { needle.end(); }));
  ASSERT_FALSE(live.has_value());
  EXPECT_EQ(live.error().exit_status, 1);
  EXPECT_NE(live.error().text().find(needle.url()), std::string::npos) << live.error().text();
  const storage::Session session = recorded();
  EXPECT_FALSE(session.outcome.has_value());
  ASSERT_FALSE(session.samples.empty());
  EXPECT_GT(session.samples.back().time_s, 0.9);
}

TEST_F(RealtimeSession, ReportsAMissingServerAndWritesNothing) {
  const auto live = perform_live(kQuickOperator, {"ipc://" + (folder_ / "nobody").string()}, milliseconds(100));
  ASSERT_FALSE(live.has_value());
  EXPECT_EQ(live.error().exit_status, 1);
  EXPECT_NE(live.error().text().find("trocar-hapticd"), std::string::npos) << live.error().text();
  EXPECT_FALSE(has_session());
}

TEST_F(RealtimeSession, RequiresANeedleServer) {
  const LiveServer probe(*the_case, "probe", folder_);
  const auto live = perform_live(kQuickOperator, {probe.url()}, kLong);
  ASSERT_FALSE(live.has_value());
  EXPECT_NE(live.error().text().find("needle"), std::string::npos) << live.error().text();
  EXPECT_FALSE(has_session());
}

}  // namespace
}  // namespace trocar::testing
