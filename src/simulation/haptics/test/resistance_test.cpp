// What the hand must and must not feel along a whole path, in every force model.
#include <gtest/gtest.h>

#include <cmath>

#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

constexpr haptics::ForceModel kModels[] = {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy,
                                           haptics::ForceModel::kCombined};

anatomy::TissueTable smooth_tissues() {
  anatomy::TissueTable table = paper_tissues();
  for (anatomy::TissueParams& tissue : table.tissues) tissue.roughness_n = 0.0;
  return table;
}

TEST(Resistance, DoesNotDropBeforeALayerBehindCutTissue) {
  // A tissue with 1 N of cutting in front of the capsule, as the ligament in front of the ligamentum flavum.
  anatomy::TissueTable tissues = smooth_tissues();
  tissues.tissues[*tissues.find_tissue("muscle")].cutting_n = 1.0;
  tissues.tissues[*tissues.find_tissue("muscle")].layer.reset();
  for (const haptics::ForceModel model : kModels) {
    Driver driver(make_scene(liver_way(), model, tissues));
    const auto samples = driver.move(60.0, 5.0);
    double highest_n = 0.0;
    bool has_punctured = false;
    for (const telemetry::TickSample& sample : samples) {
      if (sample.depth_mm < 17.0) continue;  // behind the border of the CT
      has_punctured = has_punctured || sample.events[0].kind == telemetry::EventKind::kPuncture;
      if (has_punctured) break;
      ASSERT_GT(resistance_n(sample), highest_n - 0.03) << to_string(model) << " at " << sample.depth_mm;
      highest_n = std::max(highest_n, resistance_n(sample));
    }
    EXPECT_TRUE(has_punctured) << to_string(model);
    EXPECT_GT(highest_n, 1.4) << to_string(model);
  }
}

TEST(Resistance, OfASteadyNeedleIsIndependentOfTheTickRate) {
  for (const haptics::ForceModel model : kModels) {
    std::vector<double> steady_n;
    for (const double rate_hz : {1000.0, 2000.0, 4000.0}) {
      Driver driver(make_scene(liver_way(), model, smooth_tissues()), rate_hz);
      steady_n.push_back(resistance_n(driver.move(55.0, 5.0).back()));
    }
    EXPECT_GT(steady_n[0], 0.6) << to_string(model);
    EXPECT_NEAR(steady_n[1], steady_n[0], 1e-3) << to_string(model);
    EXPECT_NEAR(steady_n[2], steady_n[0], 1e-3) << to_string(model);
  }
}

TEST(Resistance, DissipatesEnergyAtEveryDepth) {
  for (const haptics::ForceModel model : kModels) {
    Driver driver(make_scene(liver_way(), model, smooth_tissues()));
    driver.move(-1.0, 10.0);
    double work_mj = 0.0;
    double most_mj = 0.0;
    double before_mm = -1.0;
    double before_n = 0.0;
    const auto go = [&](double to_mm) {
      for (const telemetry::TickSample& sample : driver.move(to_mm, 2.0)) {
        work_mj += 0.5 * (resistance_n(sample) + before_n) * (sample.device_mm.z() - before_mm);
        before_n = resistance_n(sample);
        before_mm = sample.device_mm.z();
        most_mj = std::max(most_mj, work_mj);
        // Tissue and coupling return no more than they can store: springs of at least 0.5 N/mm under 3.5 N.
        ASSERT_GT(work_mj, most_mj - 0.5 * 3.5 * 3.5 / 0.5) << to_string(model);
      }
    };
    for (double depth_mm = 3.0; depth_mm < 56.0; depth_mm += 4.0) {
      go(depth_mm);
      go(depth_mm - 3.0);
      const double before_cycle_mj = work_mj;
      go(depth_mm);
      go(depth_mm - 3.0);
      ASSERT_GT(work_mj, before_cycle_mj - 1e-6) << to_string(model) << " at " << depth_mm;
    }
    go(-2.0);
    EXPECT_GT(work_mj, 5.0) << to_string(model);
  }
}

TEST(Resistance, OfTheCombinedModelIgnoresLabelsShownByTheCt) {
  auto partly = layered_patient(liver_way());
  for (std::uint8_t& label : partly->labels.voxels)
    if (label != kLiver) label = 0;
  haptics::HapticOptions options;
  options.force_model = haptics::ForceModel::kCombined;
  const auto scene = haptics::make_haptic_scene(partly, smooth_tissues(), {}, {}, options);
  ASSERT_TRUE(scene.has_value());
  Driver full(make_scene(liver_way(), options, smooth_tissues()));
  Driver part(*scene);
  const auto a = full.move(60.0, 10.0);
  const auto b = part.move(60.0, 10.0);
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) square += std::pow(resistance_n(a[i]) - resistance_n(b[i]), 2);
  EXPECT_LT(std::sqrt(square / static_cast<double>(a.size())), 0.01);
}

}  // namespace
}  // namespace trocar::testing
