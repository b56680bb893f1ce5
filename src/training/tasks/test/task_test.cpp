#include "tasks/task.h"

#include <gtest/gtest.h>

#include "anatomy/known_structures.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "tasks/needle.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::tasks {
namespace {

using testing::BoxPatient;
using testing::liver_biopsy;
using testing::tasks_folder;

bool mentions(const TaskReadiness& readiness, std::string_view text) {
  for (const std::string& reason : readiness.reasons)
    if (reason.find(text) != std::string::npos) return true;
  return false;
}

TEST(Task, ShippedTasksNameKnownTissuesAndNeedles) {
  const auto tasks = load_tasks(tasks_folder());
  ASSERT_TRUE(tasks) << tasks.error().text();
  ASSERT_FALSE(tasks->empty());
  const auto table = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(table);
  const auto known = anatomy::KnownStructures::load(data_dir());
  ASSERT_TRUE(known) << known.error().text();
  for (const Task& task : *tasks) {
    EXPECT_TRUE(load_needle(data_dir() / "needles.toml", task.needle)) << task.name;
    EXPECT_FALSE(task.title.empty());
    for (const RiskStructure& risk : task.risks) {
      const bool is_known =
          risk.tissue.empty() ? known->find(risk.label) != nullptr : table->find_tissue(risk.tissue).has_value();
      EXPECT_TRUE(is_known) << risk.tissue << risk.label;
    }
    for (const std::string& tissue : task.target_tissues) EXPECT_TRUE(table->find_tissue(tissue)) << tissue;
  }
}

TEST(Task, LiverBiopsyPassesTenMillimetresOfLiver) {
  const Task task = liver_biopsy();
  EXPECT_EQ(task.name, "liver-biopsy");
  EXPECT_EQ(task.organ, "liver");
  EXPECT_EQ(task.min_organ_path_mm, 10.0);
  EXPECT_EQ(task.parenchymal_depth_mm, 20.0);
  EXPECT_EQ(task.parenchymal_vessel_mm, 10.0);
  EXPECT_EQ(task.needle, "biopsy-18g-coaxial");
  EXPECT_EQ(task.cores, 2u);
}

TEST(Task, TissueRiskExcludesOrganAndTarget) {
  Task task;
  task.organ = "pancreas";
  task.target_tissues = {"fluid"};
  task.risks = {{"organ", "", 5.0, false, {}}, {"fluid", "", 5.0, false, {}}, {"", "spleen_tip", 5.0, false, {}}};
  EXPECT_EQ(find_risk(task, {1, "pancreas", "organ", {}}), nullptr);
  EXPECT_EQ(find_risk(task, {2, "pancreas_cyst", "fluid", {}}), nullptr);
  EXPECT_EQ(find_risk(task, {3, "adrenal_gland_left", "organ", {}}), &task.risks[0]);
  EXPECT_EQ(find_risk(task, {4, "spleen_tip", "spleen", {}}), &task.risks[2]);
  task.organ = "spleen";
  EXPECT_EQ(find_risk(task, {4, "spleen_tip", "spleen", {}}), &task.risks[2]) << "named by its label";
}

TEST(Task, UnknownNameListsTheKnownOnes) {
  const auto task = load_task(tasks_folder(), "lever-biopsy");
  ASSERT_FALSE(task);
  EXPECT_EQ(task.error().exit_status, 2);
  EXPECT_NE(task.error().advice.find("liver-biopsy"), std::string::npos);
}

TEST(Task, AdvisesForAMissingFolder) {
  const auto tasks = load_tasks("/nonexistent/tasks");
  ASSERT_FALSE(tasks);
  EXPECT_NE(tasks.error().text().find("TROCAR_DATA_DIR"), std::string::npos);
}

TEST(Task, RefusesADamagedTaskWithItsLocation) {
  const std::string good = *read_file(tasks_folder() / "liver-biopsy.toml");
  const TemporaryFolder folder;
  ASSERT_TRUE(std::filesystem::create_directory(folder / "tasks"));
  ASSERT_TRUE(write_file_atomically(folder / kHarmFile, *read_file(tasks_folder().parent_path() / kHarmFile)));
  const auto error_of = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    EXPECT_TRUE(write_file_atomically(folder / "tasks/liver-biopsy.toml", text));
    const auto task = load_task(folder / "tasks", "liver-biopsy");
    return task ? std::string("no error") : task.error().text();
  };
  EXPECT_EQ(error_of("organ", "organ"), "no error");
  EXPECT_NE(error_of("margin_mm = 3.0", "margin_mm = -3.0").find("risks[0].margin_mm"), std::string::npos);
  EXPECT_NE(error_of("margin_mm", "margin").find("did you mean \"margin_mm\""), std::string::npos);
  EXPECT_NE(error_of("tissue = \"bone\"", "penalty = 1").find("liver-biopsy.toml"), std::string::npos);
  EXPECT_NE(error_of("max_path_mm = 140.0", "max_path_mm = \"long\"").find("a number from 10 to 300"),
            std::string::npos);
}

TEST(TaskReadiness, CompletePatientServesTheTask) {
  const auto readiness = check_task(liver_biopsy(), BoxPatient{}.make());
  EXPECT_TRUE(readiness.is_possible);
  EXPECT_FALSE(readiness.is_parenchymal);
  EXPECT_TRUE(mentions(readiness, "vessels are not labelled"));
  EXPECT_TRUE(mentions(readiness, "do not avoid them: bone, cartilage, lung"));
  EXPECT_FALSE(mentions(readiness, "cut by the border"));
}

TEST(TaskReadiness, IsParenchymalWithoutALesion) {
  BoxPatient box;
  box.lesion_radius_mm = 0.0;
  const auto readiness = check_task(liver_biopsy(), box.make());
  EXPECT_TRUE(readiness.is_possible);
  EXPECT_TRUE(readiness.is_parenchymal);
  EXPECT_TRUE(mentions(readiness, "no lesion is labelled"));
}

TEST(TaskReadiness, IsParenchymalWithoutTargetTissue) {
  tasks::Task task = liver_biopsy();
  task.target_tissues.clear();
  const auto readiness = check_task(task, BoxPatient{}.make());
  EXPECT_TRUE(readiness.is_possible);
  EXPECT_TRUE(readiness.is_parenchymal);
  EXPECT_TRUE(mentions(readiness, "the task has no target tissue"));
}

TEST(TaskReadiness, NamesLabelsOfAnotherBodyPart) {
  BoxPatient head;
  head.special = [](const Vec3& p) {
    const double depth_mm = -BoxPatient::skin_distance(p);
    return depth_mm > 30.0 ? "gallbladder" : depth_mm >= 22.0 ? "bone" : "";
  };
  const auto readiness = check_task(liver_biopsy(), head.make());
  EXPECT_FALSE(readiness.is_possible);
  EXPECT_TRUE(mentions(readiness, "(labelled: gallbladder, rib)")) << readiness.reasons.front();
  // What was derived is not what the segmentation shows.
  anatomy::VirtualPatient derived = head.make();
  for (anatomy::Label& label : derived.label_table.labels) label.is_derived = label.name == "gallbladder";
  const auto without = check_task(liver_biopsy(), derived);
  EXPECT_TRUE(mentions(without, "(labelled: rib)")) << without.reasons.front();
}

TEST(TaskReadiness, NamesWhatMakesTheTaskImpossible) {
  BoxPatient no_liver;
  no_liver.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) <= -22.0 ? "soft_tissue" : ""; };
  const auto readiness = check_task(liver_biopsy(), no_liver.make());
  EXPECT_FALSE(readiness.is_possible);
  EXPECT_TRUE(mentions(readiness, "the liver is not labelled: the scan does not show it"));

  BoxPatient no_muscle;
  no_muscle.special = [](const Vec3& p) { return BoxPatient::skin_distance(p) > -22.0 ? "adipose" : ""; };
  EXPECT_TRUE(mentions(check_task(liver_biopsy(), no_muscle.make()), "no muscle"));

  BoxPatient inside_only;  // a volume that nowhere reaches the skin
  inside_only.half_volume_mm = {60.0, 60.0, 50.0};
  EXPECT_TRUE(mentions(check_task(liver_biopsy(), inside_only.make()), "skin's surface"));
}

TEST(TaskReadiness, IgnoresAMissingOptionalRisk) {
  Task task = liver_biopsy();
  task.risks.push_back({"", "epigastric_zone", 2.0, false, {}});
  EXPECT_TRUE(mentions(check_task(task, BoxPatient{}.make()), "epigastric_zone"));
  task.risks.back().is_optional = true;
  EXPECT_FALSE(mentions(check_task(task, BoxPatient{}.make()), "epigastric_zone"));
}

TEST(TaskReadiness, ReportsACutOrgan) {
  BoxPatient cut;
  cut.half_volume_mm.z() = 40.0;
  EXPECT_TRUE(mentions(check_task(liver_biopsy(), cut.make()), "cut by the border"));
}

}  // namespace
}  // namespace trocar::tasks
