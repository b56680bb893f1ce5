#include "xray/contrast/duct_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "duct_patient.h"
#include "phantom/phantom.h"

namespace trocar::xray {
namespace {

using testing::everywhere;
using testing::make_labelled_patient;
using testing::tube;

std::vector<const DuctCell*> ends_of(const DuctTree& tree, DuctEnd kind) {
  std::vector<const DuctCell*> found;
  for (const DuctCell& cell : tree.cells) {
    if (cell.end == kind) found.push_back(&cell);
    if (cell.root_end == kind) found.push_back(&cell);
  }
  return found;
}

std::ptrdiff_t roots_of(const DuctTree& tree) {
  return std::count_if(tree.cells.begin(), tree.cells.end(), [](const DuctCell& cell) { return cell.parent < 0; });
}

double voxels_ml(const anatomy::VirtualPatient& patient, const std::string& tissue) {
  double ml = 0.0;
  for (const std::uint8_t id : patient.labels.voxels) {
    const anatomy::Label* label = patient.label_table.find(id);
    if (label != nullptr && label->tissue == tissue) ml += patient.labels.geometry.voxel_volume_mm3() / 1000.0;
  }
  return ml;
}

double length_mm(const DuctTree& tree) {
  double sum = 0.0;
  for (const DuctCell& cell : tree.cells) sum += cell.length_mm();
  return sum;
}

TEST(DuctTree, FollowsAStraightTubeWithItsVolume) {
  const double radius = 3.0;
  const Vec3 half(4, -3, 30);  // oblique, so that voxels represent its section
  const auto patient = make_labelled_patient(
      {30, 30, 80}, {1, 1, 1}, {{"liver", "liver", everywhere()}, {"duct", "bile_duct", tube(-half, half, radius)}});
  const DuctTree tree = make_duct_tree(*patient);
  const double true_ml = std::numbers::pi * radius * radius * (2 * half.norm() + 4.0 / 3.0 * radius) / 1000.0;
  EXPECT_NEAR(tree.volume_ml(), true_ml, 0.03 * true_ml);  // voxels of 1 mm
  EXPECT_NEAR(tree.volume_ml(), voxels_ml(*patient, "bile_duct"), 1e-9);
  EXPECT_NEAR(length_mm(tree), 2 * (half.norm() + radius), 3.0);
  EXPECT_EQ(roots_of(tree), 1);
  for (const DuctCell& cell : tree.cells) EXPECT_NEAR(cell.radius_b_mm, radius, 0.4);
  EXPECT_EQ(ends_of(tree, DuctEnd::kPeripheral).size(), 2u);
}

TEST(DuctTree, ResolvesTheEndsOfAWideDuct) {
  const auto patient = make_labelled_patient(
      {30, 30, 80}, {1, 1, 1},
      {{"liver", "liver", everywhere()}, {"duct", "bile_duct", tube({0, 0, -25}, {0, 0, 25}, 7.0)}});
  const DuctTree tree = make_duct_tree(*patient);
  ASSERT_FALSE(tree.cells.empty());
  for (const DuctCell& cell : tree.cells) EXPECT_LT(cell.length_mm(), 3.0);
  EXPECT_EQ(ends_of(tree, DuctEnd::kPeripheral).size(), 2u);
}

TEST(DuctTree, ScalesTheRadiiOfEachBranch) {
  const auto patient = make_labelled_patient({80, 30, 90}, {1, 1, 1},
                                             {{"liver", "liver", everywhere()},
                                              {"stem", "bile_duct", tube({0, 0, -35}, {0, 0, 0}, 4.0)},
                                              {"left", "bile_duct", tube({0, 0, 0}, {30, 0, 30}, 3.0)},
                                              {"right", "bile_duct", tube({0, 0, 0}, {-30, 0, 30}, 2.0)}});
  const DuctTree tree = make_duct_tree(*patient);
  const auto radius_at = [&](const Vec3& p) {
    const int cell = tree.find_cell(p, 1.0);
    return cell < 0 ? 0.0 : tree.cells[static_cast<std::size_t>(cell)].radius_b_mm;
  };
  EXPECT_NEAR(radius_at({0, 0, -20}), 4.0, 0.4);
  EXPECT_NEAR(radius_at({15, 0, 15}), 3.0, 0.35);
  EXPECT_NEAR(radius_at({-15, 0, 15}), 2.0, 0.35);
  EXPECT_EQ(ends_of(tree, DuctEnd::kPeripheral).size(), 3u);
}

TEST(DuctTree, KeepsADuctOfOneVoxelConnected) {
  const auto nowhere = [](const Vec3&) { return false; };
  auto patient = make_labelled_patient({60, 60, 60}, {1, 1, 1},
                                       {{"liver", "liver", everywhere()}, {"duct", "bile_duct", nowhere}});
  for (std::int64_t n = 5; n < 55; ++n) patient->labels[{n, (n * 2) / 3 + 4, n}] = 2;  // touches by corners
  const DuctTree tree = make_duct_tree(*patient);
  EXPECT_EQ(roots_of(tree), 1);
  EXPECT_EQ(ends_of(tree, DuctEnd::kPeripheral).size(), 2u);
  EXPECT_NEAR(tree.volume_ml(), 0.05, 1e-6);
}

TEST(DuctTree, BridgesNarrowGapsOnly) {
  const auto with_gap = [](double gap_mm) {
    return make_labelled_patient({30, 30, 100}, {1, 1, 1},
                                 {{"liver", "liver", everywhere()},
                                  {"a", "bile_duct", tube({0, 0, -40}, {0, 0, -4}, 2.0)},
                                  {"b", "bile_duct", tube({0, 0, gap_mm}, {0, 0, 40}, 2.0)}});
  };
  EXPECT_EQ(roots_of(make_duct_tree(*with_gap(2.0))), 1);  // 2 mm between the round ends
  EXPECT_EQ(roots_of(make_duct_tree(*with_gap(12.0))), 2);
  EXPECT_EQ(roots_of(make_duct_tree(*with_gap(2.0), {.bridge_mm = 0.0})), 2);
}

TEST(DuctTree, CutsALoopOnce) {
  const auto ring = [](const Vec3& p) {
    const double around = std::hypot(p.x(), p.z()) - 20.0;
    return std::hypot(around, p.y()) <= 2.5;
  };
  const auto patient =
      make_labelled_patient({60, 20, 60}, {1, 1, 1}, {{"liver", "liver", everywhere()}, {"ring", "bile_duct", ring}});
  const DuctTree tree = make_duct_tree(*patient);
  EXPECT_EQ(roots_of(tree), 1);
  EXPECT_NEAR(tree.volume_ml(), voxels_ml(*patient, "bile_duct"), 1e-9);
  EXPECT_NEAR(length_mm(tree), 2 * std::numbers::pi * 20.0, 20.0);
}

TEST(DuctTree, FindsThePapillaAtTheBowel) {
  const auto patient = make_labelled_patient({60, 40, 100}, {1, 1, 1},
                                             {{"liver", "liver", everywhere()},
                                              {"duodenum", "bowel", [](const Vec3& p) { return p.z() < -35; }},
                                              {"duct", "bile_duct", tube({0, 0, -33}, {0, 0, 35}, 2.5)}});
  const DuctTree tree = make_duct_tree(*patient);
  const std::vector<const DuctCell*> papilla = ends_of(tree, DuctEnd::kPapilla);
  ASSERT_EQ(papilla.size(), 1u);
  EXPECT_LT(std::min(papilla[0]->a_P.z(), papilla[0]->b_P.z()), -30.0);
}

TEST(DuctTree, ClosesADuctWhereATumourNarrowsIt) {
  const auto patient = make_labelled_patient({60, 40, 100}, {1, 1, 1},
                                             {{"liver", "liver", everywhere()},
                                              {"duodenum", "bowel", [](const Vec3& p) { return p.z() < -35; }},
                                              {"tumour", "liver_lesion", testing::ball({0, 0, -14}, 9.0)},
                                              {"narrow", "bile_duct", tube({0, 0, -33}, {0, 0, -10}, 1.2)},
                                              {"wide", "bile_duct", tube({0, 0, -10}, {0, 0, 35}, 4.0)}});
  const DuctTree tree = make_duct_tree(*patient);
  std::vector<double> closed_z;
  for (const DuctCell& cell : tree.cells)
    if (cell.is_closed) closed_z.push_back(cell.a_P.z());
  ASSERT_EQ(closed_z.size(), 1u);
  EXPECT_GT(closed_z[0], -14.0 - 9.0 - 2.0);
  EXPECT_LT(closed_z[0], -10.0);
}

TEST(DuctTree, IsEmptyWithoutDucts) {
  const auto patient = make_labelled_patient({20, 20, 20}, {1, 1, 1}, {{"liver", "liver", everywhere()}});
  EXPECT_TRUE(make_duct_tree(*patient).cells.empty());
  EXPECT_EQ(make_duct_tree(*patient).find_cell({0, 0, 0}, 100.0), -1);
}

TEST(DuctTree, IsObstructedAtTheTumourInTheEmbeddedPatient) {
  const auto patient = phantom::generate_phantom("ptcd-3", 1, {.voxel_mm = 2.5});
  ASSERT_TRUE(patient) << patient.error().text();
  const DuctTree tree = make_duct_tree(*patient);
  EXPECT_EQ(std::count_if(tree.cells.begin(), tree.cells.end(), [](const DuctCell& cell) { return cell.is_closed; }),
            1);
  EXPECT_EQ(ends_of(tree, DuctEnd::kPapilla).size(), 1u);
  EXPECT_GT(ends_of(tree, DuctEnd::kPeripheral).size(), 30u);
  const double true_ml = voxels_ml(*patient, "bile_duct");
  EXPECT_NEAR(tree.volume_ml(), true_ml, 0.05 * true_ml);  // specks are left out, bridges added
}

}  // namespace
}  // namespace trocar::xray
