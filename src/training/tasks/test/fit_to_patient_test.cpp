// Rules of a task that each patient fills in: an entry zone by a landmark, a finding as target, a level, fibres.
#include "tasks/fit_to_patient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tasks/plan.h"
#include "tasks/testing/attempt_patient.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::tasks {
namespace {

using testing::BoxPatient;

/// A cylinder along z of radius 100 mm: on it, a way over the skin is an arc.
anatomy::VirtualPatient cylinder() {
  anatomy::VirtualPatient patient;
  volume::GridGeometry geometry;
  geometry.size = {121, 121, 61};
  geometry.spacing_mm = Vec3::Constant(2.0);
  geometry.origin_P = {-120.0, -120.0, -60.0};
  patient.labels = volume::LabelGrid(geometry);
  patient.skin_distance_mm = volume::FloatGrid(geometry);
  for (std::size_t n = 0; n < patient.skin_distance_mm.voxels.size(); ++n) {
    const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
    patient.skin_distance_mm.voxels[n] = static_cast<float>(std::hypot(p_P.x(), p_P.y()) - 100.0);
  }
  return patient;
}

/// On the cylinder, by the angle from the front towards the left.
Vec3 on_cylinder(double left_deg, double z_mm) {
  const double angle_rad = radians(left_deg);
  return {100.0 * std::sin(angle_rad), -100.0 * std::cos(angle_rad), z_mm};
}

TEST(EntryZoneByLandmark, IsMeasuredOverTheSkinTowardsMidlineAndHead) {
  anatomy::VirtualPatient patient = cylinder();
  patient.landmarks = {{"left spine", on_cylinder(60.0, -20.0)}, {"right spine", on_cylinder(-60.0, -20.0)}};
  Task task;
  const double arc_deg = degrees(30.0 / 100.0);
  for (const double side : {1.0, -1.0}) {
    task.landmark_zone = LandmarkZone{side > 0.0 ? "left spine" : "right spine", 30.0, 25.0, 20.0};
    const Task fitted = fit_to_patient(task, patient);
    ASSERT_TRUE(fitted.entry_zone);
    EXPECT_LT((fitted.entry_zone->centre_P - on_cylinder(side * (60.0 - arc_deg), 5.0)).norm(), 1.0);
    EXPECT_EQ(fitted.entry_zone->radius_mm, 20.0);
    EXPECT_TRUE(fit_to_patient(fitted, patient) == fitted);
  }
  task.landmark_zone->medial_mm = task.landmark_zone->cranial_mm = 0.0;
  EXPECT_LT((fit_to_patient(task, patient).entry_zone->centre_P - on_cylinder(-60.0, -20.0)).norm(), 0.5);
}

TEST(EntryZoneByLandmark, MissingLandmarkGivesNoZoneAndAWarning) {
  anatomy::VirtualPatient patient = cylinder();
  Task task;
  task.landmark_zone = LandmarkZone{"left spine", 30.0, 30.0, 20.0};
  EXPECT_FALSE(fit_to_patient(task, patient).entry_zone);
  ASSERT_EQ(unserved_rules(task, patient).size(), 1U);
  EXPECT_EQ(unserved_rules(task, patient)[0], "there is no landmark \"left spine\": the entry is not judged");
  patient.landmarks = {{"left spine", {0.0, 0.0, 0.0}}};  // far inside the body
  EXPECT_FALSE(fit_to_patient(task, patient).entry_zone);
  patient.landmarks = {{"left spine", on_cylinder(60.0, 50.0)}};  // the skin ends 8 mm above it
  task.landmark_zone->cranial_mm = 100.0;
  EXPECT_FALSE(fit_to_patient(task, patient).entry_zone);
}

TEST(EntryZoneByLandmark, PathsStartInsideIt) {
  anatomy::VirtualPatient patient = BoxPatient{}.make();
  patient.landmarks = {{"right flank", {-100.0, 0.0, 0.0}}};
  Task task = testing::liver_biopsy();
  task.landmark_zone = LandmarkZone{"right flank", 0.0, 20.0, 15.0};
  const Task fitted = fit_to_patient(task, patient);
  const auto paths = plan_paths(fitted, patient, testing::shipped_needle("biopsy-18g"), {5, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) EXPECT_LE((path.line_P.a - Vec3(-100.0, 0.0, 20.0)).norm(), 15.5);
}

TEST(Finding, TargetsTheLesionOfThePatientsPath) {
  anatomy::VirtualPatient patient = testing::make_box_patient();
  Task task = testing::make_box_task();
  task.name = "liver-biopsy";
  const Segment to_lesion_P{{50.0, 0.0, 50.0}, {50.0, 60.0, 50.0}};
  patient.paths = {{"liver-biopsy: lesion 1", to_lesion_P}};
  EXPECT_TRUE(fit_to_patient(task, patient).target_label.empty()) << "it is the only one";
  patient.label_table.labels.push_back({7, "livertumor2", "liver_lesion"});
  EXPECT_EQ(fit_to_patient(task, patient).target_label, "livertumor1");
  patient.paths[0].name = "ptcd: right flank";
  EXPECT_TRUE(fit_to_patient(task, patient).target_label.empty());
  patient.paths[0] = {"liver-biopsy: beside", {to_lesion_P.a, {50.0, 30.0, 50.0}}};  // ends in healthy liver
  EXPECT_TRUE(fit_to_patient(task, patient).target_label.empty());
  patient.paths[0].line_P = to_lesion_P;
  task.target_label = "livertumor2";
  EXPECT_EQ(fit_to_patient(task, patient).target_label, "livertumor2");
}

TEST(TargetDistance, PlannedTargetsKeepAwayFromTheLandmark) {
  BoxPatient box;
  box.lesion_radius_mm = 0.0;
  box.special = [](const Vec3& p) -> std::string {  // a long target along x in the liver
    return std::hypot(p.y() + 15.0, p.z()) < 6.0 && p.x() > -60.0 && p.x() < 10.0 ? "liver_lesion" : "";
  };
  anatomy::VirtualPatient patient = box.make();
  patient.landmarks = {{"hilum", {0.0, -15.0, 0.0}}};
  Task task = testing::liver_biopsy();
  task.target_step_mm = 8.0;
  task.target_away_from = "hilum";
  task.target_away_mm = 30.0;
  Needle needle = testing::shipped_needle("biopsy-18g");
  needle.is_biopsy = false;
  needle.throw_mm = 0.0;
  const auto paths = plan_paths(task, patient, needle, {20, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) EXPECT_GE((path.line_P.b - patient.landmarks[0].p_P).norm(), 30.0);
  task.target_away_mm = 90.0;
  const auto none = plan_paths(task, patient, needle, {1, 1});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("target_away_mm"), std::string::npos) << none.error().text();
}

TEST(Bevel, FibresRunAlongTheirStructure) {
  anatomy::VirtualPatient patient = cylinder();
  patient.label_table.labels = {{1, "dural_sac", "csf", {}}};
  const Vec3 along_P = Vec3(0.2, 0.1, 1.0).normalized();
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const Vec3 p_P = patient.labels.geometry.centre_mm(patient.labels.geometry.index_of(n));
    if ((p_P - p_P.dot(along_P) * along_P).norm() < 8.0) patient.labels.voxels[n] = 1;
  }
  Task task;
  EXPECT_FALSE(find_fibres(task, patient, Vec3::Zero()));
  task.bevel = BevelRule{"dura", "csf", 30.0};
  const auto fibres_P = find_fibres(task, patient, Vec3::Zero());
  ASSERT_TRUE(fibres_P);
  EXPECT_GT(fibres_P->dot(along_P), std::cos(radians(3.0))) << "the box cuts the sac's ends obliquely";
  EXPECT_FALSE(find_fibres(task, patient, {0.0, 80.0, 0.0}));

  const volume::GridGeometry& geometry = patient.labels.geometry;
  const Vec3 top_P = geometry.centre_mm({geometry.size[0] / 2, geometry.size[1] / 2, geometry.size[2] - 1});
  const Vec3 end_P = (top_P.z() / along_P.z()) * along_P;
  const auto at_end_P = find_fibres(task, patient, end_P);
  ASSERT_TRUE(at_end_P) << "the scan ends at the point";
  EXPECT_GT(at_end_P->dot(along_P), std::cos(radians(8.0)));
}

TEST(Bevel, IsTurnedAcrossTheFibresForAnyNeedle) {
  for (int n = 0; n < 200; ++n) {
    const double a = 0.37 * n, b = 1.0 + 0.61 * n;
    const Vec3 axis_P = Vec3(std::sin(a), std::cos(a), std::sin(b)).normalized();
    const Vec3 fibres_P = Vec3(0.3 * std::cos(b), 0.2 * std::sin(a), 1.0).normalized();
    if (std::abs(axis_P.dot(fibres_P)) > 0.99) continue;
    const Mat3 R_PN = needle_rotation(axis_P, bevel_across_fibres_P(axis_P, fibres_P));
    EXPECT_NEAR((R_PN * R_PN.transpose() - Mat3::Identity()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(R_PN.determinant(), 1.0, 1e-12);
    EXPECT_NEAR((R_PN.col(2) - axis_P).norm(), 0.0, 1e-12);
    EXPECT_NEAR(bevel_to_fibres_deg(R_PN, fibres_P), 0.0, 1e-6);
    for (const double turned_deg : {20.0, 90.0, 140.0}) {
      const Mat3 turned = R_PN * Eigen::AngleAxisd(radians(turned_deg), Vec3::UnitZ());
      EXPECT_NEAR(bevel_to_fibres_deg(turned, fibres_P), turned_deg > 90.0 ? 180.0 - turned_deg : turned_deg, 1e-4);
    }
  }
  EXPECT_EQ(bevel_to_fibres_deg(Mat3::Identity(), Vec3::UnitZ()), 0.0) << "the needle runs along the fibres";
}

TEST(AllowedNeedles, AreListedByTheTaskOrOfTheSameUse) {
  std::vector<Needle> all(4);
  const char* const names[] = {"gun-18", "gun-16", "spinal-22", "spinal-25"};
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n].name = names[n];
    all[n].use = n < 2 ? "biopsy" : "spinal";
  }
  Task task;
  task.needle = "spinal-25";
  EXPECT_EQ(allowed_needles(task, all), (std::vector<std::string>{"spinal-25", "spinal-22"}));
  task.needles = {"gun-16", "spinal-25"};
  EXPECT_EQ(allowed_needles(task, all), (std::vector<std::string>{"spinal-25", "gun-16"}));
}

}  // namespace
}  // namespace trocar::tasks
