#include "headless/attempt_record.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "core/version.h"
#include "headless/performer.h"
#include "io/patient_source.h"

namespace trocar {
namespace {

SessionInfo describe(const Case& the_case, const RunOptions& options, const AttemptFacts& facts) {
  SessionInfo info;
  info.program_version = kVersion;
  info.started_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  info.task = the_case.task.name;
  info.patient_name = the_case.patient->name;
  info.patient_source = absolute_source(options.patient_source);
  info.patient_hash = the_case.patient->content_hash;
  info.patient_seed = options.patient_seed;
  info.operator_name = options.operator_name;
  info.force_model = facts.force_model;
  info.seed = options.seed;
  info.rate_hz = facts.rate_hz;
  info.needle = the_case.needle.name;
  info.device = facts.device;
  info.tissue_table_toml = the_case.tissues.to_toml();
  info.plan_P = {the_case.task.name + " plan", the_case.plan.line_P};
  info.is_parenchymal = the_case.is_parenchymal;
  for (const TissueParams& tissue : the_case.tissues.tissues) info.tissue_names.push_back(tissue.name);
  for (const LayerParams& layer : the_case.tissues.layers) info.layer_names.push_back(layer.name);
  info.label_names.resize(256);
  for (const Label& label : the_case.patient->label_table.labels) info.label_names[label.id] = label.name;
  return info;
}

}  // namespace

AttemptRecord::AttemptRecord(const Case& the_case, SessionInfo info, SessionWriter writer, std::size_t expected_ticks)
    : the_case_(&the_case), info_(std::move(info)), writer_(std::move(writer)) {
  samples_.reserve(expected_ticks);
}

Result<AttemptRecord> AttemptRecord::create(const Case& the_case, const RunOptions& options,
                                            const AttemptFacts& facts) {
  SessionInfo info = describe(the_case, options, facts);
  TROCAR_TRY(SessionWriter writer, SessionWriter::create(options.session, info));
  const auto expected_ticks = static_cast<std::size_t>(0.25 * kLongestAttempt_s * facts.rate_hz);
  return AttemptRecord(the_case, std::move(info), std::move(writer), expected_ticks);
}

void AttemptRecord::note(const HandCommand& command) noexcept {
  if (command.has_fired && !fired_) fired_ = samples_.size();
}

Status AttemptRecord::append(const TickSample& sample) {
  samples_.push_back(sample);
  return writer_.append(sample);
}

Status AttemptRecord::append(const TransducerSample& sample) {
  if (transducer_s_ && sample.time_s < *transducer_s_ + kTransducerEvery_s) return {};
  transducer_s_ = sample.time_s;
  return writer_.append(sample);
}

Result<RunResult> AttemptRecord::finish() {
  RunResult result;
  result.outcome = score_attempt(the_case_->task, *the_case_->patient, the_case_->tissues, the_case_->needle,
                                 the_case_->plan, samples_, fired_);
  TROCAR_TRY_STATUS(writer_.finish(result.outcome, fired_));
  result.punctures = find_punctures(info_, samples_);
  result.ticks = samples_.size();
  result.simulated_s = samples_.empty() ? 0.0 : samples_.back().time_s;
  return result;
}

}  // namespace trocar
