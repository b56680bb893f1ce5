#pragma once

#include <fmt/format.h>

#include "results/people.h"
#include "results/test/results_lab.h"

namespace trocar::results {

/// A test with people and attempts of made-up scores.
class SmallStudy : public ResultsTest {
 protected:
  Person add_simulated(const std::string& name, Group group) {
    const auto person = add_person(*repository_, {name, group, {}, true}, kNow);
    EXPECT_TRUE(person) << person.error().text();
    return person.value_or(Person{});
  }

  /// An attempt with this score (empty: not scored), a metric "path_length" of 200 − score and two parts of the score.
  void play(const Person& person, std::optional<double> score, const std::string& task = "liver-biopsy",
            State state = State::kFinished) {
    AttemptRecord record = attempt(person.id, score.value_or(0.0), task);
    record.attempt.state = state;
    record.attempt.score = score;
    record.measures.clear();
    record.parts.clear();
    if (score) {
      record.measures = {{"path_length", "mm", 200.0 - *score}, {"of_tomorrow", "1", 5.0}};
      record.parts = {{"targeting", 0.6 * *score, 60.0}, {"time", 0.4 * *score + 0.001 * *score * *score, 40.0}};
    }
    put(record);
  }
};

}  // namespace trocar::results
