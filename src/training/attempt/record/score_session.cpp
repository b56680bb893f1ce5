#include "attempt/record/score_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "metrics/measure_run.h"
#include "storage/session_moments.h"

namespace trocar::attempt {
namespace {

constexpr double kMeasuringShare = 0.8;  ///< Of the time of scoring.

std::vector<metrics::MetricValue> measure(const cases::Case& the_case, const storage::Session& session,
                                          const Progress& progress) {
  metrics::MetricContext context = storage::context_of(session);
  context.task = &the_case.task;
  context.patient = the_case.patient.get();
  context.needle = the_case.needle;
  context.end_s = storage::end_s_of(session, context.task, the_case.needle.is_biopsy);
  context.expert_paths.clear();
  for (const tasks::PlannedPath& path : the_case.expert_paths())
    context.expert_paths.push_back({fmt::format("{}", context.expert_paths.size() + 1), path.line_P});
  metrics::MeasureRun run(std::move(context));
  constexpr std::size_t kReportEvery = 4096;
  const double count = std::max(1.0, static_cast<double>(session.samples.size()));
  std::size_t done = 0;
  storage::walk_moments(session, [&](const metrics::Moment& moment) {
    if (done++ % kReportEvery == 0)
      report(progress, "measuring", std::min(1.0, kMeasuringShare * static_cast<double>(done) / count));
    run.step(moment);
  });
  return run.report();
}

std::optional<double> find_value(const std::vector<metrics::MetricValue>& values, std::string_view name) {
  const auto found = std::ranges::find(values, name, &metrics::MetricValue::name);
  return found != values.end() ? found->value : std::nullopt;
}

}  // namespace

scoring::Outcome score_session(const cases::Case& the_case, const storage::Session& session, const Progress& progress) {
  std::vector<metrics::MetricValue> values = measure(the_case, session, progress);
  report(progress, "scoring", kMeasuringShare);
  const auto visible_percent = find_value(values, "tip_visible");
  scoring::Outcome outcome = scoring::score_attempt(
      {.task = the_case.task,
       .patient = *the_case.patient,
       .tissues = the_case.tissues,
       .needle = the_case.needle,
       .experts = the_case.expert_paths(),
       .samples = session.samples,
       .shots = session.shots,
       .interruptions = session.interruptions,
       .actions = session.actions,
       .xray = session.xray.empty() ? tasks::XrayUse{} : session.xray.back(),
       .has_transducer = !session.transducer.empty() && session.info.plane.has_value(),
       .tip_visible_share = visible_percent ? std::optional(*visible_percent / 100.0) : std::nullopt});
  outcome.measures = std::move(values);
  return outcome;
}

std::vector<PunctureRecord> find_punctures(const storage::SessionInfo& info,
                                           const std::vector<telemetry::TickSample>& samples) {
  std::vector<PunctureRecord> punctures;
  for (const telemetry::TickSample& sample : samples) {
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind != telemetry::EventKind::kPuncture) continue;
      punctures.push_back(
          {info.layer_names.at(event.id), sample.time_s, sample.depth_mm, telemetry::tip_load_n(sample)});
    }
  }
  return punctures;
}

}  // namespace trocar::attempt
