#include "attempt/live/live_operator.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/files/folders.h"
#include "phantom/phantom.h"

namespace trocar::attempt {
namespace {

/// Keeps what it is shown, and wants the needle as many mm down as it was asked times.
class Witness final : public tasks::Operator {
 public:
  tasks::HandCommand next(const tasks::OperatorView& view) noexcept override {
    views.push_back(view);
    tasks::HandCommand command;
    command.X_PN = Pose::translation({0.0, static_cast<double>(views.size()), 0.0});
    command.v_P = {0.0, 7.0, 0.0};
    if (views.size() == fires_at) command.action = tasks::ActionRequest{tasks::ActionKind::kFire};
    command.is_done = views.size() == done_at;
    return command;
  }
  std::vector<tasks::OperatorView> views;
  std::size_t fires_at = 0, done_at = 0;
};

class LiveOperatorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto patient = phantom::generate_phantom("layers-liver");
    auto tables = cases::load_tables({});
    ASSERT_TRUE(patient.has_value() && tables.has_value());
    the_case_ = *std::move(tables);
    the_case_.patient = std::make_shared<const anatomy::VirtualPatient>(*std::move(patient));
    the_case_.plan.line_P = {Vec3::Zero(), Vec3(0.0, 50.0, 0.0)};
    auto witness = std::make_unique<Witness>();
    witness_ = witness.get();
    performer_.the_operator = std::move(witness);
    RecordOptions options;
    options.session = folder_ / "attempt.session";
    auto record = AttemptRecord::create(the_case_, options, {"a device", performer_.rate_hz, "insertion", "", {}});
    ASSERT_TRUE(record.has_value()) << record.error().text();
    record_.emplace(*std::move(record));
    live_.emplace(performer_, *record_, tasks::HandCommand{});
  }
  bool take(double server_time_s, telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside) {
    const auto goes_on = live_->take(tick(server_time_s, phase));
    EXPECT_TRUE(goes_on.has_value());
    return goes_on.value_or(false);
  }
  static telemetry::TickSample tick(double server_time_s,
                                    telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside) {
    telemetry::TickSample sample;
    sample.time_s = server_time_s;
    sample.phase = phase;
    return sample;
  }
  /// What is in the file when the attempt ends here.
  storage::Session recorded() {
    EXPECT_TRUE(record_->finish().has_value());
    auto session = storage::load_session(folder_ / "attempt.session");
    EXPECT_TRUE(session.has_value()) << (session ? "" : session.error().text());
    return session ? *std::move(session) : storage::Session{};
  }

  TemporaryFolder folder_;
  cases::Case the_case_;
  Performer performer_;
  Witness* witness_ = nullptr;
  std::optional<AttemptRecord> record_;
  std::optional<LiveOperator> live_;
  static constexpr double kServer_s = 5000.0;  // steady clock of the server when the attempt begins
  static constexpr double kTolerance_s = 1e-9;
};

TEST_F(LiveOperatorTest, RecordsFromZeroAndLooksOnePeriodAhead) {
  live_->begin(300.0);
  take(kServer_s);
  take(kServer_s + 0.001);
  ASSERT_EQ(witness_->views.size(), 2u);
  EXPECT_NEAR(witness_->views[0].time_s, 0.001, kTolerance_s);
  EXPECT_NEAR(witness_->views[1].time_s, 0.002, kTolerance_s);
  EXPECT_NEAR(witness_->views[1].dt_s, 0.001, kTolerance_s);
  const link::HandTarget hand = live_->hand();
  EXPECT_NEAR(hand.server_time_s, kServer_s + 0.002, kTolerance_s);
  EXPECT_EQ(hand.X_PN.p().y(), 2.0);
  EXPECT_EQ(hand.v_P.y(), 7.0);
  EXPECT_TRUE(hand.holds_tip);
  const storage::Session session = recorded();
  ASSERT_EQ(session.samples.size(), 2u);
  EXPECT_EQ(session.samples[0].time_s, 0.0);
  EXPECT_NEAR(session.samples[1].time_s, 0.001, kTolerance_s);
}

TEST_F(LiveOperatorTest, CoversMissingTicksWithOneLongerStep) {
  live_->begin(0.0);
  take(kServer_s);
  take(kServer_s + 0.006);
  EXPECT_NEAR(witness_->views[1].dt_s, 0.006, kTolerance_s);
  EXPECT_NEAR(witness_->views[1].time_s, 0.007, kTolerance_s);
}

TEST_F(LiveOperatorTest, PausesTheOperatorDuringAServerOutage) {
  live_->begin(100.0);
  take(kServer_s);
  take(kServer_s + 0.001, telemetry::InsertionPhase::kInserted);
  live_->begin(-4000.0);  // another machine's clock
  const double again_s = kServer_s - 100.0 - 4000.0 + 2.001;
  take(again_s, telemetry::InsertionPhase::kInserted);
  EXPECT_NEAR(live_->time_s(), 2.001, kTolerance_s);
  EXPECT_NEAR(live_->paused_s(), 1.999, kTolerance_s);
  EXPECT_NEAR(witness_->views[2].time_s, 0.003, kTolerance_s);
  EXPECT_NEAR(witness_->views[2].dt_s, 0.001, kTolerance_s);
  const storage::Session session = recorded();
  ASSERT_EQ(session.samples.size(), 3u);
  EXPECT_NEAR(session.samples[2].time_s, 2.001, kTolerance_s);
  EXPECT_EQ(session.samples[1].events[0].kind, telemetry::EventKind::kNone);
  EXPECT_EQ(session.samples[2].events[0].id, static_cast<std::uint8_t>(telemetry::LimitReason::kResumedInside));
}

TEST_F(LiveOperatorTest, ExcludesOutagesFromTheAttemptTime) {
  // 51 s of puncture, an outage of 39 s in the midst of it: the report says 51 s, not 90. The gun's time is active
  // time, too.
  constexpr double kActive_s = 51.0, kOutage_s = 39.0, kBefore_s = 20.0, kFired_s = 45.0;
  the_case_.plan.line_P = {Vec3::Zero(), Vec3(0.0, 50.0, 0.0)};
  const auto deeper = [&](double server_s, double depth_mm) {
    telemetry::TickSample sample = tick(kServer_s + server_s, telemetry::InsertionPhase::kInserted);
    sample.depth_mm = depth_mm;
    sample.axis = Vec3::UnitY();
    sample.tip_mm = {0.0, depth_mm, 0.0};
    telemetry::set_at_rest(sample);
    ASSERT_TRUE(live_->take(sample));
  };
  constexpr double kStep_s = 0.01;
  witness_->fires_at = static_cast<std::size_t>(kFired_s / kStep_s);  // a biopsy that was not fired has no score
  live_->begin(0.0);
  for (int n = 0; n * kStep_s <= kBefore_s; ++n) deeper(n * kStep_s, 1.0 + n * kStep_s);
  live_->begin(0.0);
  for (int n = 1; kBefore_s + n * kStep_s <= kActive_s; ++n)
    deeper(kBefore_s + kOutage_s + n * kStep_s, 1.0 + kBefore_s + n * kStep_s);
  EXPECT_NEAR(live_->active_s(), kActive_s, kStep_s + kTolerance_s);
  EXPECT_NEAR(live_->time_s(), kActive_s + kOutage_s, kStep_s + kTolerance_s);
  const auto result = record_->finish();
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_NEAR(result->active_s, kActive_s, 2.0 * kStep_s);
  const auto part = std::ranges::find(result->outcome.parts, "time", &scoring::ScorePart::name);
  ASSERT_NE(part, result->outcome.parts.end());
  EXPECT_NEAR(part->value, kFired_s, 2.0 * kStep_s);
  const auto session = storage::load_session(folder_ / "attempt.session");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->interruptions.size(), 1u);
  EXPECT_NEAR(session->interruptions[0].to_s - session->interruptions[0].from_s, kOutage_s, 2.0 * kStep_s);
  EXPECT_EQ(session->interruptions[0].reason, tasks::kServerWasAway);
}

TEST_F(LiveOperatorTest, CountsUnansweredTicksAsAnInterruption) {
  live_->begin(0.0);
  take(kServer_s);
  for (int n = 1; n <= 2000; ++n) ASSERT_TRUE(live_->take_unseen(tick(kServer_s + 0.001 * n)));
  take(kServer_s + 2.001);
  take(kServer_s + 2.002);
  EXPECT_NEAR(live_->active_s(), 0.002, kTolerance_s);
  take(kServer_s + 3.002);  // a second of ticks was lost on the way
  EXPECT_NEAR(live_->active_s(), 0.003, kTolerance_s);
  const storage::Session session = recorded();
  ASSERT_EQ(session.interruptions.size(), 2u);
  EXPECT_NEAR(session.interruptions[0].from_s, 0.001, kTolerance_s);
  EXPECT_NEAR(session.interruptions[0].to_s, 2.001, kTolerance_s);
  EXPECT_NEAR(session.interruptions[1].to_s, 3.002, kTolerance_s);
}

/// A server's reply to a command that made a scene.
link::Reply scene_reply(std::uint64_t number, const anatomy::TissueTable& tissues, const char* option) {
  return {1, true, "", number, {option}, tissues.to_toml()};
}

TEST_F(LiveOperatorTest, RecordsTheTickOfAParameterChange) {
  anatomy::TissueTable changed = the_case_.tissues;
  ASSERT_TRUE(anatomy::apply_override(changed, "skin.fp=6"));
  KnownScenes known;
  known.learn(scene_reply(3, the_case_.tissues, "bending=1"));
  live_->begin(0.0);
  std::uint64_t scene = 3;
  for (int n = 0; n < 10; ++n) {
    if (n == 4) scene = 4;
    if (n == 6) known.learn(scene_reply(4, changed, "bending=0"));  // the reply may come after the ticks
    if (n == 8) scene = 5;
    if (n == 8) known.learn(scene_reply(5, changed, "bending=0"));  // another scene with the same numbers
    take(kServer_s + 0.001 * n);
    ASSERT_TRUE(record_->note_scene(scene, known));
  }
  const storage::Session session = recorded();
  ASSERT_EQ(session.parameters.size(), 2u);
  EXPECT_EQ(session.parameters[0].tick, 0u);
  EXPECT_TRUE(session.parameters[0].settings.empty());
  EXPECT_EQ(session.parameters[1].tick, 4u);
  EXPECT_NEAR(session.parameters[1].time_s, 0.004, kTolerance_s);
  EXPECT_EQ(session.parameters[1].settings, (std::vector<std::string>{"skin.fp=6", "bending=0"}));
  EXPECT_EQ(session.parameters[1].tissue_table_toml, changed.to_toml());
}

TEST_F(LiveOperatorTest, WarnsIfAServerNeverReportedItsParameters) {
  live_->begin(0.0);
  take(kServer_s);
  ASSERT_TRUE(record_->note_scene(3, KnownScenes{}));
  const auto result = record_->finish();
  ASSERT_TRUE(result) << result.error().text();
  ASSERT_EQ(result->warnings.size(), 1u);
}

TEST_F(LiveOperatorTest, CountsTicksMissedWhileSuspendedAsUnseen) {
  live_->begin(0.0);
  take(kServer_s);
  for (int i = 1; i <= 1100; ++i) ASSERT_TRUE(live_->take_unseen(tick(kServer_s + 0.001 * i)));
  take(kServer_s + 6.0);  // the server dropped what was between
  constexpr double kStep_s = 0.02;
  EXPECT_NEAR(live_->unseen_s(), 6.0 - kStep_s, kTolerance_s);
  EXPECT_NEAR(live_->time_s(), 6.0, kTolerance_s);
  EXPECT_NEAR(witness_->views[1].time_s - witness_->views[0].time_s, kStep_s, kTolerance_s);
}

TEST_F(LiveOperatorTest, RecordsUnansweredTicks) {
  live_->begin(0.0);
  take(kServer_s);
  for (int i = 1; i <= 100; ++i) ASSERT_TRUE(live_->take_unseen(tick(kServer_s + 0.001 * i)));
  take(kServer_s + 0.101);
  ASSERT_EQ(witness_->views.size(), 2u);
  EXPECT_NEAR(witness_->views[1].time_s, 0.002, kTolerance_s);
  EXPECT_NEAR(live_->unseen_s(), 0.1, kTolerance_s);
  EXPECT_EQ(recorded().samples.size(), 102u);
}

TEST_F(LiveOperatorTest, FiresOnTheNextTickAndEndsWithTheOperator) {
  witness_->fires_at = 2;
  witness_->done_at = 4;
  live_->begin(0.0);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(take(kServer_s + 0.001 * i));
  EXPECT_FALSE(take(kServer_s + 0.003));
  const storage::Session session = recorded();
  EXPECT_EQ(session.shots, std::vector<std::size_t>{2});
  EXPECT_EQ(session.samples.size(), 4u);
}

TEST_F(LiveOperatorTest, RecordsTheTransducerInTheSessionsTime) {
  constexpr double kProbesClock_s = -700.0, kNeedlesClock_s = 300.0;
  const auto probe_ticks = [&](double from_s, int count) {
    std::vector<link::NumberedSample> ticks;
    for (int i = 0; i < count; ++i) {
      telemetry::TickSample sample = tick(kServer_s - kNeedlesClock_s + kProbesClock_s + from_s + 0.001 * i);
      sample.axis = Vec3::UnitY();
      sample.tip_mm = sample.device_mm = {sample.time_s, 0.0, 0.0};
      sample.f_constraint_n = {0.0, -3.0, 0.0};
      ticks.push_back({static_cast<std::uint64_t>(i), sample});
    }
    return ticks;
  };
  live_->begin(kNeedlesClock_s);
  ASSERT_TRUE(live_->note_transducer(probe_ticks(-0.1, 50), kProbesClock_s));  // there is no session yet
  take(kServer_s);
  take(kServer_s + 0.001);
  ASSERT_TRUE(live_->note_transducer(probe_ticks(-0.05, 300), kProbesClock_s));
  const storage::Session session = recorded();
  ASSERT_EQ(session.samples.size(), 2u);
  ASSERT_GE(session.transducer.size(), 23u);  // of the 250 ms in it, at most 100 a second
  ASSERT_LE(session.transducer.size(), 25u);
  EXPECT_NEAR(session.transducer.front().time_s, 0.0, 0.0011);
  EXPECT_NEAR(session.transducer.back().time_s, 0.25, 0.0121);
  for (const storage::TransducerSample& moment : session.transducer) {
    EXPECT_NEAR(moment.X_PT.p().x(), kServer_s - kNeedlesClock_s + kProbesClock_s + moment.time_s, kTolerance_s);
    EXPECT_EQ(moment.contact_n, 3.0);
  }
}

}  // namespace
}  // namespace trocar::attempt
