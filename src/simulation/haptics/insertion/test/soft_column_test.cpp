// The tissue below a layer that gives way: docs/physics.md P6.
#include <gtest/gtest.h>

#include <numeric>

#include "haptics/insertion/insertion_path.h"
#include "haptics/test/layered_patient.h"
#include "telemetry/tick_sample.h"

namespace trocar::testing {
namespace {

constexpr double kRadius_mm = 2.6;

haptics::SoftColumn column_on_skin(const std::vector<Slab>& slabs) {
  return haptics::soft_column(*make_scene(slabs), Vec3::Zero(), Vec3::UnitZ(), kRadius_mm);
}

double length_mm(const haptics::SoftColumn& column) {
  return std::accumulate(column.thickness_mm.begin(), column.thickness_mm.begin() + column.cells, 0.0);
}

TEST(SoftColumn, MatchesARigidPunchForASmallLoad) {
  const haptics::SoftColumn column = column_on_skin({{0, kFat}});
  constexpr double kPlane_n_per_mm2 = 0.01 / 0.75;  // 10 kPa, the table's default
  constexpr double kForce_n = 1e-5;
  // 2 A E*: the closed form; 40 mm of tissue carry all but a few percent of it.
  EXPECT_NEAR(kForce_n / column.depression_mm(kForce_n), 2.0 * kRadius_mm * kPlane_n_per_mm2, 0.06 * 0.07);
}

TEST(SoftColumn, NeverCompressesBeyondItsLength) {
  const haptics::SoftColumn column = column_on_skin(liver_way());
  EXPECT_EQ(column.depression_mm(0.0), 0.0);
  EXPECT_EQ(column.depression_mm(-1.0), 0.0);
  double before_mm = 0.0;
  double slope = std::numeric_limits<double>::infinity();
  for (double force_n = 0.1; force_n < 50.0; force_n += 0.1) {
    const double now_mm = column.depression_mm(force_n);
    EXPECT_GT(now_mm, before_mm);
    EXPECT_LT(now_mm - before_mm, slope);  // stiffens
    slope = now_mm - before_mm;
    before_mm = now_mm;
  }
  EXPECT_LT(column.depression_mm(1e9), length_mm(column));
}

TEST(SoftColumn, EndsAtBoneAndAtFluid) {
  EXPECT_EQ(length_mm(column_on_skin({{0, kFat}})), haptics::kColumn_mm);
  anatomy::TissueTable tissues = paper_tissues();
  for (const auto& [name, young_kpa] : {std::pair{"bone", 1e6}, std::pair{"bone", 0.0}}) {
    tissues.tissues[*tissues.find_tissue(name)].young_kpa = young_kpa;
    const auto scene = make_scene({{0, kFat}, {12, kBone}}, haptics::HapticOptions{}, tissues);
    EXPECT_EQ(length_mm(haptics::soft_column(*scene, Vec3::Zero(), Vec3::UnitZ(), kRadius_mm)), 12.0) << young_kpa;
  }
}

TEST(SoftColumn, IgnoresLabelsOfTissueWithoutAWall) {
  const std::vector<Slab> slabs{{0, kFat}, {12, kMuscle}, {24, kFat}};
  for (const haptics::ForceModel model : {haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    const auto column_of = [&](const std::shared_ptr<const haptics::HapticScene>& scene) {
      return haptics::soft_column(*scene, Vec3::Zero(), Vec3::UnitZ(), kRadius_mm);
    };
    const haptics::SoftColumn labelled = column_of(make_scene(slabs, model));
    const haptics::SoftColumn unlabelled = column_of(make_unlabelled_scene(slabs, model));
    EXPECT_GT(labelled.depression_mm(2.0), 0.5);
    EXPECT_EQ(labelled.depression_mm(2.0), unlabelled.depression_mm(2.0));
    EXPECT_NE(labelled.depression_mm(2.0), column_on_skin(slabs).depression_mm(2.0));  // insertion: from the labels
  }
}

anatomy::TissueTable yielding_tissues() {
  anatomy::TissueTable table = paper_tissues();
  table.layers[0].load_spread_mm = table.layers[1].load_spread_mm = 2.0;
  for (anatomy::TissueParams& tissue : table.tissues) tissue.roughness_n = 0.0;
  return table;
}

/// Displacement of the device at the first puncture.
double puncture_at_mm(const anatomy::TissueTable& table, double rate_hz = 1000.0) {
  Driver driver(make_scene(liver_way(), haptics::HapticOptions{}, table), rate_hz);
  for (const telemetry::TickSample& sample : driver.move(40.0, 5.0))
    if (sample.events[0].kind == telemetry::EventKind::kPuncture) return sample.device_mm.z();
  return 0.0;
}

TEST(YieldingWall, AddsTravelButNotPeakForce) {
  const anatomy::TissueTable table = yielding_tissues();
  const auto scene = make_scene(liver_way(), haptics::HapticOptions{}, table);
  const haptics::SoftColumn column = haptics::soft_column(*scene, Vec3::Zero(), Vec3::UnitZ(), 0.635 + 2.0);
  EXPECT_NEAR(puncture_at_mm(table) - puncture_at_mm(paper_tissues()), column.depression_mm(2.8), 0.05);
  EXPECT_NEAR(puncture_at_mm(table, 4000.0), puncture_at_mm(table), 0.05);
  Driver driver(scene);
  for (const telemetry::TickSample& sample : driver.move(60.0, 5.0)) {
    if (sample.events[0].kind != telemetry::EventKind::kPuncture) continue;
    const double peaks_n[] = {2.8, 2.5, 1.5};
    EXPECT_NEAR(-sample.f_prepuncture_n, peaks_n[sample.events[0].id], 0.001);
  }
}

TEST(YieldingWall, NeverReturnsMoreWorkThanStored) {
  Driver driver(make_scene(liver_way(), haptics::HapticOptions{}, yielding_tissues()));
  driver.move(0.0, 10.0);
  double work_mj = 0.0;
  double before_mm = 0.0;
  double before_n = 0.0;
  const auto add = [&](const std::vector<telemetry::TickSample>& samples) {
    for (const telemetry::TickSample& sample : samples) {
      const double force_n = resistance_n(sample);
      work_mj += 0.5 * (force_n + before_n) * (sample.device_mm.z() - before_mm);
      before_mm = sample.device_mm.z();
      before_n = force_n;
    }
  };
  for (const double speed_mm_per_s : {1.0, 10.0, 50.0}) {
    work_mj = 0.0;
    add(driver.move(10.0, speed_mm_per_s));
    EXPECT_GT(work_mj, 1.0);
    add(driver.move(0.0, speed_mm_per_s));
    EXPECT_GT(work_mj, 0.0) << speed_mm_per_s;
  }
}

TEST(YieldingWall, FollowsAWithdrawnNeedleAtAnySpeed) {
  for (const double speed_mm_per_s : {20.0, 100.0, 400.0}) {
    // Pressed in without a puncture, and back.
    Driver driver(make_scene(liver_way(), haptics::HapticOptions{}, yielding_tissues()));
    driver.move(12.0, 20.0);
    double before_n = resistance_n(driver.hold(0.1).back());
    EXPECT_GT(before_n, 0.5);
    for (const telemetry::TickSample& sample : driver.move(-5.0, speed_mm_per_s)) {
      ASSERT_LE(resistance_n(sample), before_n + 1e-6);
      before_n = resistance_n(sample);
    }
    EXPECT_EQ(driver.state().needle.insertion.yielded_mm, 0.0);
    // Out of the body while the wall still recoils from the puncture.
    driver.move(19.0, 20.0);
    EXPECT_TRUE(driver.state().needle.path.is_open);
    EXPECT_GT(driver.state().needle.insertion.yielded_mm, 3.0);
    const auto out = driver.move(-5.0, speed_mm_per_s);
    EXPECT_TRUE(punctures(out).empty());
    for (const telemetry::TickSample& sample : out) {
      ASSERT_LT(resistance_n(sample), resistance_n(out.front()) + 0.05);
      if (sample.phase == telemetry::InsertionPhase::kOutside) {
        ASSERT_NEAR(resistance_n(sample), 0.0, 1e-6) << sample.device_mm.z();
      }
    }
  }
}

TEST(YieldingWall, PiercesNothingMoreAtRest) {
  anatomy::TissueTable table = yielding_tissues();
  table.layers[1].load_spread_mm = 0.0;
  for (const double muscle_mm : {3.0, 5.0, 12.0}) {
    Driver driver(
        make_scene({{0, kFat}, {muscle_mm, kMuscle}, {muscle_mm + 4.0, kLiver}}, haptics::HapticOptions{}, table));
    std::vector<telemetry::TickSample> samples;
    double depth_mm = -1.0;
    while (punctures(samples).empty() && depth_mm < 40.0) samples = {driver.to({0, 0, depth_mm += 0.01})};
    ASSERT_GT(driver.state().needle.insertion.recoil_mm, 3.0);
    EXPECT_TRUE(punctures(driver.hold(2.0)).empty()) << muscle_mm;
    EXPECT_LT(driver.state().needle.insertion.recoil_mm, 10.0);
  }
}

TEST(YieldingWall, HoldsItsDepressionUnderLoadAfterAPuncture) {
  // Against bone right under the skin the wall recoils only as far as the load permits.
  anatomy::TissueTable table = yielding_tissues();
  Driver driver(make_scene({{0, kFat}, {9, kBone}}, haptics::HapticOptions{}, table));
  driver.move(22.0, 20.0);
  const double load_n = resistance_n(driver.hold(3.0).back());
  ASSERT_GT(load_n, 1.0);
  const haptics::InsertionState& state = driver.state().needle.insertion;
  EXPECT_LE(state.recoil_mm, state.below.depression_mm(load_n) + 0.05);
  const double held_mm = state.recoil_mm;
  EXPECT_GT(held_mm, 1.0);
  driver.hold(2.0);
  EXPECT_NEAR(state.recoil_mm, held_mm, 0.01);
  driver.move(5.0, 20.0);  // without the load it recoils
  driver.hold(4.0);
  EXPECT_LT(state.recoil_mm, 0.05 * held_mm);  // friction still holds a little
}

/// A server that is prepared again places the needle where it was, and the hand comes back to where it was (S1).
TEST(YieldingWall, DoesNotPushAReplacedNeedle) {
  for (const haptics::ForceModel model :
       {haptics::ForceModel::kInsertion, haptics::ForceModel::kCombined, haptics::ForceModel::kProxy}) {
    SCOPED_TRACE(static_cast<int>(model));
    haptics::HapticOptions options;
    options.force_model = model;
    const auto scene = make_scene({{0, kMuscle}}, options, yielding_tissues());
    constexpr double kDevice_mm = 40.0;
    Driver driver(scene);
    driver.move(kDevice_mm, 20.0);
    const telemetry::TickSample rest = driver.hold(2.0).back();
    const telemetry::NeedlePlace place = telemetry::needle_place(rest);
    ASSERT_GT(place.pressed_mm, 0.2);
    driver.state() = {};
    driver.state().needle.pressed_mm = place.pressed_mm;
    driver.jump_to(place.X_PN.p().z());
    const std::vector<telemetry::TickSample> placed = driver.hold(1.0);
    for (const telemetry::TickSample& sample : placed) ASSERT_NEAR(resistance_n(sample), 0.0, 1e-6);
    const std::vector<telemetry::TickSample> back = driver.move(kDevice_mm, 20.0);
    const std::vector<telemetry::TickSample> after = driver.hold(2.0);
    EXPECT_TRUE(punctures(back).empty() && punctures(after).empty());
    EXPECT_NEAR(after.back().tip_mm.z(), rest.tip_mm.z(), 0.4 * place.pressed_mm);  // at slow speeds it creeps
  }
}

TEST(YieldingWall, GeneratesNoEnergyOverRepeatedPunctures) {
  for (const double speed_mm_per_s : {2.0, 20.0, 100.0}) {
    Driver driver(make_scene({{0, kMuscle}}, haptics::HapticOptions{}, yielding_tissues()));
    driver.state().needle.pressed_mm = 6.0;
    double work_mj = 0.0, most_mj = 0.0, before_mm = 20.0, before_n = 0.0;
    driver.jump_to(before_mm);
    for (const double to_mm : {26.0, 20.0, 30.0, 20.0}) {
      for (const telemetry::TickSample& sample : driver.move(to_mm, speed_mm_per_s)) {
        work_mj -= 0.5 * (resistance_n(sample) + before_n) * (sample.device_mm.z() - before_mm);
        most_mj = std::max(most_mj, work_mj);
        before_mm = sample.device_mm.z();
        before_n = resistance_n(sample);
      }
    }
    EXPECT_LT(most_mj, 0.1) << speed_mm_per_s;
    EXPECT_LT(work_mj, -0.5) << speed_mm_per_s;  // friction
  }
}

TEST(YieldingWall, IsAtLeastAsStiffAsPressedFat) {
  const auto scene = make_scene({{0, kFat}});
  constexpr double kForce_n = 1e-5;
  const auto slope = [&](double least_kpa) {
    return kForce_n /
           haptics::soft_column(*scene, Vec3::Zero(), Vec3::UnitZ(), kRadius_mm, least_kpa).depression_mm(kForce_n);
  };
  EXPECT_NEAR(slope(26.1) / slope(0.0), 2.61, 1e-3);  // the table's 10 kPa
  EXPECT_NEAR(slope(5.0), slope(0.0), 1e-9);
}

/// The flat patient with a fold of skin on it: 6 mm thick across x, 12 mm high, fat inside.
std::shared_ptr<anatomy::VirtualPatient> folded_patient() {
  auto patient = layered_patient({{0, kFat}});
  for (std::size_t n = 0; n < patient->labels.voxels.size(); ++n) {
    const Vec3 p_P = patient->labels.geometry.centre_mm(patient->labels.geometry.index_of(n));
    const double beside_mm = std::max(std::abs(p_P.x()) - 3.0, -12.0 - p_P.z());  // of the fold's box
    float& distance = patient->skin_distance_mm.voxels[n];
    distance = std::min(distance, static_cast<float>(beside_mm));
    if (distance < 0.0F) {
      patient->labels.voxels[n] = kFat;
      patient->ct.voxels[n] = kHuOfLabel[kFat];
    }
  }
  return patient;
}

TEST(SoftWall, KeepsContactOnUnevenSkin) {
  // The needle presses on the side of the fold and moves on behind its other side: the skin that it presses stays that
  // of the near side until it gives way.
  anatomy::TissueTable tissues = paper_tissues();
  tissues.layers[0].load_spread_mm = 2.0;
  auto made = haptics::make_haptic_scene(folded_patient(), tissues, {}, {}, {});
  ASSERT_TRUE(made) << made.error().text();
  Driver driver(*made);
  double before_n = 0.0, furthest_mm = -10.0;
  bool has_punctured = false, has_pressed = false;
  for (double x_mm = -10.0; x_mm < 20.0 && !has_punctured; x_mm += 0.01) {
    const telemetry::TickSample sample = driver.to({x_mm, 0.0, -6.0}, Vec3::UnitX());
    const double force_n = -(sample.device_f_n - sample.f_weight_n).x();
    has_punctured = sample.events[0].kind == telemetry::EventKind::kPuncture;
    ASSERT_GT(force_n, before_n - 0.05) << "at " << x_mm;  // the damper of the coupling at the first touch
    ASSERT_LT(force_n, before_n + 0.1) << "at " << x_mm;
    before_n = force_n;
    furthest_mm = x_mm;
    has_pressed = has_pressed || sample.phase == telemetry::InsertionPhase::kLoading;
    ASSERT_EQ(sample.phase == telemetry::InsertionPhase::kOutside, !has_pressed) << "at " << x_mm;
  }
  EXPECT_TRUE(has_punctured);
  EXPECT_GT(furthest_mm, 3.0) << "the device is behind the fold when its skin gives way";
  EXPECT_NEAR(before_n, 2.8, 0.01);
}

}  // namespace
}  // namespace trocar::testing
