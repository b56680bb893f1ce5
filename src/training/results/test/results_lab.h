#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "core/files/folders.h"
#include "database/testing/postgres_server.h"
#include "results/attempts.h"

namespace trocar::results {

/// A test with a new, empty database of results, in an SQLite file and on a PostgreSQL server (with least rights).
class ResultsTest : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "postgresql") {
      if (database::testing::PostgresServer::programs().empty()) GTEST_SKIP() << "PostgreSQL is not installed";
      ASSERT_TRUE(server().is_running());
      // The owner makes the tables; all that the tests do then needs no other rights than the writer's.
      const auto roles = server().make_database_with_roles();
      ASSERT_TRUE(roles) << roles.error().text();
      const auto made = Repository::open(roles->owner);
      ASSERT_TRUE(made) << made.error().text();
      owner_url_ = roles->owner;
      url_ = roles->writer;
    } else {
      url_ = {folder_ / "results.sqlite", {}};
    }
    repository_.emplace(open());
  }

  /// Another connection to the same database.
  Repository open() const {
    auto repository = Repository::open(url_);
    EXPECT_TRUE(repository) << repository.error().text();
    return *std::move(repository);
  }

  Person add(const std::string& name, Group group = Group::kTrainee, const std::string& course = {}) {
    const auto person = add_person(*repository_, {name, group, course}, kNow);
    EXPECT_TRUE(person) << person.error().text();
    return person.value_or(Person{});
  }

  static AttemptRecord attempt(const std::string& person_id, double score, const std::string& task = "liver-biopsy") {
    AttemptRecord record;
    record.attempt.id = make_id();
    record.attempt.person_id = person_id;
    record.attempt.the_case = {task, "biopsy-1", 1, "abc", 1};
    record.attempt.level = "guided";
    record.attempt.started = kNow;
    record.attempt.state = State::kFinished;
    record.attempt.score = score;
    record.attempt.is_passed = score >= 60.0;
    record.attempt.duration_s = 31.5;
    record.fails = score >= 60.0 ? std::vector<std::string>() : std::vector<std::string>{"the lung was touched"};
    record.hints = {{"Breathe \"out\"", 3.25}, {"Slower", {}}};
    record.parts = {{"target", 0.3 * score, 30.0}, {"time", 0.7 * score, 70.0}};
    record.measures = {{"path_length", "mm", 100.0 + score}, {"duration", "s", 31.5}};
    record.trace.time_s = {0.0, 0.04};
    record.trace.tip_mm = {{{1.0, 1.5}, {2.0, 2.5}, {-3.0, -3.25}}};
    record.trace.depth_mm = {0.0, 4.5};
    record.trace.force_n = {0.0, -1.234};
    record.trace.tissue = {0, 1};
    record.trace.tissues = {"air", "skin"};
    record.trace.plan_target_mm = {10.0, 20.0, 30.0};
    record.trace.events = {{0.04, "puncture:skin"}};
    return record;
  }
  std::int64_t put(const AttemptRecord& record, std::string_view recording = {}) {
    const auto sequence = record_attempt(*repository_, record, recording);
    EXPECT_TRUE(sequence) << sequence.error().text();
    return sequence.value_or(0);
  }

  static constexpr Seconds kNow{std::chrono::seconds(1'780'000'000)};
  TemporaryFolder folder_;
  database::DatabaseUrl url_, owner_url_;  ///< Of the server's: with the rights of the writer and of the owner.
  std::optional<Repository> repository_;

 private:
  /// One server for all tests of the program; it ends with the program.
  static database::testing::PostgresServer& server() {
    static database::testing::PostgresServer one;
    return one;
  }
};

#define TROCAR_BOTH_DATABASES(Suite)                                               \
  INSTANTIATE_TEST_SUITE_P(Both, Suite, ::testing::Values("sqlite", "postgresql"), \
                           [](const ::testing::TestParamInfo<std::string>& tested) { return tested.param; })

}  // namespace trocar::results
