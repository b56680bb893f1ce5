#include <gtest/gtest.h>

#include <cmath>

#include "xray/tools/tool_shape.h"

namespace trocar::xray {
namespace {

/// A trunk of 30 mm along x that splits into a straight branch along x and one along y, of 30 mm each.
DuctTree forked() {
  DuctTree tree;
  const auto add = [&](const Vec3& a_P, const Vec3& b_P, int parent) {
    DuctCell cell;
    cell.a_P = a_P;
    cell.b_P = b_P;
    cell.radius_a_mm = cell.radius_b_mm = 2.0;
    cell.parent = parent;
    tree.cells.push_back(cell);
    return static_cast<int>(tree.cells.size()) - 1;
  };
  int trunk = -1, straight = -1, side = -1;
  for (int n = 0; n < 3; ++n) trunk = add({10.0 * n, 0, 0}, {10.0 * (n + 1), 0, 0}, trunk);
  straight = side = trunk;
  for (int n = 0; n < 3; ++n) straight = add({30.0 + 10.0 * n, 0, 0}, {40.0 + 10.0 * n, 0, 0}, straight);
  for (int n = 0; n < 3; ++n) side = add({30, 10.0 * n, 0}, {30, 10.0 * (n + 1), 0}, side);
  return tree;
}

double way_length_mm(const std::vector<Vec3>& points_P) {
  double sum_mm = 0.0;
  for (std::size_t n = 1; n < points_P.size(); ++n) sum_mm += (points_P[n] - points_P[n - 1]).norm();
  return sum_mm;
}

const Vec3 kDownX = Vec3(0.3, -1.0, 0.0).normalized();  // points along the trunk
const Vec3 kUpX = Vec3(-0.3, -1.0, 0.0).normalized();

TEST(GuideWire, FollowsTheStraightestBranchInTheNeedleDirection) {
  const auto way_P = guide_wire_way(forked(), {15, 0, 0}, kDownX, 40.0);
  EXPECT_NEAR(way_length_mm(way_P), 40.0, 1e-9);
  EXPECT_NEAR((way_P.back() - Vec3(55, 0, 0)).norm(), 0.0, 1e-9);
  const auto back_P = guide_wire_way(forked(), {15, 0, 0}, kUpX, 12.0);
  EXPECT_NEAR((back_P.back() - Vec3(3, 0, 0)).norm(), 0.0, 1e-9);
}

TEST(GuideWire, TurnsFromABranchIntoTheTrunkOrSecondBranch) {
  const auto way_P = guide_wire_way(forked(), {30, 20, 0}, Vec3(0, -1, 0), 35.0);  // towards the fork
  EXPECT_NEAR(way_length_mm(way_P), 35.0, 1e-9);
  EXPECT_NEAR(way_P.back().y(), 0.0, 1e-9) << "both ways on are equally bent";
  EXPECT_NEAR(std::abs(way_P.back().x() - 30.0), 15.0, 1e-9);
}

TEST(GuideWire, StopsAtTheDuctEndOrAnObstruction) {
  EXPECT_NEAR(way_length_mm(guide_wire_way(forked(), {15, 0, 0}, kDownX, 200.0)), 45.0, 1e-9);
  EXPECT_NEAR(way_length_mm(guide_wire_way(forked(), {15, 0, 0}, kUpX, 200.0)), 15.0, 1e-9);
  DuctTree tree = forked();
  tree.cells[1].is_closed = true;  // between 0 and 10 mm, and the rest
  EXPECT_NEAR(guide_wire_way(tree, {25, 0, 0}, kUpX, 200.0).back().x(), 10.0, 1e-9);
  tree.cells[3].is_closed = true;  // the straight branch: the wire turns into the other one
  EXPECT_NEAR((guide_wire_way(tree, {25, 0, 0}, kDownX, 200.0).back() - Vec3(30, 30, 0)).norm(), 0.0, 1e-9);
}

TEST(GuideWire, BucklesOutsideOfTheDucts) {
  const auto way_P = guide_wire_way(forked(), {15, 8, 0}, Vec3(0, 0, 1), 50.0);
  ASSERT_EQ(way_P.size(), 2u);
  EXPECT_NEAR((way_P.back() - Vec3(15, 8, kWireInTissue_mm)).norm(), 0.0, 1e-9);
  EXPECT_EQ(guide_wire_way(DuctTree{}, {0, 0, 0}, Vec3(0, 0, 1), 50.0).size(), 2u);
}

TEST(GuideWire, IsAPointWithoutValidLengthOrPosition) {
  EXPECT_EQ(guide_wire_way(forked(), {15, 0, 0}, kDownX, 0.0).size(), 1u);
  EXPECT_EQ(guide_wire_way(forked(), {15, 0, 0}, kDownX, -3.0).size(), 1u);
  EXPECT_EQ(guide_wire_way(forked(), {15, 0, 0}, kDownX, std::nan("")).size(), 1u);
  EXPECT_EQ(guide_wire_way(forked(), Vec3::Constant(std::nan("")), kDownX, 10.0).size(), 1u);
}

}  // namespace
}  // namespace trocar::xray
