#include "attempt/record/attempt_record.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "anatomy/tissue/tissue_settings.h"
#include "attempt/record/score_session.h"
#include "core/version.h"
#include "haptics/force_version.h"
#include "io/patient/patient_folder.h"
#include "signing/token.h"
#include "telemetry/tick_sample.h"
#include "xray/tools/tool_shape.h"

namespace trocar::attempt {

storage::SessionInfo identify(const cases::Case& the_case, const AttemptIdentity& identity) {
  storage::SessionInfo info;
  info.program_version = kVersion;
  info.attempt_id = identity.attempt_id.empty() ? signing::make_id() : identity.attempt_id;
  info.person_id = identity.person_id;
  info.operator_name = identity.operator_name;
  info.level = identity.level;
  info.task = the_case.task.name;
  info.task_toml = the_case.task_toml;
  info.needle = the_case.needle.name;
  info.patient_name = the_case.patient->name;
  info.patient_source = io::absolute_source(identity.patient_source);
  info.patient_hash = the_case.patient->content_hash;
  info.motion_hash = anatomy::motion_hash(*the_case.patient);
  info.patient_seed = identity.patient_seed;
  info.seed = identity.seed;
  return info;
}

namespace {

constexpr double kMostReserved = 4e6;  // ticks: a server tells its rate

storage::SessionInfo describe(const cases::Case& the_case, const RecordOptions& options, const AttemptFacts& facts) {
  storage::SessionInfo info = identify(the_case, options);
  info.started_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  info.force_model = facts.force_model;
  info.force_version = haptics::kForceVersion;
  info.rate_hz = facts.rate_hz;
  info.device = facts.device;
  info.device_preset = facts.device_preset;
  const std::string& table = facts.parameters.tissue_table_toml;
  info.tissue_table_toml = table.empty() ? the_case.tissues.to_toml() : table;
  info.plan_P = {the_case.task.name + " plan", the_case.plan.line_P};
  info.is_parenchymal = the_case.is_parenchymal;
  for (const anatomy::TissueParams& tissue : the_case.tissues.tissues) info.tissue_names.push_back(tissue.name);
  for (const anatomy::LayerParams& layer : the_case.tissues.layers) info.layer_names.push_back(layer.name);
  info.label_names.resize(256);
  for (const anatomy::Label& label : the_case.patient->label_table.labels) info.label_names[label.id] = label.name;
  return info;
}

/// Differences from `before`: numbers of tissues, then options.
std::vector<std::string> changed(const anatomy::TissueTable& before, const std::vector<std::string>& options_before,
                                 const anatomy::TissueTable& now, const std::vector<std::string>& options) {
  std::vector<std::string> settings = anatomy::changed_settings(before, now);
  for (const std::string& option : options)
    if (std::ranges::find(options_before, option) == options_before.end()) settings.push_back(option);
  return settings;
}

std::string force_model_of(const SceneParameters& parameters, const std::string& otherwise) {
  constexpr std::string_view kForceModel = "force_model=";
  for (const std::string& option : parameters.options)
    if (option.starts_with(kForceModel)) return option.substr(kForceModel.size());
  return otherwise;
}

}  // namespace

std::string preset_of_device(std::string_view device_name) {
  constexpr std::string_view kVirtual = "virtual:";
  return device_name.starts_with(kVirtual) ? std::string(device_name.substr(kVirtual.size())) : std::string();
}

AttemptRecord::AttemptRecord(const cases::Case& the_case, storage::SessionInfo info, storage::SessionWriter writer,
                             std::size_t expected_ticks)
    : the_case_(&the_case), writer_(std::move(writer)) {
  session_.info = std::move(info);
  try {
    session_.samples.reserve(expected_ticks);
  } catch (const std::bad_alloc&) {
    // the address space is limited: the vector grows with its ticks
  }
}

Result<AttemptRecord> AttemptRecord::create(const cases::Case& the_case, const RecordOptions& options,
                                            const AttemptFacts& facts) {
  storage::SessionInfo info = describe(the_case, options, facts);
  info.plane = options.plane;
  TROCAR_TRY(storage::SessionWriter writer, storage::SessionWriter::create(options.session, info));
  const auto expected_ticks =
      static_cast<std::size_t>(std::clamp(options.longest_s * facts.rate_hz, 0.0, kMostReserved));
  return AttemptRecord(the_case, std::move(info), std::move(writer), expected_ticks);
}

void AttemptRecord::note(const tasks::HandCommand& command) noexcept {
  wanted_action_ = command.action;
}

Status AttemptRecord::append(const telemetry::TickSample& sample) {
  session_.samples.push_back(sample);
  TROCAR_TRY_STATUS(written(writer_.append(sample)));
  if (!wanted_action_) return {};
  TROCAR_TRY([[maybe_unused]] const auto action, act(*std::exchange(wanted_action_, std::nullopt)));
  return {};
}

/// A gun is fired if it is loaded, and loaded outside the body or through a coaxial needle.
bool AttemptRecord::is_possible(tasks::ActionKind kind, double depth_mm) const noexcept {
  const tasks::Needle& needle = the_case_->needle;
  const bool is_loaded = tasks::is_gun_loaded(session_.actions);
  if (kind == tasks::ActionKind::kFire) return needle.is_biopsy && is_loaded;
  if (kind == tasks::ActionKind::kLoad)
    return needle.is_biopsy && !is_loaded && (needle.is_coaxial || !(depth_mm > 0.0));
  return true;
}

Result<std::optional<tasks::Action>> AttemptRecord::act(const tasks::ActionRequest& request) {
  constexpr double kLater_s = 1e-6;  // two actions of one tick have an order
  if (session_.samples.empty()) return std::optional<tasks::Action>();
  const telemetry::TickSample& sample = session_.samples.back();
  if (!is_possible(request.kind, sample.depth_mm)) return std::optional<tasks::Action>();
  tasks::Action action{sample.time_s, request.kind, request.amount, {}, sample.rest_tip_mm, sample.depth_mm};
  if (!session_.actions.empty()) action.time_s = std::max(action.time_s, session_.actions.back().time_s + kLater_s);
  if (request.kind == tasks::ActionKind::kDrawStylet || request.kind == tasks::ActionKind::kAspirate)
    action.result = tasks::what_returns(the_case_->substances, *the_case_->patient, the_case_->needle,
                                        telemetry::pierced_rest_tip_mm(sample), sample.rest_axis,
                                        request.kind == tasks::ActionKind::kAspirate);
  if (request.kind == tasks::ActionKind::kAdvanceWire) action.amount = wire_way_mm(sample, request.amount);
  TROCAR_TRY_STATUS(append(action));
  return std::optional<tasks::Action>(action);
}

/// A wire goes no further than the duct: it stops at an obstruction, and buckles outside of any duct.
double AttemptRecord::wire_way_mm(const telemetry::TickSample& sample, double wanted_mm) const {
  if (the_case_->ducts == nullptr) return wanted_mm;
  const std::vector<Vec3> way_P =
      xray::guide_wire_way(*the_case_->ducts, telemetry::pierced_rest_tip_mm(sample), sample.rest_axis, wanted_mm);
  double way_mm = 0.0;
  for (std::size_t n = 1; n < way_P.size(); ++n) way_mm += (way_P[n] - way_P[n - 1]).norm();
  return way_mm;
}

Status AttemptRecord::append(const tasks::Action& action) {
  session_.actions.push_back(action);
  if (action.kind == tasks::ActionKind::kFire) session_.shots.push_back(session_.samples.size() - 1);
  return written(writer_.append(action));
}

Status AttemptRecord::written(Status status) {
  if (!status && !write_failure_) write_failure_ = status.error();
  return status;
}

Status AttemptRecord::note_parameters(const SceneParameters& parameters) {
  return record(session_.samples.size() - 1, parameters);
}

Status AttemptRecord::note_scene(std::uint64_t number, const KnownScenes& known) {
  while (!unknown_.empty()) {
    const SceneParameters* told = known.find(unknown_.front().number);
    if (told == nullptr) break;
    TROCAR_TRY_STATUS(record(unknown_.front().tick, *told));
    unknown_.erase(unknown_.begin());
  }
  if (number == scene_) return {};
  scene_ = number;
  const SceneParameters* told = known.find(number);
  if (told != nullptr && unknown_.empty()) return note_parameters(*told);
  unknown_.push_back({session_.samples.size() - 1, number});
  return {};
}

void AttemptRecord::forget_scenes() noexcept {
  has_lost_scene_ = has_lost_scene_ || !unknown_.empty();
  unknown_.clear();
  scene_ = 0;
}

Status AttemptRecord::record(std::size_t tick, const SceneParameters& parameters) {
  const bool is_same = tissues_ && parameters.options == parameters_.options &&
                       parameters.tissue_table_toml == parameters_.tissue_table_toml;
  if (is_same) return {};
  TROCAR_TRY(anatomy::TissueTable table,
             anatomy::parse_tissue_table(parameters.tissue_table_toml, "the parameters in force"));
  storage::SessionParameters row{
      tick, session_.samples[tick].time_s, {}, parameters.options, parameters.tissue_table_toml};
  row.settings =
      tissues_ ? changed(*tissues_, parameters_.options, table, parameters.options) : anatomy::user_settings(table);
  if (!tissues_) session_.info.force_model = force_model_of(parameters, session_.info.force_model);
  tissues_ = std::move(table);
  parameters_ = parameters;
  session_.parameters.push_back(std::move(row));
  return written(writer_.append(session_.parameters.back()));
}

Status AttemptRecord::append(const tasks::Interruption& interruption) {
  session_.interruptions.push_back(interruption);
  return written(writer_.append(interruption));
}

Status AttemptRecord::append(const storage::TransducerSample& sample) {
  if (!session_.transducer.empty() && sample.time_s < session_.transducer.back().time_s + kTransducerEvery_s) return {};
  session_.transducer.push_back(sample);
  return written(writer_.append(sample));
}

Status AttemptRecord::append(const telemetry::NeedleShape& shape) {
  const telemetry::NeedleShape& last = session_.shapes.empty() ? telemetry::NeedleShape{} : session_.shapes.back();
  if (telemetry::largest_difference_mm(shape, last) <= kShapeStep_mm) return {};
  session_.shapes.push_back(shape);
  return written(writer_.append(shape));
}

Status AttemptRecord::append(const tasks::XrayUse& use) {
  tasks::XrayUse last = session_.xray.empty() ? tasks::XrayUse{} : session_.xray.back();
  last.time_s = use.time_s;
  if (use == last) return {};
  session_.xray.push_back(use);
  return written(writer_.append(use));
}

RunResult AttemptRecord::score(const Progress& progress) {
  RunResult result;
  result.outcome = score_session(*the_case_, session_, progress);
  result.punctures = find_punctures(session_.info, session_.samples);
  result.force_model = session_.info.force_model;
  result.ticks = session_.samples.size();
  result.simulated_s = session_.samples.empty() ? 0.0 : session_.samples.back().time_s;
  result.active_s = tasks::active_time_s(0.0, result.simulated_s, session_.interruptions);
  if (has_lost_scene_ || !unknown_.empty())
    result.warnings.emplace_back(
        "the server did not report the parameters of some ticks: a change is missing in the session");
  if (std::string note = writer_.note(); !note.empty()) result.warnings.push_back(std::move(note));
  return result;
}

Result<RunResult> AttemptRecord::finish(const Progress& progress) {
  RunResult result = score(progress);
  report(progress, "closing the recording", 1.0);
  TROCAR_TRY_STATUS(written(writer_.finish(result.outcome, session_.shots)));
  result.ticks_hash = writer_.ticks_hash();
  return result;
}

RunResult AttemptRecord::finish_unsaved(const Progress& progress) {
  RunResult result = score(progress);
  const std::size_t saved = std::min(writer_.saved_ticks(), session_.samples.size());
  const double saved_s = saved > 0 ? session_.samples[saved - 1].time_s : 0.0;
  const Error failure = write_failure_.value_or(Error{});
  result.cut_short = fmt::format(
      "The recording ended after {:.1f} s: {} ({}). The score counts all of it; the file holds the first "
      "{:.1f} s and no score",
      result.simulated_s, failure.what, failure.where, saved_s);
  result.warnings.push_back(result.cut_short);
  session_.outcome = result.outcome;
  session_.is_incomplete = true;
  result.unsaved = std::move(session_);
  return result;
}

}  // namespace trocar::attempt
