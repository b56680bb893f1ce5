#include "results/people.h"

#include "results_lab.h"

namespace trocar::results {
namespace {

class People : public ResultsTest {};
TROCAR_BOTH_DATABASES(People);

TEST_P(People, AreFoundByNameIgnoringCaseAndBlanks) {
  const Person anna = add("  Anna   Müller ", Group::kExpert, "Radiology 2026");
  EXPECT_EQ(anna.name, "Anna Müller");
  const auto found = get_person_named(*repository_, "anna MüLLER");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->id, anna.id);
  EXPECT_EQ(found->group, Group::kExpert);
  EXPECT_EQ(found->course, "Radiology 2026");
  EXPECT_EQ(found->added, kNow);
  EXPECT_FALSE(found->is_simulated);
  const auto again = add_person(*repository_, {"ANNA Müller"}, kNow);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().exit_status, 2);
  EXPECT_FALSE(get_person_named(*repository_, "Ann"));
}

TEST_P(People, MayHaveAnyName) {
  const std::vector<std::string> names{"Robert'); DROP TABLE people; --",
                                       "<script>alert(1)</script>",
                                       "\"quoted\"",
                                       ":name",
                                       "%",
                                       "名前",
                                       "-",
                                       std::string(100, 'x')};
  for (const std::string& name : names) EXPECT_EQ(add(name).name, name);
  const auto all = list_people(*repository_);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->size(), names.size());
  for (const std::string& name : names) EXPECT_TRUE(get_person_named(*repository_, name)) << name;
}

TEST_P(People, AreRefusedWithoutAUsableName) {
  for (const std::string& name : {std::string(), std::string("   "), std::string(101, 'x'), std::string("a\nb"),
                                  std::string("a\0b", 3), std::string("\xff\xfe"), std::string("a\u202eb")}) {
    const auto refused = add_person(*repository_, {name}, kNow);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().exit_status, 2);
  }
}

TEST_P(People, AreRenamedAndMoved) {
  const Person anna = add("Anna", Group::kTrainee, "A"), ben = add("Ben");
  EXPECT_FALSE(rename_person(*repository_, anna.id, "BEN"));
  ASSERT_TRUE(rename_person(*repository_, anna.id, "anna"));
  ASSERT_TRUE(move_to_course(*repository_, anna.id, "b"));
  ASSERT_TRUE(move_to_course(*repository_, ben.id, "B"));
  ASSERT_TRUE(change_group(*repository_, ben.id, Group::kExpert));
  EXPECT_EQ(get_person_named(*repository_, "Anna")->name, "anna");
  EXPECT_EQ(get_person_named(*repository_, "Ben")->group, Group::kExpert);
  const auto courses = list_courses(*repository_);
  ASSERT_TRUE(courses);
  ASSERT_EQ(courses->size(), 2u);
  EXPECT_EQ((*courses)[1].name, "b");
  EXPECT_EQ((*courses)[1].people, 2);
  EXPECT_FALSE(move_to_course(*repository_, "0", "B"));
}

TEST_P(People, AreDeletedWithAllTheirData) {
  const Person anna = add("Anna", Group::kTrainee, "A"), ben = add("Ben");
  put(attempt(anna.id, 70.0), "bytes");
  put(attempt(anna.id, 80.0));
  put(attempt(ben.id, 90.0));
  const auto counted = count_personal_data(*repository_, anna.id);
  ASSERT_TRUE(counted);
  EXPECT_EQ(counted->attempts, 2);
  EXPECT_EQ(counted->recordings, 1);
  const auto deleted = delete_person(*repository_, anna.id);
  ASSERT_TRUE(deleted) << deleted.error().text();
  EXPECT_EQ(deleted->attempts, 2);
  EXPECT_FALSE(get_person_named(*repository_, "Anna"));
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 1u);
  EXPECT_EQ(metric_samples(*repository_, "liver-biopsy", "path_length")->size(), 1u);
  EXPECT_TRUE(list_courses(*repository_)->empty());
  EXPECT_FALSE(delete_person(*repository_, anna.id));
}

TEST_P(People, AcceptACorrectPin) {
  const Person anna = add("Anna");
  EXPECT_EQ(*check_pin(*repository_, anna.id, "", kNow), PinCheck::kRight);  // none is set
  EXPECT_FALSE(set_pin(*repository_, anna.id, "12a4"));
  ASSERT_TRUE(set_pin(*repository_, anna.id, "2718"));
  EXPECT_TRUE(get_person_named(*repository_, "Anna")->has_pin);
  EXPECT_EQ(*check_pin(*repository_, anna.id, "2719", kNow), PinCheck::kWrong);
  EXPECT_EQ(*check_pin(*repository_, anna.id, "2718", kNow), PinCheck::kRight);
  ASSERT_TRUE(set_pin(*repository_, anna.id, ""));
  EXPECT_FALSE(get_person_named(*repository_, "Anna")->has_pin);
}

TEST_P(People, MustWaitAfterManyWrongPins) {
  const Person anna = add("Anna");
  ASSERT_TRUE(set_pin(*repository_, anna.id, "2718"));
  for (int n = 0; n < kFreePinTries; ++n) ASSERT_EQ(*check_pin(*repository_, anna.id, "0000", kNow), PinCheck::kWrong);
  EXPECT_EQ(*check_pin(*repository_, anna.id, "2718", kNow), PinCheck::kTooManyTries);
  // A clock that was set back must not shorten the wait, nor prolong it for days.
  const Seconds back = kNow - std::chrono::days(3);
  EXPECT_EQ(*check_pin(*repository_, anna.id, "2718", back), PinCheck::kTooManyTries);
  EXPECT_EQ(*check_pin(*repository_, anna.id, "2718", back + std::chrono::seconds(31)), PinCheck::kRight);
}

TEST_P(People, NeedPinsOnlyIfRequired) {
  EXPECT_FALSE(*are_pins_required(*repository_));
  ASSERT_TRUE(require_pins(*repository_, true));
  EXPECT_TRUE(*are_pins_required(*repository_));
  ASSERT_TRUE(require_pins(*repository_, false));
  EXPECT_FALSE(*are_pins_required(*repository_));
}

}  // namespace
}  // namespace trocar::results
