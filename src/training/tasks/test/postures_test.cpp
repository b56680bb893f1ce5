#include <gtest/gtest.h>

#include "anatomy/patient.h"
#include "core/files/folders.h"
#include "tasks/assess_path.h"
#include "tasks/fit_to_patient.h"
#include "tasks/plan.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::tasks {
namespace {

using anatomy::Posture;
using testing::BoxPatient;
using testing::liver_biopsy;
using testing::shipped_needle;

/// Bone below the skin everywhere but at the back: the only way is from there.
anatomy::VirtualPatient open_at_the_back() {
  BoxPatient box;
  box.special = [](const Vec3& p) -> std::string {
    const double depth = -BoxPatient::skin_distance(p);
    return depth > 12.5 && depth < 21.5 && p.y() < 47.0 ? "bone" : "";
  };
  return box.make();
}

TEST(Postures, UseOnlyTheChosenOne) {
  const anatomy::VirtualPatient patient = BoxPatient{}.make();
  Task task = liver_biopsy();
  EXPECT_EQ(postures_to_try(task, patient), std::vector{Posture::kSupine});
  task.postures = {Posture::kSitting, Posture::kProne};
  EXPECT_EQ(postures_to_try(task, patient), (std::vector{Posture::kSitting, Posture::kProne}));
  EXPECT_EQ(posture_of(task, patient), Posture::kSitting);
  task.posture = Posture::kLeftLateral;
  EXPECT_EQ(postures_to_try(task, patient), std::vector{Posture::kLeftLateral});
}

TEST(Postures, TryThePatientsOwnFirst) {
  anatomy::VirtualPatient patient = BoxPatient{}.make();
  patient.posture = Posture::kSitting;
  Task task = liver_biopsy();
  task.postures = {Posture::kLeftLateral, Posture::kProne, Posture::kSitting};
  EXPECT_EQ(postures_to_try(task, patient), (std::vector{Posture::kSitting, Posture::kLeftLateral, Posture::kProne}));
}

TEST(Postures, UseTheFirstWithAPath) {
  const anatomy::VirtualPatient patient = open_at_the_back();
  Task task = liver_biopsy();
  ASSERT_FALSE(plan_paths(task, patient, shipped_needle()));
  task.postures = {Posture::kSupine, Posture::kProne, Posture::kSitting};
  const auto paths = plan_paths(task, patient, shipped_needle(), {3, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) {
    EXPECT_EQ(path.posture, Posture::kProne);
    EXPECT_GT(path.line_P.a.y(), 65.0);
  }
  const TaskReadiness readiness = check_task_and_paths(task, patient, shipped_needle());
  EXPECT_TRUE(readiness.is_possible);
  EXPECT_EQ(readiness.posture, Posture::kProne);
  EXPECT_NE(readiness.reasons.back().find("lying on the belly"), std::string::npos);
  // Its score follows the same posture.
  Task planned = task;
  planned.posture = paths->front().posture;
  EXPECT_TRUE(assess_path(planned, patient, shipped_needle(), paths->front().line_P).findings.empty());
  planned.posture = Posture::kSupine;
  EXPECT_FALSE(assess_path(planned, patient, shipped_needle(), paths->front().line_P).findings.empty());
}

TEST(Postures, RefusalNamesEachWithItsObstacle) {
  const anatomy::VirtualPatient patient = open_at_the_back();
  Task task = liver_biopsy();
  task.postures = {Posture::kSupine};
  const auto supine = plan_paths(task, patient, shipped_needle());
  ASSERT_FALSE(supine);
  EXPECT_NE(supine.error().what.find("with the patient lying on the back"), std::string::npos) << supine.error().text();
  EXPECT_NE(supine.error().what.find("start where the skin faces down"), std::string::npos) << supine.error().text();
  EXPECT_NE(supine.error().advice.find("--posture"), std::string::npos) << supine.error().text();
  task.postures = {Posture::kSupine, Posture::kProne};
  task.max_path_mm = 20.0;
  const auto both = plan_paths(task, patient, shipped_needle());
  ASSERT_FALSE(both);
  for (const char* words : {"lying on the back", "lying on the belly", "are longer than 20 mm"})
    EXPECT_NE(both.error().what.find(words), std::string::npos) << both.error().text();
}

TEST(LeastTarget, AppliesToOneConnectedPiece) {
  BoxPatient box;
  const auto has_paths = [&](double least_ml) {
    Task task = liver_biopsy();
    task.least_target_ml = least_ml;
    const anatomy::VirtualPatient patient = box.make();
    const bool is_possible = check_task(task, patient).is_possible;
    EXPECT_EQ(is_possible, plan_paths(task, patient, shipped_needle()).has_value());
    return is_possible;
  };
  // A ball of 8 mm: 2.1 ml.
  EXPECT_TRUE(has_paths(2.0));
  EXPECT_FALSE(has_paths(2.3));
  box.lesion_radius_mm = 0.0;  // healthy tissue does for a biopsy, and not where a target is asked for
  EXPECT_TRUE(has_paths(0.0));
  EXPECT_FALSE(has_paths(0.01));
}

TEST(LeastTarget, DoesNotSumSeparatePieces) {
  BoxPatient box;
  box.lesion_radius_mm = 0.0;
  box.special = [](const Vec3& p) -> std::string {
    const Vec3 a = p - Vec3(-30.0, -15.0, -20.0), b = p - Vec3(-30.0, -15.0, 20.0);
    return a.norm() < 8.0 || b.norm() < 8.0 ? "liver_lesion" : "";
  };
  Task task = liver_biopsy();
  task.least_target_ml = 3.0;
  const TaskReadiness readiness = check_task(task, box.make());
  EXPECT_FALSE(readiness.is_possible);
  EXPECT_NE(readiness.reasons.front().find("at most 2 ml in one piece"), std::string::npos)
      << readiness.reasons.front();
}

TEST(ShippedTasks, ExcludeSupineLumbarPunctureAndRequireDuctsForPtcd) {
  const Task lumbar = *load_task(data_dir() / "tasks", "lumbar-puncture");
  ASSERT_FALSE(lumbar.postures.empty());
  EXPECT_EQ(lumbar.postures.front(), Posture::kLeftLateral);
  EXPECT_EQ(std::ranges::count(lumbar.postures, Posture::kSupine), 0);
  const Task ptcd = *load_task(data_dir() / "tasks", "ptcd");
  const TaskReadiness readiness = check_task(ptcd, BoxPatient{}.make());
  EXPECT_FALSE(readiness.is_possible);
  EXPECT_NE(readiness.reasons.front().find("no bile_duct is labelled"), std::string::npos) << readiness.reasons.front();
}

}  // namespace
}  // namespace trocar::tasks
