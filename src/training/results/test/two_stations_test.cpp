// Two stations that record the same people and attempts at the same time.
#include <fmt/format.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <thread>

#include "results/attempts_csv.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class TwoStations : public ResultsTest {
 protected:
  void SetUp() override {
    ResultsTest::SetUp();
    if (!repository_) return;
    other_.emplace(open());
  }

  /// Runs `second` on another connection while `first` is written but not committed.
  void run_at_once(const std::function<void(soci::session&)>& first, const std::function<void(Repository&)>& second) {
    std::atomic<bool> is_over{false};
    std::jthread thread;
    const auto written = repository_->database().transaction("x", [&](soci::session& session) {
      first(session);
      thread = std::jthread([&] {
        second(*other_);
        is_over = true;
      });
      wait_for_the_other(is_over);
    });
    ASSERT_TRUE(written) << written.error().text();
    thread.join();
  }

  std::optional<Repository> other_;

 private:
  /// Until the server says that a connection waits for a row of another one. SQLite waits before it reads.
  void wait_for_the_other(const std::atomic<bool>& is_over) {
    if (GetParam() != "postgresql") return;
    Repository watching = open();
    for (int waiting = 0; waiting == 0 && !is_over;)
      ASSERT_TRUE(watching.database().run("x", [&](soci::session& session) {
        session << "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND wait_event_type ="
                   " 'Lock'",
            soci::into(waiting);
      }));
  }
};
TROCAR_BOTH_DATABASES(TwoStations);

void add_directly(soci::session& session, const std::string& id, const std::string& name) {
  const std::string key = name_key(name);
  session << "INSERT INTO people (id, name, name_key, is_expert, is_simulated, course_id, pin_hash, pin_failures,"
             " pin_failed_s, added_s) VALUES (:i, :n, :k, 0, 0, NULL, '', 0, 0, 0)",
      soci::use(id), soci::use(name), soci::use(key);
}

TEST_P(TwoStations, ImportRowsOfTheSameNewPerson) {
  const Person anna = add("Anna");
  put(attempt(anna.id, 50.0));
  const auto file = folder_ / "attempts.csv";
  ASSERT_TRUE(export_attempts(*repository_, {}, file));
  std::string text = attempts_csv(*repository_, {}).value();
  text.replace(text.find("Anna"), 4, "Neue");
  std::ofstream(file) << text.replace(text.find(list_attempts(*repository_, {})->front().id), 32, std::string(32, 'a'));
  const std::string id = make_id();
  Result<ImportedRows> imported;
  run_at_once([&](soci::session& session) { add_directly(session, id, "Neue"); },
              [&](Repository& other) { imported = import_attempts(other, file, kNow); });
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->added, 1);
  EXPECT_EQ(imported->people, 0);
  EXPECT_EQ(find_attempt(*repository_, std::string(32, 'a'))->value().person_id, id);
}

TEST_P(TwoStations, AddTheSamePerson) {
  const std::string id = make_id();
  Result<PersonOfName> found;
  run_at_once([&](soci::session& session) { add_directly(session, id, "Anna"); },
              [&](Repository& other) { found = find_or_add_person(other, {"ANNA"}, kNow); });
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(found->person.id, id);
  EXPECT_FALSE(found->is_added);
  Result<Person> added;
  run_at_once([&](soci::session& session) { add_directly(session, make_id(), "Ben"); },
              [&](Repository& other) { added = add_person(other, {"Ben"}, kNow); });
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().what, "the name is taken");
  const Person eva = add("Eva");
  Status renamed;
  run_at_once([&](soci::session& session) { add_directly(session, make_id(), "Eva Meier"); },
              [&](Repository& other) { renamed = rename_person(other, eva.id, "Eva Meier"); });
  ASSERT_FALSE(renamed);
  EXPECT_EQ(renamed.error().what, "the name is taken");
}

TEST_P(TwoStations, AddPeopleOfTheSameCourse) {
  Result<Person> added;
  run_at_once(
      [&](soci::session& session) {
        session << "INSERT INTO courses (id, name, name_key) VALUES ('c', 'Course', 'course')";
      },
      [&](Repository& other) {
        added = add_person(other, {"Anna", Group::kTrainee, "Course"}, kNow);
      });
  ASSERT_TRUE(added) << added.error().text();
  EXPECT_EQ(list_courses(*repository_)->size(), 1u);
}

TEST_P(TwoStations, RecordTheSameAttemptOnce) {
  const Person anna = add("Anna");
  const AttemptRecord record = attempt(anna.id, 50.0);
  Result<bool> second;
  run_at_once(
      [&](soci::session& session) {
        session << "INSERT INTO cases (task, patient, seed, patient_hash, difficulty) VALUES ('t', 'p', '1', 'h', 0)";
        session << "INSERT INTO attempts (id, person_id, case_id, task, level, operator, station, started_s, state,"
                   " score, is_passed, duration_s, program_version) SELECT :i, :p, id, 't', '', '', '', 0, 1, 50, 0, 1,"
                   " '' FROM cases",
            soci::use(record.attempt.id), soci::use(anna.id);
      },
      [&](Repository& other) { second = record_missing_attempt(other, record, "recording"); });
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_FALSE(*second);
  EXPECT_TRUE(record_missing_attempt(*repository_, attempt(anna.id, 60.0), {}).value());
}

/// The sums of what each station says it has added are right, whoever is first, and people in another order do not
/// end an import.
TEST_P(TwoStations, CountOnlyTheirOwnAdditions) {
  std::vector<AttemptRecord> records;
  for (int n = 0; n < 40; ++n) records.push_back(attempt(add(fmt::format("Person {:02}", n)).id, 50.0));
  ASSERT_TRUE(record_attempts(*repository_, records));
  const std::string text = attempts_csv(*repository_, {}).value();
  const std::size_t header = text.find("\r\n") + 2;
  std::string backwards = text.substr(0, header);
  for (std::size_t end = text.size(); end > header;) {
    const std::size_t begin = text.rfind("\r\n", end - 3) + 2;
    backwards += text.substr(begin, end - begin);
    end = begin;
  }
  std::ofstream(folder_ / "0.csv", std::ios::binary) << text;
  std::ofstream(folder_ / "1.csv", std::ios::binary) << backwards;
  for (const AttemptRecord& record : records) ASSERT_TRUE(delete_person(*repository_, record.attempt.person_id));
  std::vector<Result<ImportedRows>> imported(4);
  {
    std::vector<std::jthread> stations;
    for (std::size_t n = 0; n < imported.size(); ++n)
      stations.emplace_back([&, n] {
        Repository station = open();
        imported[n] = import_attempts(station, folder_ / fmt::format("{}.csv", n % 2), kNow);
      });
  }
  std::int64_t added = 0, people = 0;
  for (const auto& one : imported) {
    ASSERT_TRUE(one) << one.error().text();
    added += one->added;
    people += one->people;
  }
  EXPECT_EQ(added, 40);
  EXPECT_EQ(people, 40);
}

}  // namespace
}  // namespace trocar::results
