#include "web/api/attempt_json.h"

namespace trocar::web {
namespace {

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? Json(rounded(value)) : Json(nullptr));
  return list;
}

}  // namespace

Json attempt_json(const results::Attempt& attempt) {
  return {{"id", attempt.id},
          {"sequence", attempt.sequence},
          {"task", attempt.the_case.task},
          {"patient", attempt.the_case.patient},
          {"difficulty", attempt.the_case.difficulty ? Json(*attempt.the_case.difficulty) : Json(nullptr)},
          {"level", or_null(attempt.level)},
          {"started_s", seconds_of(attempt.started)},
          {"state", results::to_string(attempt.state)},
          {"score", or_null(attempt.score)},
          {"passed", learning::counts(results::ending_of(attempt.state)) ? Json(attempt.is_passed) : Json(nullptr)},
          {"duration_s", rounded(attempt.duration_s)},
          {"station", or_null(attempt.station)}};
}

Json note_json(const results::Note& note) {
  return {{"id", note.id}, {"author", note.author}, {"text", note.text}, {"written_s", seconds_of(note.written)}};
}

Json trace_json(const results::Trace& trace) {
  Json events = Json::array();
  for (const results::Trace::Event& event : trace.events)
    events.push_back({{"time_s", rounded(event.time_s)}, {"text", event.text}});
  return {{"rate_hz", trace.rate_hz},
          {"time_s", numbers(trace.time_s)},
          {"tip_x_mm", numbers(trace.tip_mm[0])},
          {"tip_y_mm", numbers(trace.tip_mm[1])},
          {"tip_z_mm", numbers(trace.tip_mm[2])},
          {"depth_mm", numbers(trace.depth_mm)},
          {"force_n", numbers(trace.force_n)},
          {"tissue", trace.tissue},
          {"tissues", trace.tissues},
          {"plan", {{"entry", trace.plan_entry_mm}, {"target", trace.plan_target_mm}}},
          {"events", std::move(events)}};
}

}  // namespace trocar::web
