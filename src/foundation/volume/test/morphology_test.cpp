#include "volume/morphology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "make_grids.h"

namespace trocar::volume {
namespace {

/// Slow reference: flood fill from every voxel not yet reached.
std::vector<std::vector<std::size_t>> flooded_components(const MaskGrid& mask) {
  std::vector<std::vector<std::size_t>> components;
  std::vector<bool> seen(mask.voxels.size(), false);
  for (std::size_t start = 0; start < mask.voxels.size(); ++start) {
    if (seen[start] || mask.voxels[start] == 0) continue;
    std::vector<std::size_t> members{start};
    seen[start] = true;
    for (std::size_t n = 0; n < members.size(); ++n) {
      for (std::size_t a = 0; a < 3; ++a)
        for (const std::int64_t step : {-1, 1}) {
          Index3 next = mask.geometry.index_of(members[n]);
          next[a] += step;
          if (!mask.geometry.contains(next) || mask[next] == 0 || seen[mask.geometry.offset(next)]) continue;
          seen[mask.geometry.offset(next)] = true;
          members.push_back(mask.geometry.offset(next));
        }
    }
    components.push_back(members);
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

TEST(ConnectedComponents, AgreeWithFloodFillOnRandomMasks) {
  Random random(20);
  for (const double filled : {0.05, 0.25, 0.31, 0.5, 0.9}) {  // 0.31: where clusters begin to span the grid
    for (const Index3& size : {Index3{15, 13, 11}, Index3{40, 30, 1}, Index3{1, 1, 50}}) {
      const MaskGrid mask = noise_mask(plain_geometry(size), filled, random);
      const Components components = connected_components(mask);
      const auto expected = flooded_components(mask);
      ASSERT_EQ(components.voxel_counts.size(), expected.size());
      Grid<std::int32_t> ids(mask.geometry);
      for (std::size_t c = 0; c < expected.size(); ++c) {
        EXPECT_EQ(components.voxel_counts[c], expected[c].size());
        for (const std::size_t n : expected[c]) ids.voxels[n] = static_cast<std::int32_t>(c + 1);
      }
      EXPECT_EQ(components.ids.voxels, ids.voxels);
    }
  }
}

TEST(ConnectedComponents, DoNotJoinAcrossEdgesOrRowEnds) {
  MaskGrid mask(plain_geometry({3, 3, 3}));
  mask[{0, 0, 0}] = mask[{1, 1, 0}] = mask[{2, 2, 1}] = 1;  // touch along edges only
  EXPECT_EQ(connected_components(mask).voxel_counts.size(), 3u);
  mask = MaskGrid(plain_geometry({3, 3, 3}));
  mask[{2, 0, 0}] = mask[{0, 1, 0}] = 1;  // neighbours in memory, not in space
  EXPECT_EQ(connected_components(mask).voxel_counts.size(), 2u);
}

TEST(LargestComponent, KeepsOnlyTheLargest) {
  Random random(21);
  const MaskGrid mask = noise_mask(plain_geometry({15, 13, 11}), 0.25, random);
  const auto expected = flooded_components(mask).front();
  const MaskGrid largest = largest_component(mask);
  EXPECT_EQ(static_cast<std::size_t>(std::count(largest.voxels.begin(), largest.voxels.end(), 1)), expected.size());
  for (const std::size_t n : expected) EXPECT_EQ(largest.voxels[n], 1);
}

TEST(LargestComponent, IsEmptyForAnEmptyMask) {
  const MaskGrid empty(plain_geometry({3, 3, 3}));
  EXPECT_EQ(largest_component(empty).voxels, empty.voxels);
  EXPECT_TRUE(connected_components(empty).voxel_counts.empty());
}

/// A box with walls one voxel thick.
MaskGrid hollow_box(const Index3& size, const Index3& first, const Index3& last) {
  MaskGrid mask(plain_geometry(size));
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    const Index3 v = mask.geometry.index_of(n);
    bool in_box = true;
    bool on_wall = false;
    for (std::size_t a = 0; a < 3; ++a) {
      in_box = in_box && v[a] >= first[a] && v[a] <= last[a];
      on_wall = on_wall || v[a] == first[a] || v[a] == last[a];
    }
    mask.voxels[n] = in_box && on_wall ? 1 : 0;
  }
  return mask;
}

std::int64_t count_of(const MaskGrid& mask) {
  return std::count(mask.voxels.begin(), mask.voxels.end(), 1);
}

TEST(FillHoles, ClosesACavityButNotAnOpenOne) {
  MaskGrid box = hollow_box({9, 9, 9}, {1, 1, 1}, {7, 7, 7});
  EXPECT_EQ(count_of(fill_holes(box)), 7 * 7 * 7);
  box[{4, 4, 7}] = 0;  // a hole in the lid
  EXPECT_EQ(fill_holes(box).voxels, box.voxels);
}

TEST(FillHoles, KeepsHolesThatReachTheGridBorder) {
  const MaskGrid tube = hollow_box({9, 9, 5}, {1, 1, -1}, {7, 7, 5});  // runs out of the grid above and below
  EXPECT_EQ(fill_holes(tube).voxels, tube.voxels);
  EXPECT_EQ(count_of(fill_holes_in_slices(tube)), 7 * 7 * 5);
}

TEST(FillHoles, InSlicesKeepsHolesThatReachTheSliceEdge) {
  const MaskGrid trough = hollow_box({9, 9, 5}, {-1, 1, -1}, {7, 7, 5});
  EXPECT_EQ(fill_holes_in_slices(trough).voxels, trough.voxels);
}

/// Slow reference of growing: every voxel within the radius of one of the mask.
MaskGrid grown_by_definition(const MaskGrid& mask, double radius_mm) {
  MaskGrid result(mask.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n)
    for (std::size_t m = 0; m < mask.voxels.size() && result.voxels[n] == 0; ++m) {
      if (mask.voxels[m] == 0) continue;
      const Index3 a = mask.geometry.index_of(n);
      const Index3 b = mask.geometry.index_of(m);
      const Vec3 steps(static_cast<double>(a[0] - b[0]), static_cast<double>(a[1] - b[1]),
                       static_cast<double>(a[2] - b[2]));
      if (steps.cwiseProduct(mask.geometry.spacing_mm).norm() <= radius_mm * (1 + 1e-9)) result.voxels[n] = 1;
    }
  return result;
}

MaskGrid inverted(MaskGrid mask) {
  for (auto& voxel : mask.voxels) voxel = voxel == 0 ? 1 : 0;
  return mask;
}

TEST(Dilate, EqualsTheDefinition) {
  Random random(22);
  for (const double radius_mm : {0.0, 0.9, 1.0, 2.0, 3.7, 100.0}) {
    const MaskGrid mask = noise_mask(plain_geometry({12, 10, 8}, {1.0, 0.5, 2.0}), 0.01, random);
    EXPECT_EQ(dilate(mask, radius_mm).voxels, grown_by_definition(mask, radius_mm).voxels) << radius_mm;
  }
}

TEST(Erode, EqualsDilatingTheOutside) {
  Random random(23);
  for (const double radius_mm : {0.0, 0.9, 1.0, 2.0, 3.7, 100.0}) {
    const MaskGrid mask = inverted(noise_mask(plain_geometry({12, 10, 8}, {1.0, 0.5, 2.0}), 0.01, random));
    EXPECT_EQ(erode(mask, radius_mm).voxels, inverted(grown_by_definition(inverted(mask), radius_mm)).voxels);
    EXPECT_EQ(dilate(mask, -radius_mm).voxels, erode(mask, radius_mm).voxels);
  }
}

TEST(Erode, DoesNotShrinkFromTheGridBorder) {
  const MaskGrid full(plain_geometry({5, 5, 5}), 1);
  EXPECT_EQ(erode(full, 2.0).voxels, full.voxels);
}

TEST(Dilate, KeepsAnEmptyMaskEmpty) {
  const MaskGrid empty(plain_geometry({5, 5, 5}));
  EXPECT_EQ(dilate(empty, 3.0).voxels, empty.voxels);
  EXPECT_EQ(erode(empty, 3.0).voxels, empty.voxels);
}

}  // namespace
}  // namespace trocar::volume
