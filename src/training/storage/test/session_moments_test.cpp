#include "storage/session_moments.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "metrics/measure_run.h"
#include "metrics/pose_csv.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

using namespace testing;

std::vector<metrics::Moment> moments_of(const Session& session) {
  std::vector<metrics::Moment> all;
  walk_moments(session, [&](const metrics::Moment& moment) { all.push_back(moment); });
  return all;
}

Session session_of(std::size_t ticks) {
  Session session;
  session.info = example_info();
  for (std::size_t n = 0; n < ticks; ++n) session.samples.push_back(example_sample(n));
  return session;
}

TEST(SessionMoments, HasNeedleForcesAndEventsOfEveryTick) {
  const Session session = session_of(100);
  const auto all = moments_of(session);
  ASSERT_EQ(all.size(), 100u);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const telemetry::TickSample& sample = session.samples[n];
    EXPECT_EQ(all[n].time_s, sample.time_s);
    EXPECT_EQ(all[n].tip_P, sample.tip_mm);
    EXPECT_EQ(all[n].axis_P, sample.axis);
    EXPECT_EQ(*all[n].depth_mm, sample.depth_mm);
    EXPECT_EQ(*all[n].resistance_n, telemetry::axial_resistance_n(sample));
    EXPECT_EQ((*all[n].events)[0].kind, sample.events[0].kind);
    EXPECT_FALSE(all[n].X_PT || all[n].xray || all[n].is_paused);
  }
}

TEST(SessionMoments, UseTheNewestTransducerAndXraySample) {
  Session session = session_of(100);
  session.transducer = {{0.0105, Pose::translation({1, 0, 0}), 0.5}, {0.0500, Pose::translation({2, 0, 0}), 0.7}};
  tasks::XrayUse use;
  use.time_s = 0.020;
  use.beam_s = 3.0;
  session.xray = {use};
  const auto all = moments_of(session);
  EXPECT_FALSE(all[10].X_PT);
  EXPECT_EQ(all[11].X_PT->p().x(), 1.0);
  EXPECT_EQ(all[49].X_PT->p().x(), 1.0);
  EXPECT_EQ(all[50].X_PT->p().x(), 2.0);
  EXPECT_EQ(*all[99].contact_n, 0.7);
  EXPECT_FALSE(all[19].xray);
  EXPECT_EQ(all[20].xray->beam_s, 3.0);
}

TEST(SessionMoments, MarkTheTickAfterAnInterruptionOrDamage) {
  Session session = session_of(60);
  for (std::size_t n = 30; n < 60; ++n) session.samples[n].time_s += 5.0;
  session.interruptions = {{0.0295, session.samples[30].time_s, "test"}};
  session.damage = {{"the score", 0, 0, 10}, {"ticks 50 to 54", 50, 5, 50}};
  const auto all = moments_of(session);
  for (std::size_t n = 0; n < all.size(); ++n) EXPECT_EQ(all[n].is_paused, n == 30 || n == 50) << n;
}

TEST(SessionMoments, ContextHasPlanLayersAndShot) {
  Session session = session_of(60);
  session.shots = {40};
  const metrics::MetricContext context = context_of(session);
  ASSERT_EQ(context.expert_paths.size(), 1u);
  EXPECT_EQ(context.expert_paths[0].name, "expert");
  EXPECT_EQ(context.layer_names, session.info.layer_names);
  EXPECT_EQ(context.shots_s, std::vector<double>{session.samples[40].time_s});
  EXPECT_FALSE(context.end_s);
  session.shots = {60};
  session.info.plan_P.line_P.b = session.info.plan_P.line_P.a;
  EXPECT_TRUE(context_of(session).shots_s.empty());
  EXPECT_TRUE(context_of(session).expert_paths.empty());
}

TEST(SessionMoments, EndMatchesTheScore) {
  Session session = session_of(60);
  for (std::size_t n = 0; n < session.samples.size(); ++n) {
    session.samples[n].phase = telemetry::InsertionPhase::kInserted;
    session.samples[n].depth_mm = n < 10 ? 0.0 : n == 20 ? 50.0 : 30.0;
  }
  session.samples[5].phase = telemetry::InsertionPhase::kOutside;
  session.shots = {5, 40};
  EXPECT_EQ(end_s_of(session, nullptr, true), session.samples[40].time_s) << "the first shot was outside the body";
  session.shots.clear();
  EXPECT_FALSE(end_s_of(session, nullptr, true));
  tasks::Task task;
  task.confirmed_by = tasks::Substance::kBile;
  EXPECT_EQ(end_s_of(session, &task, false), session.samples[20].time_s);
  session.actions = {{session.samples[45].time_s, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kBile, 1.0}}};
  EXPECT_EQ(end_s_of(session, &task, false), session.samples[45].time_s);
}

TEST(SessionMoments, ExportKeepsTheMetrics) {
  Session session = session_of(400);
  for (std::size_t n = 0; n < session.samples.size(); ++n)
    session.samples[n].phase = telemetry::InsertionPhase::kInserted;
  TemporaryFolder folder;
  ASSERT_TRUE(export_csv(session, folder / "a.csv"));
  const auto table = metrics::PoseTable::read(folder / "a.csv");
  ASSERT_TRUE(table) << table.error().text();
  metrics::MeasureRun from_session(context_of(session));
  walk_moments(session, [&](const metrics::Moment& moment) { from_session.step(moment); });
  metrics::MetricContext context = context_of(session);
  context.layer_names = table->layer_names();
  metrics::MeasureRun from_csv(std::move(context));
  table->walk([&](const metrics::Moment& moment) { from_csv.step(moment); });
  EXPECT_EQ(from_csv.moments(), 400u);
  const auto wanted = from_session.report(), values = from_csv.report();
  std::size_t compared = 0;
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    EXPECT_EQ(values[n].missing, wanted[n].missing) << wanted[n].name;
    ASSERT_EQ(values[n].value.has_value(), wanted[n].value.has_value()) << wanted[n].name;
    if (!wanted[n].value) continue;
    EXPECT_EQ(*values[n].value, *wanted[n].value) << wanted[n].name;
    ++compared;
  }
  EXPECT_GT(compared, 20u);
}

}  // namespace
}  // namespace trocar::storage
