#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "learning/curriculum.h"
#include "learning/history.h"

namespace trocar::testing {

using namespace std::chrono_literals;

/// Two tasks: "biopsy" with three cases and "tap" with one; mastered with 3 passes of 80 points or a first attempt of
/// 95; intervals 1, 3 and 7 days; 3 attempts in a row; the weakest part over 5 attempts; a plateau over 10.
inline learning::Curriculum example_curriculum() {
  learning::Curriculum curriculum;
  curriculum.rules.intervals_days = {1, 3, 7};
  curriculum.rules.first_score = 95.0;
  curriculum.courses = {
      {"biopsy",
       "Biopsy",
       {{"biopsy-1", 1}, {"biopsy-2", 2}, {"biopsy-3", 3}},
       {{"target", 60.0}, {"visibility", 20.0}, {"time", 20.0}}},
      {"tap", "Tap", {{"tap-1", 1}}, {{"target", 50.0}, {"time", 50.0}}},
  };
  return curriculum;
}

/// Noon of day n of a history.
inline std::chrono::sys_seconds day(int n) {
  return std::chrono::sys_days(std::chrono::year(2026) / 3 / 1) + std::chrono::days(n) + 12h;
}

inline learning::PastAttempt attempt(const std::string& patient, learning::TrainingMode level, int on_day,
                                     double score = 90.0, bool is_passed = true) {
  return {patient.substr(0, patient.find('-')), patient, 1, level, day(on_day), score, is_passed, {}};
}

/// An attempt that ended in the body without a score.
inline learning::PastAttempt unscored(const std::string& patient, learning::TrainingMode level, int on_day) {
  learning::PastAttempt one = attempt(patient, level, on_day);
  one.score.reset();
  one.is_passed = false;
  one.ending = learning::Ending::kUnscored;
  return one;
}

/// The same attempt several times.
inline void add(std::vector<learning::PastAttempt>& history, int count, const learning::PastAttempt& one) {
  history.insert(history.end(), static_cast<std::size_t>(count), one);
}

/// All three levels of a case mastered on a day.
inline void master(std::vector<learning::PastAttempt>& history, const std::string& patient, int on_day) {
  for (const learning::TrainingMode level : learning::kTrainingModes) add(history, 3, attempt(patient, level, on_day));
}

}  // namespace trocar::testing
