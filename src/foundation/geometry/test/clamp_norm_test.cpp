#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "geometry/vec.h"

namespace trocar {
inline namespace geometry {
namespace {

TEST(ClampNorm, KeepsShortVectorsBitwise) {
  const Vec3 v(0.1, -0.2, 0.3);
  Vec3 kept = v;
  EXPECT_FALSE(clamp_norm(kept, v.norm()));
  EXPECT_EQ(kept, v);
  EXPECT_EQ(clamped_norm(v, 1.0), v);
  EXPECT_EQ(clamped_norm(Vec3::Zero(), 0.0), Vec3(Vec3::Zero()));
}

TEST(ClampNorm, ShortensLongVectorsAlongTheirDirection) {
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 v = 100.0 * Vec3(random.normal(), random.normal(), random.normal());
    const double most = random.uniform(0.0, v.norm());
    Vec3 clamped = v;
    EXPECT_TRUE(clamp_norm(clamped, most));
    EXPECT_EQ(clamped, Vec3(v * (most / v.norm())));
    EXPECT_EQ(clamped_norm(v, most), clamped);
    EXPECT_NEAR(clamped.norm(), most, 4.0 * std::numeric_limits<double>::epsilon() * most);  // roundings of 3 products
  }
}

TEST(ClampNorm, LeavesVectorsWithNaN) {
  Vec3 v(std::nan(""), 1.0, 2.0);
  EXPECT_FALSE(clamp_norm(v, 1.0));
  EXPECT_TRUE(std::isnan(v.x()));
  EXPECT_EQ(v.tail<2>(), Vec3(0.0, 1.0, 2.0).tail<2>());
}

}  // namespace
}  // namespace geometry
}  // namespace trocar
