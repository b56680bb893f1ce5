#include "phantom/biopsy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "anatomy/testing/shipped_structures.h"
#include "core/files/folders.h"
#include "phantom/render.h"
#include "volume/sampling.h"

namespace trocar::phantom {
namespace {

using trocar::testing::shipped_structures;

AbdomenData shipped_abdomen() {
  return load_abdomen_data(data_dir() / kAbdomenFile).value();
}

/// Voxels of 1 mm around a path.
volume::GridGeometry box_around(const Segment& line, double margin_mm) {
  volume::GridGeometry geometry;
  const Vec3 low = line.a.cwiseMin(line.b) - Vec3::Constant(margin_mm);
  const Vec3 high = line.a.cwiseMax(line.b) + Vec3::Constant(margin_mm);
  geometry.origin_P = low;
  for (int a = 0; a < 3; ++a) geometry.size[static_cast<std::size_t>(a)] = std::lround(high[a] - low[a]) + 1;
  return geometry;
}

/// A planned biopsy and the voxels around its path.
struct Case {
  explicit Case(std::uint64_t seed) : anatomy(seed, shipped_abdomen(), shipped_structures()) {
    if (auto built = build_abdomen(anatomy)) {
      plan = *std::move(built);
      rendering = render(anatomy, box_around(plan->path.line_P, 14.0));
    }
  }

  Anatomy anatomy;
  std::optional<BiopsyPlan> plan;
  Rendering rendering;
};

/// One case a seed for all tests.
const Case& case_of(std::uint64_t seed) {
  static std::map<std::uint64_t, std::unique_ptr<Case>> cases;
  auto& found = cases[seed];
  if (!found) found = std::make_unique<Case>(seed);
  return *found;
}

class ExpertPath : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(case_.plan);
    line_ = case_.plan->path.line_P;
  }

  std::string tissue_at(const Vec3& p) const {
    const anatomy::Label* label =
        anatomy_.label_table.find(volume::sample_nearest(rendering_.labels, p, std::uint8_t{0}));
    return label == nullptr ? "outside" : label->tissue;
  }

  /// Least distance of the path from the voxel centres of some tissues.
  double clearance_mm(const std::set<std::string>& tissues) const {
    volume::MaskGrid mask(rendering_.labels.geometry);
    for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
      const anatomy::Label* label = anatomy_.label_table.find(rendering_.labels.voxels[n]);
      mask.voxels[n] = label != nullptr && tissues.contains(label->tissue);
    }
    double least = 1e9;
    for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
      if (mask.voxels[n] == 0) continue;
      const volume::Index3 at = mask.geometry.index_of(n);
      const Vec3 p = mask.geometry.centre_mm(at);
      least = std::min(least, distance_mm(line_, p));
    }
    return least;
  }

  const Case& case_ = case_of(GetParam());
  const Anatomy& anatomy_ = case_.anatomy;
  const Rendering& rendering_ = case_.rendering;
  Segment line_;
};

TEST_P(ExpertPath, PassesFatMuscleAndLiverIntoTheLesion) {
  std::vector<std::string> order;
  double liver_mm = 0.0;
  constexpr double kStepMm = 0.25;
  for (double along = 1.0; along <= line_.length_mm(); along += kStepMm) {
    const std::string tissue = tissue_at(line_.a + along * line_.direction());
    if (std::find(order.begin(), order.end(), tissue) == order.end()) order.push_back(tissue);
    if (tissue == "liver") liver_mm += kStepMm;
  }
  EXPECT_EQ(order, (std::vector<std::string>{"adipose", "muscle", "liver", "liver_lesion"}));
  EXPECT_GE(liver_mm, 10.0);
}

TEST_P(ExpertPath, BeginsOnTheSkin) {
  EXPECT_NEAR(anatomy_.torso.at(line_.a.cast<float>()).skin, 0.0F, 0.01F);
}

TEST_P(ExpertPath, KeepsItsMargins) {
  EXPECT_GT(clearance_mm({"bone", "cartilage"}), 3.0);
  EXPECT_GT(clearance_mm({"vessel", "lung", "bowel", "gallbladder", "kidney", "gas"}), 5.0);
}

TEST_P(ExpertPath, PassesBetweenTwoRibs) {
  // Where the path crosses the chest wall, there is bone above and below, within an intercostal space.
  Vec3 crossing = line_.a;
  while (anatomy_.torso.at(crossing.cast<float>()).cavity > 6.0F) crossing += 0.5 * line_.direction();
  const auto meets_rib = [&](double upwards) {
    for (double mm = 0.0; mm < 40.0; mm += 0.5) {
      Vec3f p = crossing.cast<float>() + Vec3f(0.0F, 0.0F, static_cast<float>(upwards * mm));
      // Along the wall, which leans.
      for (int n = 0; n < 3; ++n) p.x() += anatomy_.torso.at(p).cavity - 6.0F;
      if (anatomy_.find("rib_cage").distance(anatomy_.torso.at(p)) < 0.0F) return true;
    }
    return false;
  };
  EXPECT_TRUE(meets_rib(1.0));
  EXPECT_TRUE(meets_rib(-1.0));
}

INSTANTIATE_TEST_SUITE_P(Seeds, ExpertPath, ::testing::Values(1, 2, 3, 4, 5));

TEST(Rendering, IsUnchangedByCulling) {
  Anatomy anatomy(3, shipped_abdomen(), shipped_structures());
  ASSERT_TRUE(build_abdomen(anatomy));
  // A slab through liver, stomach and spine, and one through bowel and pelvis, with ordinary voxels.
  for (const double z : {20.0, -70.0}) {
    volume::GridGeometry geometry;
    geometry.size = {120, 96, 6};
    geometry.spacing_mm = Vec3(2.9, 2.9, 1.0);
    geometry.origin_P = Vec3(-172.0, -138.0, z);
    const Rendering near = render(anatomy, geometry, {}, Culling::kNear);
    const Rendering every = render(anatomy, geometry, {}, Culling::kEvery);
    EXPECT_EQ(near.labels.voxels, every.labels.voxels);
    EXPECT_EQ(near.ct.voxels, every.ct.voxels);
  }
}

}  // namespace
}  // namespace trocar::phantom
