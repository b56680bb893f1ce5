#include "tasks/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/files/folders.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/shipped_task.h"
#include "volume/sampling.h"

namespace trocar::tasks {
namespace {

using testing::BoxPatient;
using testing::liver_biopsy;
using testing::shipped_needle;

std::string tissue_at(const anatomy::VirtualPatient& patient, const Vec3& p_P) {
  const anatomy::Label* label = anatomy::find_label(patient, p_P);
  return label ? label->tissue : "";
}

Vec3 end_of_throw(const PlannedPath& path, const Needle& n) {
  return path.line_P.b + n.throw_mm * path.line_P.direction();
}
Vec3 notch_middle(const PlannedPath& path, const Needle& n) {
  return path.line_P.b + n.notch_middle_mm() * path.line_P.direction();
}

/// Smallest clearance of a path, throw included, to the risk voxels (as boxes) beyond their margins: slow, independent
/// of the planner.
double smallest_clearance(const Task& task, const anatomy::VirtualPatient& patient, const PlannedPath& path,
                          const Needle& n) {
  const volume::GridGeometry& geometry = patient.labels.geometry;
  const Segment way{path.line_P.a, end_of_throw(path, n)};
  std::array<const RiskStructure*, 256> risks{};
  for (const anatomy::Label& label : patient.label_table.labels) risks[label.id] = find_risk(task, label);
  double smallest = 1e9;
  for (std::size_t v = 0; v < patient.labels.voxels.size(); ++v) {
    const RiskStructure* risk = risks[patient.labels.voxels[v]];
    if (!risk) continue;
    const volume::Index3 ijk = geometry.index_of(v);
    const Vec3 centre = geometry.centre_mm(ijk);
    if (distance_mm(way, centre) - risk->margin_mm > smallest + geometry.spacing_mm.norm()) continue;
    for (double s = 0.0; s <= 1.0; s += 0.002) {
      const Vec3 outside = ((way.at(s) - centre).cwiseAbs() - 0.5 * geometry.spacing_mm).cwiseMax(0.0);
      smallest = std::min(smallest, outside.norm() - risk->margin_mm);
    }
  }
  return smallest;
}

/// A box patient with ribs, a vessel in the liver, a lung above it and a gallbladder.
BoxPatient crowded() {
  BoxPatient box;
  box.special = [](const Vec3& p) -> std::string {
    const double depth = -BoxPatient::skin_distance(p);
    const double in_rib_step = std::abs(std::remainder(p.z() - 6.0, 26.0));
    if (depth > 12.5 && depth < 21.5 && in_rib_step < 5.0) return "bone";
    if (depth > 22.0 && p.z() > 34.0) return "lung";
    if (std::hypot(p.x() + 22.0, p.z() + 8.0) < 3.0 && depth > 30.0) return "vessel";
    if ((p - Vec3(-5.0, -35.0, -20.0)).norm() < 10.0) return "gallbladder";
    return "";
  };
  return box;
}

TEST(Plan, BestPathIsStraightDownWithoutObstacles) {
  const BoxPatient box;
  const auto paths = plan_paths(liver_biopsy(), box.make(), shipped_needle());
  ASSERT_TRUE(paths) << paths.error().text();
  ASSERT_EQ(paths->size(), 1u);
  const PlannedPath& path = paths->front();
  const double depth_mm = 70.0 + box.lesion_centre_P.y();  // of the lesion's centre below the front
  EXPECT_NEAR(path.length_mm, depth_mm - shipped_needle().notch_middle_mm(), 0.1);
  EXPECT_NEAR(path.length_mm, path.line_P.length_mm(), 1e-9);
  EXPECT_LT((notch_middle(path, shipped_needle()) - box.lesion_centre_P).norm(), 0.1);
  EXPECT_NEAR(path.line_P.a.y(), -70.0, 0.01);
  // Liver from 22 mm below the skin to the tip, which comes to rest before the lesion's border; voxels are 2 mm.
  EXPECT_NEAR(path.organ_path_mm, path.length_mm - 22.0, 1.5);
  EXPECT_EQ(path.nearest_risk, "");
  EXPECT_EQ(path.spare_margin_mm, 10.0);
}

TEST(Plan, UnfiredNeedleEndsInTheTarget) {
  const BoxPatient box;
  const auto paths = plan_paths(liver_biopsy(), box.make(), shipped_needle("chiba-22g"));
  ASSERT_TRUE(paths) << paths.error().text();
  EXPECT_LT((paths->front().line_P.b - box.lesion_centre_P).norm(), 0.1);
  EXPECT_NEAR(paths->front().length_mm, 55.0, 0.1);
}

// A rib over the lesion: every tilt has its length and its distance to the rib's lower edge in closed form, and the
// best path has the least of what both cost. The shortest path that keeps 3 mm is not it.
TEST(Plan, BestPathPassesARibWithSpareMargin) {
  BoxPatient box;
  box.special = [](const Vec3& p) -> std::string {
    const double depth = p.y() + 70.0;
    return depth > 12.5 && depth < 21.5 && std::abs(p.z()) < 5.0 ? "bone" : "";
  };
  const auto paths = plan_paths(liver_biopsy(), box.make(), shipped_needle());
  ASSERT_TRUE(paths) << paths.error().text();
  double least_mm = 1e9;
  double shortest_mm = 1e9;
  for (double t = 0.0; t < 1.0;
       t += 1e-4) {  // tangent of the tilt; edge of the rib's voxels at depth 21 mm, 5 mm aside
    const double stretch = std::sqrt(1.0 + t * t);
    const double spare_mm = ((55.0 - 21.0) * t - 5.0) / stretch - 3.0;
    const double length_mm = 55.0 * stretch - shipped_needle().notch_middle_mm();
    if (spare_mm < 0.0) continue;
    shortest_mm = std::min(shortest_mm, length_mm);
    least_mm = std::min(least_mm, path_cost_mm(length_mm, spare_mm));
  }
  const PlannedPath& best = paths->front();
  EXPECT_DOUBLE_EQ(best.cost_mm, path_cost_mm(best.length_mm, best.spare_margin_mm));
  EXPECT_GE(best.cost_mm, least_mm - 0.02);
  EXPECT_LE(best.cost_mm, least_mm + 0.3);  // lines are about 1 mm apart
  EXPECT_GT(best.length_mm, shortest_mm + 1.0);
  EXPECT_GT(best.spare_margin_mm, 4.0);
}

TEST(Plan, ScarceMarginIsWorthMoreLength) {
  EXPECT_DOUBLE_EQ(path_cost_mm(80.0, 10.0), 80.0);
  EXPECT_DOUBLE_EQ(path_cost_mm(80.0, 25.0), 80.0);
  EXPECT_DOUBLE_EQ(path_cost_mm(80.0, 0.0), 100.0);
  EXPECT_DOUBLE_EQ(path_cost_mm(80.0, -1.0), 100.0);
  EXPECT_LT(path_cost_mm(81.6, 9.5), path_cost_mm(80.0, 0.0));
  double last_gain_mm = 1e9;
  for (double spare_mm = 0.0; spare_mm < 10.0; spare_mm += 1.0) {
    const double gain_mm = path_cost_mm(80.0, spare_mm) - path_cost_mm(80.0, spare_mm + 1.0);
    EXPECT_GT(gain_mm, 0.0);
    EXPECT_LT(gain_mm, last_gain_mm);
    last_gain_mm = gain_mm;
  }
}

// The planner checks candidates in the order of a bound; nothing that it leaves unchecked may be better.
TEST(Plan, SinglePathIsTheBestOfMany) {
  const anatomy::VirtualPatient patient = crowded().make();
  const auto one = plan_paths(liver_biopsy(), patient, shipped_needle(), {1, 3});
  const auto all =
      plan_paths(liver_biopsy(), patient, shipped_needle(), {2000, 3});  // not spread, and of the same lines
  ASSERT_TRUE(one && all);
  ASSERT_GT(all->size(), 500u);
  double least_mm = 1e9;
  for (const PlannedPath& path : *all) least_mm = std::min(least_mm, path.cost_mm);
  EXPECT_DOUBLE_EQ(one->front().cost_mm, least_mm);
  EXPECT_TRUE(std::is_sorted(all->begin(), all->end(),
                             [](const PlannedPath& a, const PlannedPath& b) { return a.cost_mm < b.cost_mm; }));
}

TEST(Plan, PathsKeepMarginsOverTheWholeThrow) {
  const Task task = liver_biopsy();
  const anatomy::VirtualPatient patient = crowded().make();
  const auto paths = plan_paths(task, patient, shipped_needle(), {40, 3});
  ASSERT_TRUE(paths) << paths.error().text();
  ASSERT_EQ(paths->size(), 40u);
  for (const PlannedPath& path : *paths) {
    const double smallest = smallest_clearance(task, patient, path, shipped_needle());
    EXPECT_GE(smallest, -0.02);
    EXPECT_NEAR(path.spare_margin_mm, std::min(smallest, 10.0), 0.05);
    EXPECT_EQ(path.nearest_risk.empty(), path.spare_margin_mm >= 10.0);
  }
}

TEST(Plan, PathsPassSkinMuscleAndLiverInOrder) {
  const Task task = liver_biopsy();
  const anatomy::VirtualPatient patient = crowded().make();
  const auto paths = plan_paths(task, patient, shipped_needle(), {60, 4});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) {
    EXPECT_NEAR(volume::sample_linear(patient.skin_distance_mm, path.line_P.a), 0.0, 0.01);
    const Segment way{path.line_P.a, end_of_throw(path, shipped_needle())};
    double muscle_mm = 0.0;
    double organ_mm = 0.0;
    bool has_organ = false;
    bool has_lesion = false;
    for (double s = 0.05; s < way.length_mm(); s += 0.1) {
      const std::string tissue = tissue_at(patient, way.a + s * way.direction());
      EXPECT_TRUE(tissue == "adipose" || tissue == "muscle" || tissue == "liver" || tissue == "liver_lesion" ||
                  tissue == "soft_tissue" || (tissue.empty() && s < 2.0))
          << tissue << " at " << s;
      if (tissue == "muscle" && !has_organ) muscle_mm += 0.1;
      has_organ |= tissue == "liver";
      has_lesion |= tissue == "liver_lesion";
      if (tissue == "liver" && !has_lesion && s < path.length_mm) organ_mm += 0.1;
    }
    EXPECT_GE(muscle_mm, 2.0);
    EXPECT_TRUE(has_lesion);
    EXPECT_GE(organ_mm, task.min_organ_path_mm - 0.3);
    EXPECT_NEAR(organ_mm, path.organ_path_mm, 0.8);
    EXPECT_EQ(tissue_at(patient, notch_middle(path, shipped_needle())), "liver_lesion");
    EXPECT_LE(path.length_mm, task.max_path_mm);
  }
}

TEST(Plan, PathsAreSortedDistinctAndDeterministic) {
  const anatomy::VirtualPatient patient = crowded().make();
  const auto a = plan_paths(liver_biopsy(), patient, shipped_needle(), {12, 5});
  const auto b = plan_paths(liver_biopsy(), patient, shipped_needle(), {12, 5});
  const auto c = plan_paths(liver_biopsy(), patient, shipped_needle(), {12, 6});
  ASSERT_TRUE(a && b && c);
  ASSERT_EQ(a->size(), 12u);
  bool differs = false;
  for (std::size_t n = 0; n < a->size(); ++n) {
    EXPECT_EQ((*a)[n].line_P.a, (*b)[n].line_P.a);
    EXPECT_EQ((*a)[n].line_P.b, (*b)[n].line_P.b);
    differs |= (*a)[n].line_P.a != (*c)[n].line_P.a;
    for (std::size_t m = 0; m < n; ++m) {
      EXPECT_LE((*a)[m].cost_mm, (*a)[n].cost_mm);
      EXPECT_GE(((*a)[m].line_P.a - (*a)[n].line_P.a).norm(), 1.0);
    }
  }
  EXPECT_TRUE(differs);
}

TEST(Plan, ManyPathsAreDistinct) {
  const auto paths = plan_paths(liver_biopsy(), crowded().make(), shipped_needle(), {3000, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  EXPECT_EQ(paths->size(), 3000u);
  std::set<std::array<double, 3>> entries;
  for (const PlannedPath& path : *paths) entries.insert({path.line_P.a.x(), path.line_P.a.y(), path.line_P.a.z()});
  EXPECT_EQ(entries.size(), paths->size());
}

TEST(Plan, TargetsDeepLiverWithoutALesion) {
  BoxPatient box = crowded();
  box.lesion_radius_mm = 0.0;
  const anatomy::VirtualPatient patient = box.make();
  const auto paths = plan_paths(liver_biopsy(), patient, shipped_needle(), {10, 2});
  ASSERT_TRUE(paths) << paths.error().text();
  const volume::GridGeometry& geometry = patient.labels.geometry;
  for (const PlannedPath& path : *paths) {
    const Vec3 target = notch_middle(path, shipped_needle());
    double to_vessel = 1e9;
    double to_surface = 1e9;
    for (std::size_t v = 0; v < patient.labels.voxels.size(); ++v) {
      const std::uint8_t id = patient.labels.voxels[v];
      const std::string tissue = id ? patient.label_table.find(id)->tissue : "";
      if (tissue == "liver") continue;
      const volume::Index3 ijk = geometry.index_of(v);
      const double distance = (geometry.centre_mm(ijk) - target).norm();
      (tissue == "vessel" ? to_vessel : to_surface) = std::min(tissue == "vessel" ? to_vessel : to_surface, distance);
    }
    EXPECT_GE(to_surface, 20.0);
    EXPECT_GE(to_vessel, 10.0);
  }
}

TEST(Plan, PatientLiesOnTheBack) {
  BoxPatient box;
  box.lesion_centre_P = {-30.0, 25.0, 0.0};  // 45 mm below the back, 70 mm from the side, 95 mm from the front
  const auto paths = plan_paths(liver_biopsy(), box.make(), shipped_needle(), {50, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) EXPECT_LT(path.line_P.a.y(), 69.0);
}

TEST(Plan, EntriesAvoidTheCutFacesOfTheVolume) {
  BoxPatient box;
  box.half_volume_mm.z() = 30.0;
  const auto paths = plan_paths(liver_biopsy(), box.make(), shipped_needle(), {300, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) EXPECT_LE(std::abs(path.line_P.a.z()), 27.0);
}

std::string error_of(const Task& task, const BoxPatient& box) {
  const auto paths = plan_paths(task, box.make(), shipped_needle());
  return paths ? "no error" : paths.error().text();
}

TEST(Plan, ErrorNamesTheMarginThatLeftNoPath) {
  BoxPatient caged;
  caged.special = [](const Vec3& p) -> std::string {
    const double depth = -BoxPatient::skin_distance(p);
    return depth > 12.5 && depth < 21.5 && std::abs(std::remainder(p.z(), 12.0)) < 4.0 ? "bone" : "";
  };
  EXPECT_NE(error_of(liver_biopsy(), caged).find("the margin of 3 mm to bone"), std::string::npos)
      << error_of(liver_biopsy(), caged);
  Task bold = liver_biopsy();
  for (RiskStructure& risk : bold.risks) risk.margin_mm = 0.5;
  EXPECT_EQ(error_of(bold, caged), "no error");
}

TEST(Plan, ErrorNamesTheConstraintThatLeftNoPath) {
  Task near = liver_biopsy();
  near.max_path_mm = 30.0;
  EXPECT_NE(error_of(near, BoxPatient{}).find("longer than 30 mm"), std::string::npos);

  BoxPatient no_muscle;
  no_muscle.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) > -22.0 ? "adipose" : ""; };
  EXPECT_NE(error_of(liver_biopsy(), no_muscle).find("do not pass through muscle"), std::string::npos);

  BoxPatient shallow;
  shallow.lesion_centre_P = {-30.0, -40.0, 0.0};
  Task deep = liver_biopsy();
  deep.min_organ_path_mm = 50.0;
  deep.max_path_mm = 60.0;
  EXPECT_NE(error_of(deep, shallow).find("pass less than 50 mm of liver"), std::string::npos)
      << error_of(deep, shallow);

  BoxPatient small;  // no liver is 20 mm deep
  small.lesion_radius_mm = 0.0;
  small.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) < -50.0 ? "soft_tissue" : ""; };
  EXPECT_NE(error_of(liver_biopsy(), small).find("deep enough"), std::string::npos);

  BoxPatient none;
  none.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) <= -22.0 ? "soft_tissue" : ""; };
  EXPECT_NE(error_of(liver_biopsy(), none).find("has no liver"), std::string::npos);
}

TEST(Plan, ImpossibleCountIsAUsageError) {
  const anatomy::VirtualPatient patient = BoxPatient{}.make();
  for (const int count : {0, -1, 100001})
    EXPECT_EQ(plan_paths(liver_biopsy(), patient, shipped_needle(), {count}).error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::tasks
