#include <gtest/gtest.h>

#include "attempt/record/xray_replay.h"
#include "core/files/folders.h"
#include "xray/contrast/test/duct_patient.h"

namespace trocar::attempt {
namespace {

constexpr double kIodine_mg_per_ml = 300.0;
constexpr double kStart_s = 10.0;

/// A closed duct in a liver.
xray::ContrastFlow flow_at_rest() {
  static const auto kPatient = trocar::testing::make_labelled_patient(
      {80, 80, 120}, {2, 2, 2},
      {{"liver", "liver", trocar::testing::everywhere()},
       {"duct", "bile_duct", trocar::testing::tube({0, 0, -40}, {0, 0, 40}, 3.0)}});
  auto table = xray::load_contrast_table(data_dir() / "contrast.toml");
  EXPECT_TRUE(table) << table.error().text();
  auto flow = xray::ContrastFlow::make(kPatient, *table);
  EXPECT_TRUE(flow) << flow.error().text();
  return *std::move(flow);
}

/// Half a second at 1 ml/s into the duct, then half a second into the liver.
std::shared_ptr<const InjectionSteps> two_injections() {
  InjectionSteps made;
  made.start_s = kStart_s;
  for (int n = 0; n < 30; ++n) made.steps.push_back({n < 15 ? Vec3(0, 0, 0) : Vec3(20, 0, 0), 1.0});
  return std::make_shared<const InjectionSteps>(std::move(made));
}

ContrastReplay two_places() {
  return {flow_at_rest(), two_injections(), kIodine_mg_per_ml};
}

TEST(ContrastReplay, InjectsAtTheRecordedPositions) {
  ContrastReplay replay = two_places();
  EXPECT_EQ(replay.at(kStart_s - 0.1), nullptr) << "nothing was injected yet";
  ASSERT_TRUE(replay.at(kStart_s + 0.5));
  EXPECT_NEAR(replay.totals().injected_ml, 0.5, 1e-9);
  EXPECT_NEAR(replay.totals().ducts_mg + replay.totals().drained_mg, 0.5 * kIodine_mg_per_ml, 1e-6);
  EXPECT_EQ(replay.totals().tissue_mg, 0.0);
  replay.at(kStart_s + 30.0);
  EXPECT_NEAR(replay.totals().injected_ml, 1.0, 1e-9) << "nothing more after the last step";
  EXPECT_GT(replay.totals().tissue_mg, 0.0);
}

TEST(ContrastReplay, StateIsIndependentOfSeekHistory) {
  ContrastReplay straight = two_places(), around = two_places();
  for (const double time_s :
       {kStart_s + 0.6, kStart_s + 8.0, kStart_s + 2.0, kStart_s - 5.0, kStart_s + 4.0, kStart_s + 0.3, kStart_s + 4.0})
    around.at(time_s);
  const auto a = straight.at(kStart_s + 4.0), b = around.at(kStart_s + 4.0);
  EXPECT_EQ(straight.totals().ducts_mg, around.totals().ducts_mg);
  EXPECT_EQ(straight.totals().tissue_mg, around.totals().tissue_mg);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->pieces.size(), b->pieces.size());
  ASSERT_FALSE(a->pieces.empty());
  for (std::size_t n = 0; n < a->pieces.size(); ++n)
    EXPECT_EQ(a->pieces[n].iodine_mg_per_ml, b->pieces[n].iodine_mg_per_ml);
}

TEST(ContrastReplay, ThinningCheckpointsKeepsTheStateExact) {
  ContrastReplay replay = two_places();
  replay.at(kStart_s + 300.0);  // more copies than are kept
  replay.at(kStart_s + 20.0);
  ContrastReplay straight = two_places();
  straight.at(kStart_s + 20.0);
  EXPECT_EQ(replay.totals().ducts_mg, straight.totals().ducts_mg);
  EXPECT_EQ(replay.totals().tissue_mg, straight.totals().tissue_mg);
}

TEST(ContrastReplay, AStepHasOneState) {
  ContrastReplay replay = two_places();
  const auto state = replay.at(kStart_s + 3.0 * InjectionSteps::kStep_s);
  EXPECT_EQ(replay.at(kStart_s + 3.9 * InjectionSteps::kStep_s), state);
  EXPECT_NE(replay.at(kStart_s + 4.0 * InjectionSteps::kStep_s), state);
}

}  // namespace
}  // namespace trocar::attempt
