#include "results/proficiency.h"

#include <cmath>

#include "results/notes.h"
#include "results/test/small_study.h"

namespace trocar::results {
namespace {

class ProficiencyTest : public SmallStudy {
 protected:
  /// 'p': passed with 90 points, 'w': passed with 70, 'f': failed, 'u': without a result, 'n': never began, 'c': crash.
  void play_all(const Person& person, const std::string& letters, const std::string& level = "exam") {
    for (const char letter : letters) {
      AttemptRecord record = attempt(person.id, letter == 'p' ? 90.0 : letter == 'w' ? 70.0 : 20.0);
      record.attempt.level = level;
      record.attempt.duration_s = 30.0;
      const bool is_scored = letter == 'p' || letter == 'w' || letter == 'f';
      if (!is_scored) record.attempt.score.reset();
      record.attempt.is_passed = letter == 'p' || letter == 'w';
      record.attempt.state = is_scored       ? State::kFinished
                             : letter == 'u' ? State::kUnscored
                             : letter == 'n' ? State::kNeverBegan
                                             : State::kInterrupted;
      record.measures = {{"first_pass_success", "1", letter == 'p' ? 1.0 : 0.0}};
      if (is_scored) record.measures.push_back({"time_to_target", "s", letter == 'p' ? 10.0 : 20.0});
      put(record);
    }
  }
  GroupProficiency trainees(const ProficiencyFilter& filter, const ProficiencyRules& rules = {}) {
    const auto groups = proficiency_of(*repository_, filter, rules);
    EXPECT_TRUE(groups) << groups.error().text();
    return groups && !groups->empty() ? groups->front() : GroupProficiency{};
  }
};
TROCAR_BOTH_DATABASES(ProficiencyTest);

TEST_P(ProficiencyTest, CountsTrialsAndPeopleBelowTheCriterion) {
  play_all(add("Anna"), "fppp");          // 4
  play_all(add("Ben"), "ppupwppp");       // 8: neither an attempt without a result nor a low pass
  play_all(add("Clara"), "npcpfffffff");  // not yet, after 9
  play_all(add("Dora"), "nnc");           // no attempt that counts
  play_all(add("Eva", Group::kExpert), "ppp");
  const auto groups = proficiency_of(*repository_, {"liver-biopsy"});
  ASSERT_TRUE(groups) << groups.error().text();
  ASSERT_EQ(groups->size(), 2u);
  const GroupProficiency& group = groups->front();
  ASSERT_EQ(group.people.size(), 3u);
  EXPECT_EQ(group.people[0].trials, 4u);
  EXPECT_EQ(group.people[1].trials, 8u);
  EXPECT_FALSE(group.people[2].trials);
  EXPECT_EQ(group.people[2].counts.counted(), 9);
  EXPECT_EQ(group.people[2].counts.left_out(), 2);
  EXPECT_EQ(group.trials.people, 3u);
  EXPECT_EQ(group.trials.censored(), 1u);
  EXPECT_EQ(group.trials.median, 8.0);
  EXPECT_DOUBLE_EQ(group.practice_s, 30.0 * (4 + 8 + 11));
  EXPECT_NE(instructor_time_text(group).find("12 min of needle time"), std::string::npos)
      << instructor_time_text(group);
  EXPECT_EQ(groups->back().group, Group::kExpert);
  EXPECT_EQ(groups->back().trials.median, 3.0);
}

TEST_P(ProficiencyTest, MeansWeightEachPersonOnce) {
  play_all(add("Anna"), "p");
  play_all(add("Ben"), "ffffffffu");
  const GroupProficiency group = trainees({"liver-biopsy"});
  EXPECT_DOUBLE_EQ(*group.first_pass_share, 0.5);
  EXPECT_DOUBLE_EQ(*group.people[1].first_pass_share, 0.0);
  EXPECT_DOUBLE_EQ(*group.time_to_target_s, 15.0);
}

TEST_P(ProficiencyTest, FiltersByCaseLevelCourseAndRules) {
  const Person anna = add("Anna", Group::kTrainee, "Spring");
  play_all(anna, "fff", "guided");
  play_all(anna, "wppp", "exam");
  EXPECT_EQ(trainees({"liver-biopsy"}).people[0].trials, 7u);
  EXPECT_EQ(trainees({"liver-biopsy", "", "", "exam"}).people[0].trials, 4u);
  EXPECT_EQ(trainees({"liver-biopsy", "spring", "biopsy-1", "exam"}, {60.0, 3}).people[0].trials, 3u);
  EXPECT_EQ(trainees({"liver-biopsy"}, {90.0, 1}).people[0].trials, 5u);
  EXPECT_TRUE(proficiency_of(*repository_, {"liver-biopsy", "Winter"})->empty());
  EXPECT_TRUE(proficiency_of(*repository_, {"liver-biopsy", "", "biopsy-9"})->empty());
  EXPECT_EQ(proficiency_of(*repository_, {"liver-biopsy"}, {101.0, 3}).error().exit_status, 2);
  EXPECT_EQ(proficiency_of(*repository_, {"liver-biopsy"}, {80.0, 0}).error().exit_status, 2);
}

TEST_P(ProficiencyTest, GroupsSimulatedPeopleSeparately) {
  play_all(add_simulated("Robot", Group::kTrainee), "ppp");
  play_all(add("Anna"), "fff");
  const auto groups = proficiency_of(*repository_, {"liver-biopsy"});
  ASSERT_EQ(groups->size(), 2u);
  EXPECT_FALSE(groups->front().is_simulated);
  EXPECT_FALSE(groups->front().trials.median);
  EXPECT_TRUE(groups->back().is_simulated);
}

TEST_P(ProficiencyTest, AddsTheMinutesOfInstructors) {
  const Person anna = add("Anna"), ben = add("Ben"), clara = add("Clara");
  for (const Person& person : {anna, ben, clara}) play_all(person, "ppp");
  EXPECT_FALSE(trainees({"liver-biopsy"}).instructor_min);
  const Seconds now{};
  ASSERT_TRUE(add_teaching(*repository_, anna.id, "liver-biopsy", 25.0, now));
  ASSERT_TRUE(add_teaching(*repository_, anna.id, "liver-biopsy", 12.5, now));
  ASSERT_TRUE(add_teaching(*repository_, ben.id, "liver-biopsy", 30.0, now));
  ASSERT_TRUE(add_teaching(*repository_, ben.id, "ptcd", 60.0, now));
  const GroupProficiency group = trainees({"liver-biopsy"});
  EXPECT_EQ(group.instructor_min, 67.5);
  EXPECT_EQ(group.taught, 2u);
  EXPECT_EQ(group.people[0].instructor_min, 37.5);
  EXPECT_FALSE(group.people[2].instructor_min);
  EXPECT_NE(instructor_time_text(group).find("nothing was entered for 1 more"), std::string::npos);
  EXPECT_EQ(remove_last_teaching(*repository_, anna.id, "liver-biopsy").value(), 12.5);
  EXPECT_EQ(trainees({"liver-biopsy"}).instructor_min, 55.0);
  ASSERT_TRUE(delete_person(*repository_, ben.id));
  EXPECT_EQ(teaching_minutes(*repository_, "liver-biopsy").value(), (std::map<std::string, double>{{anna.id, 25.0}}));
  EXPECT_TRUE(teaching_minutes(*repository_, "ptcd").value().empty());
}

TEST_P(ProficiencyTest, RefusesImplausibleMinutes) {
  const Person anna = add("Anna");
  for (const double minutes : {0.0, -5.0, 601.0, std::nan(""), HUGE_VAL})
    EXPECT_FALSE(add_teaching(*repository_, anna.id, "liver-biopsy", minutes, {})) << minutes;
  EXPECT_FALSE(add_teaching(*repository_, "nobody", "liver-biopsy", 5.0, {}));
  EXPECT_FALSE(remove_last_teaching(*repository_, anna.id, "liver-biopsy"));
  EXPECT_TRUE(teaching_minutes(*repository_, "liver-biopsy").value().empty());
}

}  // namespace
}  // namespace trocar::results
