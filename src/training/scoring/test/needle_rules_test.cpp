// Rules about the needle's way: level of the entry, bevel, entry zone, distance from a landmark.
#include <gtest/gtest.h>

#include "scoring/test/outcome_support.h"
#include "tasks/fit_to_patient.h"
#include "telemetry/tick_sample.h"

namespace trocar::scoring {
namespace {

using namespace testing;

/// A puncture of the liver; the rib at z from 70 to 80 stands for a vertebra, the liver for the structure of the
/// fibres, the layer "muscle" (id 0) for the dura.
BoxCase make_liver_puncture() {
  BoxCase made = make_puncture();
  made.task.target_tissues = {"liver"};
  made.task.target_step_mm = 5.0;
  made.task.min_organ_path_mm = 0.0;
  made.task.weights = {{"target", 50.0}, {"access", 50.0}};
  return made;
}

bool has_fail(const Outcome& outcome, const std::string& words) {
  return std::ranges::any_of(outcome.fails,
                             [&](const std::string& fail) { return fail.find(words) != std::string::npos; });
}

TEST(HighestEntry, EntryAboveTheStructureFailsWithTheReason) {
  BoxCase made = make_liver_puncture();
  made.task.highest_entry = tasks::EntryLevel{"rib_right_9", "the needle went in too high"};
  const auto at_height = [&](double z_mm) { return made.score(make_attempt({{50.0, 0.0, z_mm}, {50.0, 51.0, z_mm}})); };
  EXPECT_FALSE(has_fail(at_height(50.0), "too high"));
  EXPECT_FALSE(has_fail(at_height(74.0), "too high")) << "the rib's middle is at 75";
  EXPECT_TRUE(has_fail(at_height(76.0), "the needle went in too high"));
  const Outcome high = at_height(90.0);
  EXPECT_TRUE(has_fail(high, "the needle went in too high"));
  EXPECT_FALSE(high.is_passed);
  ASSERT_FALSE(high.hints.empty());
  EXPECT_EQ(high.hints[0].text.rfind("The needle went in too high: ", 0), 0U) << high.hints[0].text;
  EXPECT_TRUE(high.hints[0].at_s);
  made.task.highest_entry->above = "vertebrae_L2";  // not labelled: not judged
  EXPECT_FALSE(has_fail(at_height(90.0), "too high"));
}

TEST(Bevel, IsJudgedAtThePunctureOfItsLayer) {
  BoxCase made = make_liver_puncture();
  made.task.bevel = tasks::BevelRule{"muscle", "liver", 30.0};
  made.task.weights = {{"target", 60.0}, {"bevel", 40.0}};
  Attempt attempt = make_attempt(make_box_plan().line_P);
  const ScorePart none = part(made.score(attempt), "bevel");
  EXPECT_FALSE(none.is_judged) << "the layer was not punctured";
  EXPECT_EQ(none.points, 0.0);
  EXPECT_EQ(part_value_text(none), "not judged");
  const auto points_at = [&](double turned_deg) {
    const double turned_rad = radians(turned_deg);
    const Mat3 R_PN = tasks::needle_rotation(Vec3::UnitY(), {std::cos(turned_rad), 0.0, std::sin(turned_rad)});
    const Eigen::Quaterniond q(R_PN);
    for (telemetry::TickSample& sample : attempt.samples) sample.device_rotation_wxyz = {q.w(), q.x(), q.y(), q.z()};
    attempt.samples[attempt.fired].events[0] = {telemetry::EventKind::kPuncture, 0};
    return made.score(attempt);
  };
  EXPECT_NEAR(part(points_at(0.0), "bevel").points, 40.0, 1e-6);
  EXPECT_NEAR(part(points_at(30.0), "bevel").points, 20.0, 1e-4);
  const Outcome across = points_at(90.0);
  EXPECT_NEAR(part(across, "bevel").points, 4.0, 1e-4);
  EXPECT_NEAR(part(across, "bevel").value, 90.0, 1e-3);
  EXPECT_TRUE(has_hint(across, "turn the needle about its axis"));
  EXPECT_FALSE(has_hint(points_at(0.0), "bevel"));
}

TEST(Access, AdvisesTheDirectionToTheEntryZone) {
  BoxCase made = make_liver_puncture();
  made.task.entry_zone = tasks::EntryZone{{50.0, 0.0, 78.0}, 10.0};
  made.task.entry_tolerance_mm = 9.0;
  const Outcome outside = made.score(make_attempt(make_box_plan().line_P));  // 28 mm below the middle of the zone
  EXPECT_NEAR(part(outside, "access").points, 50.0 / (1.0 + 4.0), 0.1);
  EXPECT_TRUE(has_hint(outside,
                       "The insertion point lay 18 mm outside of the entry zone: move the needle 18 mm towards the "
                       "head."));
}

TEST(Access, ATargetNearTheLandmarkCostsPoints) {
  BoxCase made = make_liver_puncture();
  anatomy::VirtualPatient with_hilum = make_box_patient();
  with_hilum.landmarks = {{"hilum", {50.0, 71.0, 50.0}}};
  made.who = &with_hilum;
  made.task.target_away_from = "hilum";
  made.task.target_away_mm = 30.0;
  const Outcome central = made.score(make_attempt(make_box_plan().line_P));  // the tip ends 20 mm before it
  EXPECT_NEAR(part(central, "access").points, 25.0, 0.1);
  EXPECT_TRUE(has_hint(central, "The tip ended 20 mm from the hilum"));
  made.who = &patient();
  EXPECT_NEAR(part(made.score(make_attempt(make_box_plan().line_P)), "access").points, 50.0, 0.1);
}

}  // namespace
}  // namespace trocar::scoring
