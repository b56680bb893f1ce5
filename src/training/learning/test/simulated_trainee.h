#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "core/random.h"
#include "learning/next_exercise.h"
#include "learning/test/example_history.h"

namespace trocar::testing {

/// Someone who follows every recommendation: points = skill + help − difficulty + noise. All numbers [assumed].
struct TraineeModel {
  std::string name;
  double first = 60.0;       ///< Skill at the first attempt at a task, points.
  double best = 95.0;        ///< Skill that practice leads to.
  double pace = 0.1;         ///< Share of the way to `best` that one attempt at the task gains.
  double noise = 6.0;        ///< Standard deviation of the score, points.
  double lost_a_day = 0.0;   ///< Share of what was learned that a day without the task takes away.
  double weak_share = -1.0;  ///< Share of the points of the part `weak_part`; negative: none is weak.
  std::string weak_part = "visibility";
  std::string unscored_task = {};  ///< Attempts at this task end without a result.
  int attempts_a_day = 6;
};

/// What a trainee was recommended and how far it led.
struct LearningRun {
  std::vector<learning::Recommendation> advice;
  std::vector<learning::PastAttempt> history;
  int days = 0;
  bool is_through = false;  ///< Everything was mastered within the attempts.

  std::map<std::string, int> purposes() const {
    std::map<std::string, int> counts;
    for (const auto& one : advice) ++counts[to_string(one.purpose)];
    return counts;
  }
  std::map<std::string, int> exercises() const {
    std::map<std::string, int> counts;
    for (const auto& one : advice)
      if (one.exercise) ++counts[one.exercise->patient + " " + to_string(one.exercise->level)];
    return counts;
  }
  /// The largest number of equal exercises one after the other.
  int longest_row() const {
    int longest = 0, row = 0;
    for (std::size_t n = 0; n < advice.size(); ++n) {
      row = n > 0 && advice[n].exercise && advice[n].exercise == advice[n - 1].exercise ? row + 1 : 1;
      longest = std::max(longest, row);
    }
    return longest;
  }
};

/// Follows the recommendations for so many attempts, or until everything is mastered.
inline LearningRun follow(const TraineeModel& model, const learning::Curriculum& curriculum, int attempts,
                          std::uint64_t seed = 1) {
  LearningRun run;
  Random random(seed);
  std::map<std::string, double> skill;
  std::map<std::string, int> last_day;
  for (int n = 0; n < attempts; ++n) {
    const int today = n / model.attempts_a_day;
    const auto now = day(today) + std::chrono::minutes(10 * (n % model.attempts_a_day));
    run.advice.push_back(learning::next_exercise(run.history, curriculum, now));
    run.days = today + 1;
    const auto& exercise = run.advice.back().exercise;
    if (!exercise) {
      run.is_through = true;
      break;
    }
    auto [known, is_new] = skill.try_emplace(exercise->task, model.first);
    const int away = is_new ? 0 : today - last_day[exercise->task];
    for (int d = 0; d < away; ++d) known->second -= model.lost_a_day * (known->second - model.first);
    last_day[exercise->task] = today;
    const double help = 4.0 * (2 - static_cast<int>(exercise->level)), harder = 2.0 * (exercise->difficulty - 1);
    double share = std::clamp(known->second + help - harder + model.noise * random.normal(), 0.0, 100.0) / 100.0;
    known->second += model.pace * (model.best - known->second);
    learning::PastAttempt one{exercise->task, exercise->patient, 1, exercise->level, now, {}, false, {}};
    if (exercise->task != model.unscored_task) {
      double points = 0.0, most = 0.0;
      for (const auto& [part, weight] : curriculum.find(exercise->task)->part_weights) {
        const bool is_weak = model.weak_share >= 0.0 && part == model.weak_part;
        one.part_shares[part] = is_weak ? model.weak_share : share;
        points += weight * one.part_shares[part];
        most += weight;
      }
      one.score = 100.0 * points / most;
      one.is_passed = *one.score >= 60.0;
    } else {
      one.ending = learning::Ending::kUnscored;
    }
    run.history.push_back(one);
  }
  return run;
}

/// Trainees of the tests.
inline std::vector<TraineeModel> trainee_models() {
  TraineeModel weak{"weak in a small part", 88.0, 96.0, 0.1, 3.0};
  weak.weak_share = 0.2;
  weak.weak_part = "comfort";
  TraineeModel plateau{"plateau", 60.0, 66.0, 0.3, 5.0};
  TraineeModel fast{"fast learner", 90.0, 100.0, 0.4, 3.0};
  TraineeModel slow{"slow learner", 50.0, 95.0, 0.04, 6.0};
  TraineeModel forgetful{"forgetful", 65.0, 95.0, 0.15, 6.0};
  forgetful.lost_a_day = 0.15;
  TraineeModel gives_up{"never fires", 80.0, 95.0, 0.1, 5.0};
  gives_up.unscored_task = "liver-biopsy";
  return {weak, plateau, fast, slow, forgetful, gives_up};
}

}  // namespace trocar::testing
