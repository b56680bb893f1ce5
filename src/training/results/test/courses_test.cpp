#include "results/notes.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class Courses : public ResultsTest {
 protected:
  std::vector<std::string> names() {
    std::vector<std::string> found;
    for (const Course& course : list_courses(*repository_).value_or(std::vector<Course>()))
      found.push_back(course.name);
    return found;
  }
};
TROCAR_BOTH_DATABASES(Courses);

TEST_P(Courses, AreRenamedWithTheirPeople) {
  const Person anna = add("Anna", Group::kTrainee, "Spring");
  add("Ben", Group::kTrainee, "Autumn");
  EXPECT_FALSE(rename_course(*repository_, "Winter", "W"));
  EXPECT_FALSE(rename_course(*repository_, "Spring", "AUTUMN")) << "another course has it";
  EXPECT_FALSE(rename_course(*repository_, "Spring", " "));
  ASSERT_TRUE(rename_course(*repository_, "spring", "Spring 2026"));
  EXPECT_EQ(find_person(*repository_, anna.id).value()->course, "Spring 2026");
  ASSERT_TRUE(rename_course(*repository_, "Spring 2026", "SPRING 2026")) << "its own name, written differently";
  EXPECT_EQ(names(), (std::vector<std::string>{"Autumn", "SPRING 2026"}));
}

TEST_P(Courses, AreRemovedOnlyWithoutPeople) {
  const Person anna = add("Anna", Group::kTrainee, "Spring");
  EXPECT_EQ(remove_empty_course(*repository_, "Spring").error().exit_status, 2);
  EXPECT_EQ(remove_empty_course(*repository_, "Winter").error().exit_status, 2);
  ASSERT_TRUE(move_to_course(*repository_, anna.id, ""));
  ASSERT_TRUE(remove_empty_course(*repository_, "Spring"));
  EXPECT_TRUE(names().empty());
}

TEST_P(Courses, ChangeAPersonAtomically) {
  const Person anna = add("Anna", Group::kTrainee, "Spring");
  add("Ben");
  EXPECT_FALSE(change_person(*repository_, anna.id, {"ben", Group::kExpert, "Autumn"}));
  EXPECT_FALSE(change_person(*repository_, anna.id, {"Cleo", Group::kExpert, "a\nb"}));
  EXPECT_FALSE(change_person(*repository_, make_id(), {{}, Group::kExpert}));
  Person present = find_person(*repository_, anna.id).value().value();
  EXPECT_EQ(present.name, "Anna");
  EXPECT_EQ(present.group, Group::kTrainee);
  EXPECT_EQ(present.course, "Spring");
  EXPECT_EQ(names(), (std::vector<std::string>{"Spring"}));
  ASSERT_TRUE(change_person(*repository_, anna.id, {"Cleo", Group::kExpert, "Autumn"}));
  present = find_person(*repository_, anna.id).value().value();
  EXPECT_EQ(present.name, "Cleo");
  EXPECT_EQ(present.group, Group::kExpert);
  EXPECT_EQ(present.course, "Autumn");
  ASSERT_TRUE(change_person(*repository_, anna.id, {{}, {}, ""}));
  EXPECT_EQ(find_person(*repository_, anna.id).value()->course, "");
  EXPECT_EQ(find_person(*repository_, anna.id).value()->name, "Cleo");
}

TEST_P(Courses, MovePeopleAtomically) {
  const Person anna = add("Anna"), ben = add("Ben");
  EXPECT_FALSE(move_people(*repository_, {anna.id, make_id()}, "Spring"));
  EXPECT_TRUE(names().empty());
  ASSERT_TRUE(move_people(*repository_, {anna.id, ben.id}, "Spring"));
  EXPECT_EQ(list_courses(*repository_)->front().people, 2);
}

}  // namespace
}  // namespace trocar::results
