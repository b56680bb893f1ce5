#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "tasks/assess_path.h"
#include "tasks/plan.h"
#include "tasks/testing/box_patient.h"

namespace trocar::tasks {
namespace {

using testing::BoxPatient;

TEST(Readiness, AgreesWithThePlanner) {
  const Task task = *load_task(data_dir() / "tasks", "liver-biopsy");
  const Needle needle = *load_needle(data_dir() / "needles.toml", task.needle);
  BoxPatient caged;  // bones without a gap for a needle
  caged.special = [](const Vec3& p) -> std::string {
    const double depth = -BoxPatient::skin_distance(p);
    return depth > 12.5 && depth < 21.5 && std::abs(std::remainder(p.z(), 12.0)) < 4.0 ? "bone" : "";
  };
  BoxPatient small;  // no liver is deep enough
  small.lesion_radius_mm = 0.0;
  small.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) < -50.0 ? "soft_tissue" : ""; };
  BoxPatient none;
  none.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) <= -22.0 ? "soft_tissue" : ""; };
  for (const BoxPatient& box : {BoxPatient{}, caged, small, none}) {
    const anatomy::VirtualPatient patient = box.make();
    const TaskReadiness readiness = check_task_and_paths(task, patient, needle);
    const auto paths = plan_paths(task, patient, needle);
    EXPECT_EQ(readiness.is_possible, paths.has_value());
    if (!paths) {
      ASSERT_FALSE(readiness.reasons.empty());
      EXPECT_TRUE(readiness.reasons.back() == paths.error().what || !check_task(task, patient).is_possible);
    }
  }
  // The labels alone do not show that the way is barred.
  EXPECT_TRUE(check_task(task, caged.make()).is_possible);
  EXPECT_FALSE(check_task_and_paths(task, caged.make(), needle).is_possible);
}

}  // namespace
}  // namespace trocar::tasks
