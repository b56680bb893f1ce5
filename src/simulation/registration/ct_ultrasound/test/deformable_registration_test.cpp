#include "registration/ct_ultrasound/deformable_registration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "lab/registration/generated_pair.h"
#include "registration/ct_ultrasound/detail/sampled_information.h"

namespace trocar::registration {
namespace {

/// Up to 4 mm, bending over some 60 mm.
Vec3 smooth_warp(const Vec3& p) {
  return {3.0 * std::sin(p.y() / 25.0), 2.5 * std::cos(p.z() / 28.0), 3.0 * std::sin(p.x() / 26.0 + 0.5)};
}

struct Residual {
  double before_mm = 0.0, after_mm = 0.0;
};

/// Mean distance of displaced points from where the warp took them, over the usable voxels.
Residual residual_of(const testing::GeneratedPair& pair, const Beams& beams, const DeformableRegistration& found,
                     bool is_warped) {
  const volume::MaskGrid usable = *usable_voxels(pair.us, beams);
  Residual sum;
  double count = 0.0;
  for (std::size_t n = 0; n < usable.voxels.size(); n += 37) {
    if (usable.voxels[n] == 0) continue;
    const Vec3 p = usable.geometry.centre_mm(usable.geometry.index_of(n));
    const Vec3 right = is_warped ? smooth_warp(p) : Vec3(Vec3::Zero());
    sum.before_mm += right.norm();
    sum.after_mm += (volume::displacement_at(found.field_U, p) - right).norm();
    count += 1.0;
  }
  return {sum.before_mm / count, sum.after_mm / count};
}

testing::GeneratedPair make(bool is_warped) {
  testing::PairOptions options;
  options.seed = 4;
  options.has_bone = false;
  if (is_warped) options.warp = smooth_warp;
  return testing::make_pair(options);
}

TEST(DeformableRegistration, RecoversMostOfASmoothWarp) {
  const testing::GeneratedPair pair = make(true);
  const Beams beams = *Beams::along_axis("+y", pair.us.geometry);
  const auto found = register_deformable(pair.ct, pair.us, beams, Pose(), {});
  ASSERT_TRUE(found) << found.error().text();
  const Residual residual = residual_of(pair, beams, *found, true);
  EXPECT_GT(residual.before_mm, 3.0);
  EXPECT_LT(residual.after_mm, 0.5 * residual.before_mm);
  EXPECT_GT(found->least_jacobian, 0.0);
  EXPECT_GT(found->metric, found->metric_before);
}

TEST(DeformableRegistration, LeavesARigidPairAlmostRigid) {
  const testing::GeneratedPair pair = make(false);
  const Beams beams = *Beams::along_axis("+y", pair.us.geometry);
  const auto found = register_deformable(pair.ct, pair.us, beams, Pose(), {});
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_LT(residual_of(pair, beams, *found, false).after_mm, 0.7);  // a third of a voxel
  EXPECT_GT(found->least_jacobian, 0.7);
}

TEST(DeformableRegistration, EndsWhenCancelled) {
  const testing::GeneratedPair pair = make(false);
  DeformableOptions options;
  options.is_cancelled = [] { return true; };
  const auto found = register_deformable(pair.ct, pair.us, *Beams::along_axis("+y", pair.us.geometry), Pose(), options);
  ASSERT_FALSE(found);
}

TEST(SampledInformation, SlopesAreTheDerivatives) {
  Random random(5);
  std::vector<float> us;
  std::vector<double> ct;
  for (int n = 0; n < 400; ++n) {
    const double value = random.uniform(-2.5, 2.5);
    us.push_back(static_cast<float>(value + 0.5 * random.normal()));
    ct.push_back(value * value - 2.0);
  }
  detail::SampledInformation information(us);
  std::vector<double> slopes, ignored;
  EXPECT_GT(information.evaluate(ct, slopes), 0.3);
  constexpr double kStep = 1e-5;
  for (std::size_t n = 0; n < ct.size(); n += 23) {
    if (std::abs(ct[n]) > 2.9) continue;
    std::vector<double> up = ct, down = ct;
    up[n] += kStep;
    down[n] -= kStep;
    const double numeric = (information.evaluate(up, ignored) - information.evaluate(down, ignored)) / (2.0 * kStep);
    EXPECT_NEAR(slopes[n], numeric, 1e-6);
  }
}

}  // namespace
}  // namespace trocar::registration
