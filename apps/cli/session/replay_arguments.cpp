#include "cli/session/replay_arguments.h"

#include <fmt/format.h>

namespace trocar::cli {
namespace {

constexpr const char* kTask = "TASK";

/// Error for a given argument that differs from the session's.
template <class Value>
Status check_same(const NamedOptions& named, const char* option, const Value& value, const Value& recorded) {
  if (!named.has(option) || value == recorded) return {};
  return fail_usage(fmt::format("the session was recorded with {}, not with {}", recorded, value), option,
                    "omit it: a replay takes it from the session");
}

Status check_contradictions(const NamedOptions& named, const cases::CaseOptions& the_case,
                            const attempt::RunOptions& run, const io::PatientSource& source) {
  const storage::SessionInfo& info = run.replayed->info;
  TROCAR_TRY_STATUS(check_same(named, kTask, the_case.task, info.task));
  TROCAR_TRY_STATUS(check_same(named, "--needle", the_case.needle, info.needle));
  if (named.has("--level")) return fail_usage("a replay has the level of its session", "--level", "omit it");
  for (const char* const option : {"--breathing", "--phase"})
    if (named.has(option)) return fail_usage("in a replay the patient breathes as in its session", option, "omit it");
  TROCAR_TRY_STATUS(check_same(named, "--seed", run.seed, info.seed));
  TROCAR_TRY_STATUS(check_same(named, "--rate", run.rate_hz, info.rate_hz));
  const std::string preset = attempt::recorded_preset(info);
  if (!preset.empty()) TROCAR_TRY_STATUS(check_same(named, "--device", run.device, preset));
  if (run.is_other_patient_meant) return {};
  return check_same(named, "--patient-seed", source.seed, info.patient_seed);
}

}  // namespace

void NamedOptions::note(const Command& command) {
  for (const Option& option : command.options())
    if (option.is_given()) names_.insert(option.argument_name().empty() ? option.name() : kTask);
}

Status restore_arguments(const NamedOptions& named, cases::CaseOptions& the_case, attempt::RunOptions& run,
                         io::PatientSource& source) {
  TROCAR_TRY(run.replayed, attempt::load_replayed(run.operator_name));
  if (run.replayed == nullptr) {
    if (run.is_other_patient_meant)
      return fail_usage("only a replay has a recorded patient", "--other-patient", "omit the option");
    if (source.folder_or_name.empty())
      return fail_usage("the patient is missing", "--patient", "name a patient folder or an embedded patient");
    return {};
  }
  TROCAR_TRY_STATUS(check_contradictions(named, the_case, run, source));
  const storage::SessionInfo& info = run.replayed->info;
  if (!named.has("--patient")) source.folder_or_name = info.patient_source;
  if (!named.has("--patient-seed")) source.seed = info.patient_seed;
  the_case.task = info.task;
  the_case.needle = info.needle;
  run.seed = info.seed;
  run.rate_hz = info.rate_hz;
  if (std::string preset = attempt::recorded_preset(info); !preset.empty()) run.device = std::move(preset);
  run.replay_changes = {the_case.overrides, the_case.tissue_file, the_case.profile, run.force_model};
  return {};
}

}  // namespace trocar::cli
