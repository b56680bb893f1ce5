#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/files/temporary_folder.h"
#include "results/attempts.h"
#include "results/people.h"

namespace trocar::results {

/// A database in a temporary file, with people and attempts of made-up scores.
class SmallStudy {
 public:
  SmallStudy() : repository_(open()) {}

  Repository& repository() { return repository_; }

  Person add(const std::string& name, Group group, bool is_simulated = false, const std::string& course = {}) {
    const auto person = add_person(repository_, {name, group, course, is_simulated}, Seconds{});
    EXPECT_TRUE(person) << person.error().text();
    return person.value_or(Person{});
  }

  /// An attempt with this score (empty: not scored), a metric "path_length" of 200 − score and two parts of the score.
  void attempt(const Person& person, std::optional<double> score, const std::string& task = "liver-biopsy",
               State state = State::kFinished) {
    AttemptRecord record;
    record.attempt.id = make_id();
    record.attempt.person_id = person.id;
    record.attempt.the_case = {task, "biopsy-1", 1, "hash", 1};
    record.attempt.state = state;
    record.attempt.score = score;
    record.attempt.is_passed = score.value_or(0.0) >= 75.0;
    if (score) {
      record.measures = {{"path_length", "mm", 200.0 - *score}, {"of_tomorrow", "1", 5.0}};
      record.parts = {{"targeting", 0.6 * *score, 60.0}, {"time", 0.4 * *score + 0.001 * *score * *score, 40.0}};
    }
    const auto recorded = record_attempt(repository_, record, {});
    EXPECT_TRUE(recorded) << recorded.error().text();
  }

 private:
  Repository open() {
    auto opened = Repository::open({folder_ / "results.sqlite", {}});
    EXPECT_TRUE(opened) << opened.error().text();
    return std::move(opened).value();
  }

  TemporaryFolder folder_;
  Repository repository_;
};

}  // namespace trocar::results
