#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "geometry/pose.h"
#include "registration/matching/match.h"
#include "registration/sift3d/descriptor.h"
#include "registration/sift3d/keypoints.h"

namespace trocar::registration {
namespace {

/// Smooth blobs of different widths and brightness in a frame W.
struct Blobs {
  struct Blob {
    Vec3 p_W;
    double sigma_mm, height;
  };
  std::vector<Blob> blobs;
  double at(const Vec3& p_W) const {
    double sum = 0.0;
    for (const Blob& b : blobs)
      sum += b.height * std::exp(-0.5 * (p_W - b.p_W).squaredNorm() / (b.sigma_mm * b.sigma_mm));
    return sum;
  }
};

Blobs random_blobs(std::uint64_t seed, int count = 90) {
  Random random(seed);
  Blobs scene;
  for (int n = 0; n < count; ++n)
    scene.blobs.push_back({Vec3(random.uniform(-26, 26), random.uniform(-26, 26), random.uniform(-26, 26)),
                           random.uniform(2.0, 4.0), random.uniform() < 0.5 ? 4.0 : -4.0});
  return scene;
}

/// The scene on a grid about the origin, moved by X_WU.
volume::FloatGrid render(const Blobs& scene, const Pose& X_WU, const Vec3& spacing_mm = Vec3::Ones()) {
  volume::GridGeometry geometry;
  constexpr double kEdge_mm = 64.0;
  for (int a = 0; a < 3; ++a) {
    geometry.size[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(kEdge_mm / spacing_mm[a]);
    geometry.origin_P[a] = -0.5 * spacing_mm[a] * static_cast<double>(geometry.size[static_cast<std::size_t>(a)] - 1);
  }
  geometry.spacing_mm = spacing_mm;
  volume::FloatGrid grid(geometry);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n)
    grid.voxels[n] = static_cast<float>(scene.at(X_WU * geometry.centre_mm(geometry.index_of(n))));
  return grid;
}

ScaleSpace space_of(const volume::FloatGrid& grid, double spacing_mm = 0.0) {
  ScaleSpaceOptions options;
  options.spacing_mm = spacing_mm;
  return *build_scale_space(grid, volume::MaskGrid(grid.geometry, 1), options);
}

Mat3 random_rotation(std::uint64_t seed) {
  Random random(seed);
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

const Keypoint* nearest(const std::vector<Keypoint>& keypoints, const Vec3& p) {
  const Keypoint* best = nullptr;
  for (const Keypoint& k : keypoints)
    if (!best || (k.p_P - p).norm() < (best->p_P - p).norm()) best = &k;
  return best;
}

TEST(Keypoints, FindABlobAtItsPositionAndScale) {
  for (const double width_mm : {3.5, 5.0, 7.0}) {
    const Vec3 place(1.3, -2.6, 0.4);
    const auto grid = render({{{place, width_mm, 10.0}}}, Pose());
    KeypointOptions plain;
    plain.scale_exponent = 0.0;
    plain.least_contrast = 0.01;
    const auto keypoints = *find_keypoints(space_of(grid), plain);
    ASSERT_FALSE(keypoints.empty());
    const Keypoint& found = keypoints.front();
    EXPECT_LT((found.p_P - place).norm(), 0.05 * width_mm);
    // sigma^2 Laplacian of a Gaussian of width w is largest at sigma^2 = 2/3 w^2; levels are half a step finer.
    EXPECT_NEAR(found.sigma_mm / (std::sqrt(2.0 / 3.0) * width_mm), std::exp2(-1.0 / 6.0), 0.12);
    EXPECT_LT(found.contrast, 0.0) << "bright";
    EXPECT_NEAR(found.ratio, 1.0, 0.1);
  }
}

TEST(Keypoints, AreTheSameInAnisotropicVoxels) {
  const Blobs scene = random_blobs(3);
  const auto isotropic = *find_keypoints(space_of(render(scene, Pose())));
  const auto anisotropic = *find_keypoints(space_of(render(scene, Pose(), {0.8, 1.0, 1.25}), 1.0));
  ASSERT_GT(isotropic.size(), 15U);
  std::size_t same = 0;
  for (const Keypoint& k : isotropic) {
    const Keypoint* other = nearest(anisotropic, k.p_P);
    same += other && (other->p_P - k.p_P).norm() < 0.5 && std::abs(std::log2(other->sigma_mm / k.sigma_mm)) < 0.3;
  }
  EXPECT_GE(static_cast<double>(same), 0.85 * static_cast<double>(isotropic.size()));
}

TEST(Keypoints, RejectEdges) {
  Blobs line;
  for (int n = -60; n <= 60; ++n) line.blobs.push_back({Vec3(0.5 * n, 0.0, 0.0), 3.0, 0.2});
  const ScaleSpace space = space_of(render(line, Pose()));
  const auto kept = *find_keypoints(space);
  for (const Keypoint& k : kept) EXPECT_LT(k.ratio, 15.0);
  KeypointOptions all;
  all.largest_ratio = 1000.0;
  all.least_contrast = 0.0;
  KeypointOptions few = all;
  few.largest_ratio = 2.0;
  EXPECT_LE(find_keypoints(space, few)->size(), find_keypoints(space, all)->size());
}

TEST(Keypoints, UseNoShadowedVoxel) {
  const Blobs scene = random_blobs(5);
  volume::FloatGrid grid = render(scene, Pose());
  volume::MaskGrid usable(grid.geometry, 1);
  const auto& geometry = grid.geometry;
  for (std::size_t n = 0; n < grid.voxels.size(); ++n)
    usable.voxels[n] = geometry.centre_mm(geometry.index_of(n)).x() < 4.0 ? 1 : 0;
  const auto build = [&] { return *build_scale_space(grid, usable); };
  const ScaleSpace clean = build();
  const auto before = *find_keypoints(clean);
  const Features features_before = *describe(clean, before);
  Random random(1);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n)
    if (usable.voxels[n] == 0) grid.voxels[n] = static_cast<float>(100.0 * random.normal());
  const ScaleSpace dirty = build();
  const auto after = *find_keypoints(dirty);
  ASSERT_GT(before.size(), 5U);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t n = 0; n < before.size(); ++n) {
    EXPECT_EQ(before[n].p_P, after[n].p_P);
    EXPECT_LT(before[n].p_P.x(), 4.5);
  }
  EXPECT_EQ(features_before.descriptors, describe(dirty, after)->descriptors);
}

TEST(Orientation, IsRecoveredUnderRotation) {
  const Blobs scene = random_blobs(7);
  const ScaleSpace fixed = space_of(render(scene, Pose()));
  const auto keypoints = *find_keypoints(fixed);
  const OrientationFinder finder = *OrientationFinder::make();
  std::size_t compared = 0, recovered = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Mat3 R_WU = random_rotation(seed);
    const ScaleSpace turned = space_of(render(scene, Pose(R_WU, Vec3::Zero())));
    for (const Keypoint& k : keypoints) {
      if (k.p_P.norm() > 18.0) continue;
      Keypoint other = k;
      other.p_P = R_WU.transpose() * k.p_P;
      const auto in_fixed = finder.find(fixed, k);
      const auto in_turned = finder.find(turned, other);
      if (in_fixed.empty() || in_turned.empty()) continue;
      ++compared;
      // One of the orientations is the rotated first one, roll included.
      recovered += std::any_of(in_turned.begin(), in_turned.end(), [&](const Mat3& R_UK) {
        return Eigen::AngleAxisd(Mat3((R_WU * R_UK).transpose() * in_fixed.front())).angle() < std::numbers::pi / 8.0;
      });
    }
  }
  ASSERT_GT(compared, 20U);
  EXPECT_GE(static_cast<double>(recovered), 0.95 * static_cast<double>(compared));
}

/// Distance of descriptors at the same places of two volumes of a scene, in orientations that correspond.
struct Distances {
  double same = 0.0;   ///< Mean of the same keypoints.
  double other = 0.0;  ///< Mean of different keypoints.
};
Distances compare(const Blobs& scene, const Pose& X_WU, const Vec3& spacing_mm) {
  const ScaleSpace a = space_of(render(scene, Pose()));
  const ScaleSpace b = space_of(render(scene, X_WU, spacing_mm), 1.0);
  std::vector<Keypoint> in_a, in_b;
  const auto found = *find_keypoints(a);
  for (const Keypoint& k : found) {
    if (k.p_P.norm() > 18.0) continue;
    in_a.push_back(k);
    in_b.push_back(k);
    in_b.back().p_P = X_WU.inverse() * k.p_P;
  }
  const Features fa = *describe(a, in_a), fb = *describe(b, in_b);
  Distances distances;
  double same = 0.0, other = 0.0;
  for (std::size_t n = 0; n < fa.features.size(); ++n) {
    double nearest_same = 3.0;
    for (std::size_t m = 0; m < fb.features.size(); ++m) {
      const double d = descriptor_distance(fa.descriptors[n], fb.descriptors[m]);
      if (fa.features[n].keypoint == fb.features[m].keypoint) {
        nearest_same = std::min(nearest_same, d);
      } else {
        distances.other += d;
        other += 1.0;
      }
    }
    if (nearest_same > 2.5) continue;
    distances.same += nearest_same;
    same += 1.0;
  }
  distances.same /= same;
  distances.other /= other;
  return distances;
}

TEST(Descriptor, IsBoundedUnderRotation) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Distances d = compare(random_blobs(seed), Pose(random_rotation(seed), Vec3::Zero()), Vec3::Ones());
    EXPECT_LT(d.same, 0.25) << seed;
    EXPECT_GT(d.other, 2.5 * d.same) << seed;
  }
}

TEST(Descriptor, IsBoundedUnderAnisotropicResampling) {
  const Distances d = compare(random_blobs(11), Pose(random_rotation(4), Vec3::Zero()), {0.8, 1.0, 1.3});
  EXPECT_LT(d.same, 0.45);
  EXPECT_GT(d.other, 2.5 * d.same);
}

TEST(Descriptor, HasUnitLength) {
  const ScaleSpace space = space_of(render(random_blobs(2), Pose()));
  const Features features = *describe(space, *find_keypoints(space));
  ASSERT_FALSE(features.descriptors.empty());
  for (const Descriptor& d : features.descriptors) {
    double sum = 0.0;
    for (const std::int16_t v : d) sum += static_cast<double>(v) * v;
    EXPECT_NEAR(std::sqrt(sum) / kDescriptorNorm, 1.0, 2e-3);
  }
}

TEST(Sift3d, RefusesInvalidThresholds) {
  const volume::FloatGrid grid = render(random_blobs(1, 3), Pose());
  const volume::MaskGrid usable(grid.geometry, 1);
  const auto refused = [](const auto& result) { return !result && result.error().exit_status == 2; };
  const double nan = std::nan("");
  for (const double sigma : {0.0, -1.0, 5.0, nan})
    EXPECT_TRUE(refused(build_scale_space(grid, usable, {.first_sigma = sigma})));
  for (const int count : {0, -1, 9}) {
    EXPECT_TRUE(refused(build_scale_space(grid, usable, {.scales = count})));
    EXPECT_TRUE(refused(build_scale_space(grid, usable, {.octaves = count})));
  }
  for (const double spacing : {-1.0, 1e-6, 1e6, nan})
    EXPECT_TRUE(refused(build_scale_space(grid, usable, {.spacing_mm = spacing})));
  const ScaleSpace space = space_of(grid);
  for (const double value : {-0.1, 11.0, nan}) {
    EXPECT_TRUE(refused(find_keypoints(space, {.least_contrast = value})));
    EXPECT_TRUE(refused(find_keypoints(space, {.scale_exponent = value})));
  }
  for (const double ratio : {0.5, 1e6, nan}) EXPECT_TRUE(refused(find_keypoints(space, {.largest_ratio = ratio})));
  EXPECT_TRUE(refused(find_keypoints(space, {.most = 0})));
  for (const double value : {0.0, 9.0, nan}) EXPECT_TRUE(refused(describe(space, {}, {.sample_sigma = value})));
  for (const double value : {-0.1, 1.1, nan}) {
    EXPECT_TRUE(refused(describe(space, {}, {.least_usable = value})));
    EXPECT_TRUE(refused(describe(space, {}, {.orientation = {.least_peak = value}})));
    EXPECT_TRUE(refused(match({}, {}, {.largest_ratio = value})));
    EXPECT_TRUE(refused(match({}, {}, {.largest_gray_distance = value})));
  }
  for (const double value : {0.0, 1.5, nan}) EXPECT_TRUE(refused(describe(space, {}, {.largest_element = value})));
  EXPECT_TRUE(refused(describe(space, {}, {.orientation = {.most = 0}})));
}

}  // namespace
}  // namespace trocar::registration
