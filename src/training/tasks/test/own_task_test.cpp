// A task that was made for one patient: its file, its target, its entry zone, its expert path.
#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "tasks/assess_path.h"
#include "tasks/plan.h"
#include "tasks/testing/attempt_patient.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/layered_body.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::tasks {
namespace {

using testing::BoxPatient;
using testing::liver_biopsy;
using testing::shipped_needle;
using testing::tasks_folder;

Task changed_task() {
  Task task = liver_biopsy();
  task.title = "A \"hard\" case";
  task.max_path_mm = 123.456789012345;
  task.time_limit_s = 60.0;
  task.risks = {{"", "rib_right_9", 4.0, false, {}}, {"vessel", "", 2.0, true, Harm::kCritical}};
  task.target_label = "lesion";
  task.target_P = Vec3(-30.1, -15.2, 1.0 / 3.0);
  task.entry_zone = EntryZone{{-100.0, 0.0, 0.0}, 25.0};
  task.expert_path = "expert";
  task.exam_shows_needle = true;
  task.ultrasound_engine = "panorama";
  task.guidance = ImagingModality::kXray;
  task.needles = {"biopsy-16g"};
  task.postures = {anatomy::Posture::kSitting, anatomy::Posture::kProne};
  task.posture = anatomy::Posture::kProne;
  task.least_target_ml = 0.25;
  task.confirmed_by = Substance::kBlood;
  task.margin_tolerance_mm = 1.5;
  task.pass_mark = 55.0;
  task.weights = {{"target", 40.0}, {"confirmation", 60.0}};
  task.pain = {{"muscle"}, false};
  task.target_away_from = "hilum of the liver";
  task.target_away_mm = 25.0;
  task.highest_entry = EntryLevel{"vertebrae_L2", "too high"};
  task.bevel = BevelRule{"dura", "csf", 20.0};
  task.levels = {{"easy", "Nothing is harder", 0.0, 0.0, 0.0, 1.0, {}},
                 {"hard", "All is harder", 12.0, 0.4, 60.0, 0.7, {{"lesion_diameter_mm", 0.7}, {"weight_kg", 1.3}}}};
  task.phases = {{"a", "A", "because", {}, {{ConditionKind::kTipIn, 0.0, "liver"}}, 0.25},
                 {"b", "B", "so", {"a"}, {{ConditionKind::kWire, 12.5, {}}, {ConditionKind::kOutside, 0.0, {}}}, 0.0}};
  return task;
}

TEST(OwnTask, FileStoresOnlyDifferencesAndRoundTrips) {
  const TemporaryFolder folder;
  const Task task = changed_task();
  const std::string text = task_to_toml(task, liver_biopsy());
  EXPECT_EQ(text.find("organ"), std::string::npos) << text;
  EXPECT_EQ(text.find("max_posterior_deg"), std::string::npos) << text;
  ASSERT_TRUE(write_file_atomically(folder / kOwnTaskFile, text));
  const auto read = load_task_file(folder / kOwnTaskFile, tasks_folder());
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(*read == task) << text;
  EXPECT_EQ(read->name, "liver-biopsy");
  EXPECT_EQ(read->max_path_mm, task.max_path_mm);
  EXPECT_FALSE(liver_biopsy().exam_shows_needle);
  EXPECT_TRUE(read->exam_shows_needle);
  ASSERT_TRUE(read->target_P);
  EXPECT_EQ(*read->target_P, *task.target_P);
}

TEST(OwnTask, KeepsALandmarkZoneAndALevel) {
  Task task = changed_task();
  task.entry_zone.reset();
  task.landmark_zone = LandmarkZone{"left anterior superior iliac spine", 30.0, 25.5, 20.0};
  const auto hard = at_level(task, "2");
  ASSERT_TRUE(hard) << hard.error().text();
  EXPECT_EQ(hard->level, "hard");
  const auto read = parse_task(task_to_toml(*hard, liver_biopsy()), "own", "task.toml", tasks_folder());
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(*read == *hard) << task_to_toml(*hard, liver_biopsy());
}

TEST(OwnTask, ALevelChangesTimeLimitTolerancesAndBreathingOnly) {
  Task task = changed_task();
  const auto hard = at_level(task, "hard");
  ASSERT_TRUE(hard) << hard.error().text();
  EXPECT_DOUBLE_EQ(hard->time_limit_s, 60.0);
  EXPECT_DOUBLE_EQ(hard->target_tolerance_mm, 0.7 * task.target_tolerance_mm);
  EXPECT_DOUBLE_EQ(hard->margin_tolerance_mm, 0.7 * task.margin_tolerance_mm);
  Task back = *hard;
  back.level.clear();
  back.time_limit_s = task.time_limit_s;
  back.breathing_mm = task.breathing_mm;
  back.target_tolerance_mm = task.target_tolerance_mm;
  back.entry_tolerance_mm = task.entry_tolerance_mm;
  back.angle_tolerance_deg = task.angle_tolerance_deg;
  back.margin_tolerance_mm = task.margin_tolerance_mm;
  EXPECT_TRUE(back == task);
  ASSERT_NE(level_of(*hard), nullptr);
  EXPECT_DOUBLE_EQ(level_of(*hard)->tremor_mm, 0.4);
  EXPECT_EQ(level_of(task), nullptr);
}

TEST(OwnTask, AnUnknownLevelIsRefusedWithTheList) {
  const Task task = changed_task();
  for (const char* name : {"impossible", "0", "3", "-1", ""}) {
    const auto level = at_level(task, name);
    ASSERT_FALSE(level) << name;
    EXPECT_NE(level.error().text().find("1 easy, 2 hard"), std::string::npos) << level.error().text();
  }
  const auto twice = at_level(*at_level(task, "1"), "2");
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().text().find("already"), std::string::npos);
}

TEST(OwnTask, KeepsAnEmptyRiskList) {
  const TemporaryFolder folder;
  Task task = liver_biopsy();
  task.risks.clear();
  ASSERT_TRUE(write_file_atomically(folder / kOwnTaskFile, task_to_toml(task, liver_biopsy())));
  const auto read = load_task_file(folder / kOwnTaskFile, tasks_folder());
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(read->risks.empty());
}

TEST(OwnTask, WeightsThatContradictAreRefused) {
  const auto error_of = [](const std::string& text) {
    const auto task = parse_task("base = \"liver-biopsy\"\n" + text, "own", "task.toml", tasks_folder());
    return task ? std::string("no error") : task.error().text();
  };
  EXPECT_EQ(error_of("[scoring.weights]\ntarget = 60\nrisk = 40\n"), "no error");
  EXPECT_NE(error_of("[scoring.weights]\ntarget = 60\nrisk = 30\n").find("add up to 90"), std::string::npos);
  EXPECT_NE(error_of("[scoring.weights]\ntarget = 60\nrisk = 50\ntime = -10\n").find("time"), std::string::npos);
  EXPECT_NE(error_of("[scoring.weights]\ntarget = 90\nbeauty = 10\n").find("beauty"), std::string::npos);
  EXPECT_NE(error_of("[scoring.weights]\ntarget = 90\ndose = 10\n").find("dose_limit_gycm2"), std::string::npos);
  EXPECT_NE(error_of("[scoring.weights]\ntarget = 90\nconfirmation = 10\n").find("nothing confirms"),
            std::string::npos);
  EXPECT_NE(error_of("[scoring.weights]\ntarget = 90\nbevel = 10\n").find("no rule"), std::string::npos);
  EXPECT_NE(error_of("confirmed_by = \"wine\"\n").find("no substance"), std::string::npos);
  EXPECT_NE(error_of("guidance = \"magic\"\n").find("palpation"), std::string::npos);
}

TEST(OwnTask, RefusesADamagedFileWithItsLocation) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) {
    EXPECT_TRUE(write_file_atomically(folder / kOwnTaskFile, text));
    const auto task = load_task_file(folder / kOwnTaskFile, tasks_folder());
    return task ? std::string("no error") : task.error().text();
  };
  EXPECT_EQ(error_of("base = \"liver-biopsy\"\n"), "no error");
  EXPECT_NE(error_of("base = \"lever-biopsy\"\n").find("known are"), std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[target]\npoint_mm = [1, 2]\n").find("is not a point"),
            std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[entry_zone]\ncentre_mm = [1, 2, 3]\n").find("radius_mm"),
            std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[entry_zone]\nlandmark = \"umbilicus\"\nmedial_mm = 30\nradius_mm = 9\n")
                .find("has no side"),
            std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[path]\ntarget_away_mm = 30\n").find("give both"), std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\nposture = \"standing\"\n").find("left-lateral"), std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[path]\npostures = [\"bent\"]\n").find("bent"), std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\nlevel = \"mad\"\n").find("no level"), std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[[levels]]\nname = \"a\"\n").find("title"), std::string::npos);
  EXPECT_NE(error_of("base = \"liver-biopsy\"\n[target]\npiont_mm = [1, 2, 3]\n").find("did you mean"),
            std::string::npos);
}

TEST(OwnTask, PlansPathsFromTheZoneToThePoint) {
  const anatomy::VirtualPatient patient = BoxPatient{}.make();
  Task task = liver_biopsy();
  task.target_P = Vec3(-45.0, 10.0, 5.0);
  task.entry_zone = EntryZone{{-100.0, 5.0, 5.0}, 12.0};
  const auto paths = plan_paths(task, patient, shipped_needle(), {3, 1});
  ASSERT_TRUE(paths) << paths.error().text();
  for (const PlannedPath& path : *paths) {
    EXPECT_LE((path.line_P.a - task.entry_zone->centre_P).norm(), 12.0);
    const Vec3 notch_P = path.line_P.b + shipped_needle().notch_middle_mm() * path.line_P.direction();
    EXPECT_LT((notch_P - *task.target_P).norm(), 1e-6);
    const PathAssessment assessment = assess_path(task, patient, shipped_needle(), path.line_P);
    EXPECT_TRUE(assessment.findings.empty()) << assessment.findings.front().text;
    EXPECT_NEAR(assessment.path.organ_path_mm, path.organ_path_mm, 0.3);
    EXPECT_NEAR(assessment.path.spare_margin_mm, path.spare_margin_mm, 1e-6);
  }
}

TEST(OwnTask, ZoneWithoutAPathIsNamed) {
  Task task = liver_biopsy();
  task.entry_zone = EntryZone{{-30.0, 70.0, 0.0}, 10.0};  // on the back
  const auto paths = plan_paths(task, BoxPatient{}.make(), shipped_needle(), {});
  ASSERT_FALSE(paths);
  EXPECT_NE(paths.error().text().find("no safe path"), std::string::npos) << paths.error().text();
}

TEST(OwnTask, TargetPointOutsideTheOrganIsRefused) {
  Task task = liver_biopsy();
  task.target_P = Vec3(60.0, 0.0, 0.0);
  const auto paths = plan_paths(task, BoxPatient{}.make(), shipped_needle(), {});
  ASSERT_FALSE(paths);
  EXPECT_NE(paths.error().text().find("target point"), std::string::npos) << paths.error().text();
}

TEST(OwnTask, PointInHealthyTissueIsParenchymal) {
  const anatomy::VirtualPatient patient = BoxPatient{}.make();
  Task task = liver_biopsy();
  EXPECT_FALSE(is_parenchymal(task, patient));
  task.target_P = BoxPatient{}.lesion_centre_P;
  EXPECT_FALSE(is_parenchymal(task, patient));
  task.target_P = Vec3(-60.0, 10.0, 0.0);
  EXPECT_TRUE(is_parenchymal(task, patient));
}

bool has(const PathAssessment& assessment, PathFault fault, const std::string& label = {}) {
  for (const PathFinding& finding : assessment.findings)
    if (finding.fault == fault && finding.label == label) return true;
  return false;
}

TEST(AssessPath, NamesEveryFaultOfADrawnPath) {
  BoxPatient box;
  box.special = [](const Vec3& p) -> std::string {
    if (std::abs(p.x() + 85.0) < 3.0 && std::abs(p.y()) < 6.0) return "bone";
    if (std::abs(p.x() + 60.0) < 3.0 && p.y() > 8.0 && p.y() < 14.0) return "vessel";
    return "";
  };
  const anatomy::VirtualPatient patient = box.make();
  Task task = liver_biopsy();
  const Segment through_bone{{-100.0, 0.0, 0.0}, {-45.0, 0.0, 0.0}};
  PathAssessment assessment = assess_path(task, patient, shipped_needle(), through_bone);
  EXPECT_TRUE(has(assessment, PathFault::kCrosses, "rib"));
  EXPECT_TRUE(has(assessment, PathFault::kOffTarget));
  EXPECT_FALSE(has(assessment, PathFault::kGlancing));
  EXPECT_NEAR(assessment.entry_angle_deg, 0.0, 1.0);

  const Segment past_vessel{{-100.0, 7.0, 0.0}, {-45.0, 7.0, 0.0}};
  task.risks = {{"vessel", "", 5.0, false, {}}};
  assessment = assess_path(task, patient, shipped_needle(), past_vessel);
  ASSERT_TRUE(has(assessment, PathFault::kMargin, "vessel"));
  for (const PathFinding& finding : assessment.findings) {
    if (finding.fault != PathFault::kMargin) continue;
    EXPECT_GT(finding.clearance_mm, 0.0);
    EXPECT_LT(finding.clearance_mm, 3.1);  // the voxels are 2 mm
    EXPECT_NEAR(finding.where_P.x(), -60.0, 4.0);
    EXPECT_NEAR(finding.depth_mm, 40.0, 5.0);
  }

  task.max_path_mm = 40.0;
  task.entry_zone = EntryZone{{0.0, -70.0, 0.0}, 10.0};
  assessment = assess_path(task, patient, shipped_needle(), {{-100.0, 40.0, 0.0}, {-80.0, -20.0, 0.0}});
  EXPECT_TRUE(has(assessment, PathFault::kTooLong));
  EXPECT_TRUE(has(assessment, PathFault::kGlancing));
  EXPECT_TRUE(has(assessment, PathFault::kOutsideZone));
  assessment = assess_path(task, patient, shipped_needle(), {{-80.0, 0.0, 0.0}, {-75.0, 0.0, 0.0}});
  EXPECT_TRUE(has(assessment, PathFault::kNotOnSkin));
  EXPECT_TRUE(has(assessment, PathFault::kOrganPath));
}

TEST(AssessPath, FindsTheSkinAlongALineAndNearAPoint) {
  const anatomy::VirtualPatient patient = BoxPatient{}.make();
  const auto entry = find_skin_entry(patient, {-30.0, 0.0, 0.0}, {-50.0, 0.0, 0.0});
  ASSERT_TRUE(entry);
  EXPECT_NEAR(entry->x(), -100.0, 0.1);
  const auto nearest = find_nearest_skin(patient, {-90.0, 10.0, 5.0});
  ASSERT_TRUE(nearest);
  EXPECT_NEAR((*nearest - Vec3(-100.0, 10.0, 5.0)).norm(), 0.0, 0.5);
  EXPECT_FALSE(find_skin_entry(patient, {-30.0, 0.0, 0.0}, {-30.0, 0.0, 1.0}));  // leaves through the cut face
}

}  // namespace
}  // namespace trocar::tasks
