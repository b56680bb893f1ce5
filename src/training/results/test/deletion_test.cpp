// What is deleted is in no file of the database any more, while the programs that use it go on.
#include <fmt/format.h>

#include <fstream>

#include "results/accounts.h"
#include "results/questionnaires.h"
#include "results/repository.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class Deletion : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = Repository::open({folder_ / "a.sqlite", {}});
    ASSERT_TRUE(opened) << opened.error().text();
    repository_.emplace(*std::move(opened));
  }
  /// Whether any file of the database has the text.
  bool is_anywhere(const std::string& text) const {
    for (const char* ending : {"", "-wal", "-journal"}) {
      std::ifstream file(folder_ / (std::string("a.sqlite") + ending), std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(file)), {});
      if (bytes.find(text) != std::string::npos) return true;
    }
    return false;
  }
  Person add(const std::string& name, const std::string& course = {}) {
    return add_person(*repository_, {name, Group::kTrainee, course}, Seconds()).value();
  }
  void checkpoint() { ASSERT_TRUE(repository_->database().empty_log(std::chrono::seconds(1)).value()); }

  TemporaryFolder folder_;
  std::optional<Repository> repository_;
};

constexpr const char* kName = "Unmistakable Name";

TEST_F(Deletion, ErasesAPersonFromTheLog) {
  const Person person = add(kName, "Unmistakable Course");
  ASSERT_TRUE(is_anywhere(kName));
  const auto deleted = delete_person(*repository_, person.id);
  ASSERT_TRUE(deleted && deleted->is_erased);
  for (const char* text : {kName, "unmistakable name", "Unmistakable Course", "unmistakable course", person.id.c_str()})
    EXPECT_FALSE(is_anywhere(text)) << text;
}

TEST_F(Deletion, ErasesAPersonFromTheFile) {
  const Person person = add(kName, "Unmistakable Course");
  checkpoint();
  ASSERT_TRUE(delete_person(*repository_, person.id)->is_erased);
  for (const char* text : {kName, "unmistakable name", "Unmistakable Course", "unmistakable course", person.id.c_str()})
    EXPECT_FALSE(is_anywhere(text)) << text;
}

/// Pages that were split and merged by many people before and after.
TEST_F(Deletion, ErasesManyPeopleCompletely) {
  std::vector<Person> people;
  for (int n = 0; n < 600; ++n) people.push_back(add(fmt::format("Person with a name {:04}", (n * 7919) % 10000)));
  for (int n = 0; n < 600; n += 3)
    ASSERT_TRUE(rename_person(*repository_, people[n].id, fmt::format("Renamed person {:04}", n)));
  checkpoint();
  for (std::size_t n = 0; n < people.size(); n += 2) ASSERT_TRUE(delete_person(*repository_, people[n].id));
  for (std::size_t n = 0; n < people.size(); n += 2) {
    EXPECT_FALSE(is_anywhere(people[n].name)) << people[n].name;
    EXPECT_FALSE(is_anywhere(people[n].id)) << people[n].id;
    EXPECT_FALSE(is_anywhere(fmt::format("Renamed person {:04}", n)));
  }
  EXPECT_TRUE(is_anywhere(people[1].name));
}

TEST_F(Deletion, ErasesAccountsAndQuestionnaires) {
  ASSERT_TRUE(add_account(*repository_, "Eva", Role::kAdmin, "hash", Seconds()));
  ASSERT_TRUE(add_account(*repository_, kName, Role::kInstructor, "hash", Seconds()));
  ASSERT_TRUE(remove_account(*repository_, kName));
  EXPECT_FALSE(is_anywhere(kName));
  Form form = default_form();
  form.title = kName;
  const auto added = add_form(*repository_, form, Seconds());
  ASSERT_TRUE(added);
  ASSERT_TRUE(delete_form(*repository_, added->id));
  EXPECT_FALSE(is_anywhere(kName));
}

/// A program that reads an older state needs the log: the data are erased when it has ended.
TEST_F(Deletion, CompletesWhenOtherReadersEnd) {
  const Person person = add(kName);
  auto other = Repository::open({folder_ / "a.sqlite", {}});
  ASSERT_TRUE(other);
  ASSERT_TRUE(other->database().snapshot("x", [&](soci::session& session) {
    int people = 0;
    session << "SELECT count(*) FROM people", soci::into(people);
    ASSERT_TRUE(repository_->database().transaction(
        "x", [&](soci::session& writing) { writing << "DELETE FROM people WHERE id = :i", soci::use(person.id); }));
    EXPECT_FALSE(erase_deleted(*repository_, std::chrono::milliseconds(0)).value());
    EXPECT_TRUE(is_anywhere(kName));
  }));
  EXPECT_TRUE(erase_deleted(*repository_, std::chrono::milliseconds(0)).value());
  EXPECT_FALSE(is_anywhere(kName));
}

TEST_F(Deletion, UpdatesTheIdOfTheLastDeletion) {
  EXPECT_EQ(last_deletion(*repository_).value(), "");
  ASSERT_TRUE(delete_person(*repository_, add("A").id));
  const std::string first = last_deletion(*repository_).value();
  EXPECT_NE(first, "");
  EXPECT_FALSE(delete_person(*repository_, "nobody"));
  EXPECT_EQ(last_deletion(*repository_).value(), first);
  ASSERT_TRUE(delete_person(*repository_, add("B").id));
  EXPECT_NE(last_deletion(*repository_).value(), first);
}

}  // namespace
}  // namespace trocar::results
