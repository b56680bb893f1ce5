#include "results/attempt_json.h"

#include "config/json.h"
#include "learning/history.h"

namespace trocar::results {

using config::Json;
using config::or_null;

Json attempt_json(const Attempt& attempt) {
  const bool is_judged = learning::counts(ending_of(attempt.state));
  return {{"id", attempt.id},
          {"sequence", attempt.sequence},
          {"task", attempt.the_case.task},
          {"patient", attempt.the_case.patient},
          {"difficulty", or_null(attempt.the_case.difficulty)},
          {"level", or_null(attempt.level)},
          {"started_s", attempt.started.time_since_epoch().count()},
          {"state", to_string(attempt.state)},
          {"score", or_null(attempt.score)},
          {"passed", is_judged ? Json(attempt.is_passed) : Json(nullptr)},
          {"duration_s", attempt.duration_s},
          {"station", or_null(attempt.station)}};
}

Json curve_points_json(const LearningCurve& curve) {
  Json points = Json::array();
  for (const CurveAttempt& point : curve.attempts) {
    const Attempt& attempt = point.attempt;
    points.push_back({{"n", points.size() + 1},
                      {"attempt", attempt.id},
                      {"started_s", attempt.started.time_since_epoch().count()},
                      {"patient", attempt.the_case.patient},
                      {"difficulty", or_null(attempt.the_case.difficulty)},
                      {"score", or_null(attempt.score)},
                      {"passed", attempt.is_passed},
                      {"moving_mean", or_null(point.moving_mean)}});
  }
  return points;
}

}  // namespace trocar::results
