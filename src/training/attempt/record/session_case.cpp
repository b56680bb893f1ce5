#include "attempt/record/session_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "cases/scene_request.h"
#include "core/files/folders.h"
#include "core/result.h"
#include "haptics/force_version.h"
#include "haptics/option_texts.h"
#include "tasks/assess_path.h"
#include "tasks/fit_to_patient.h"
#include "tasks/needle.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view kForceModel = "force_model=";

void set_force_model(std::vector<std::string>& options, const std::string& force_model) {
  std::erase_if(options, [](const std::string& option) { return option.starts_with(kForceModel); });
  options.push_back(std::string(kForceModel) + force_model);
}

/// As in a session of an older program: one table, and the device's preset for the rest.
std::vector<storage::SessionParameters> recorded_parameters(const storage::Session& session) {
  std::vector<storage::SessionParameters> all = session.parameters;
  const storage::SessionInfo& info = session.info;
  if (all.empty() || all.front().tick != 0)
    all.insert(all.begin(), {0, 0.0, {}, {std::string(kForceModel) + info.force_model}, info.tissue_table_toml});
  return all;
}

}  // namespace

Result<std::vector<storage::SessionParameters>> replay_parameters(const storage::Session& session,
                                                                  const ReplayChanges& changes) {
  std::vector<storage::SessionParameters> all = recorded_parameters(session);
  std::string other_table;
  if (!changes.tissue_file.empty() || !changes.profile.empty()) {
    const fs::path file = changes.tissue_file.empty() ? data_dir() / "tissues.toml" : fs::path(changes.tissue_file);
    TROCAR_TRY(const anatomy::TissueTable table, anatomy::load_tissue_table(file, changes.profile));
    other_table = table.to_toml();
  }
  for (storage::SessionParameters& parameters : all) {
    if (!other_table.empty()) parameters.tissue_table_toml = other_table;
    if (!changes.force_model.empty()) set_force_model(parameters.options, changes.force_model);
    TROCAR_TRY(anatomy::TissueTable table,
               anatomy::parse_tissue_table(parameters.tissue_table_toml, "the session's tissue table"));
    for (const std::string& assignment : changes.overrides)
      TROCAR_TRY_STATUS(anatomy::apply_override(table, assignment));
    if (!changes.overrides.empty()) parameters.tissue_table_toml = table.to_toml();
    haptics::HapticOptions options;
    stylus::DeviceCapability device;
    TROCAR_TRY_STATUS(haptics::restore_options(parameters.options, options, device));
  }
  return all;
}

Status check_motion(const storage::Session& session, const anatomy::VirtualPatient& patient) {
  const std::string now = anatomy::motion_hash(patient);
  if (session.info.motion_hash.empty()) return {};
  for (const storage::SessionParameters& parameters : session.parameters) {
    haptics::HapticOptions options;
    stylus::DeviceCapability device;
    TROCAR_TRY_STATUS(haptics::restore_options(parameters.options, options, device));
    TROCAR_TRY_STATUS(motion::check(options.motion));
  }
  const auto has_phase = [](const telemetry::TickSample& sample) {
    return sample.breathing >= 0.0 && sample.breathing <= 1.0 &&
           std::ranges::all_of(sample.drivers, [](double driver) { return std::isfinite(driver); });
  };
  if (!std::ranges::all_of(session.samples, has_phase))
    return fail("a tick has no phase of the patient's motion", "session", "record the attempt again");
  if (session.info.motion_hash == now) return {};
  return fail_usage(
      fmt::format("the patient moved in another way when the session was recorded: hash {} of motion.toml, "
                  "this one has {}",
                  session.info.motion_hash, now.empty() ? "none" : now),
      patient.name, "restore the patient's motion.toml of that time, or add --other-patient");
}

Status check_patient(const storage::Session& session, const anatomy::VirtualPatient& patient) {
  const storage::SessionInfo& info = session.info;
  if (info.patient_hash == patient.content_hash) return check_motion(session, patient);
  return fail_usage(fmt::format("the session was recorded in another patient: content hash {}, this one has {}",
                                info.patient_hash, patient.content_hash),
                    patient.name,
                    fmt::format("name the patient of the session ({}), or add --other-patient", info.patient_source));
}

Result<cases::Case> restore_case(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                 const storage::Session& session, const storage::SessionParameters& first,
                                 bool is_other_patient_meant) {
  if (!is_other_patient_meant) TROCAR_TRY_STATUS(check_patient(session, *patient));
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  const storage::SessionInfo& info = session.info;
  cases::Case restored;
  restored.task_toml = info.task_toml;
  TROCAR_TRY(restored.task, info.task_toml.empty()
                                ? tasks::load_task(data / "tasks", info.task)
                                : tasks::parse_task(info.task_toml, info.task, "the session's task", data / "tasks"));
  TROCAR_TRY(restored.needle, tasks::load_needle(data / "needles.toml", info.needle));
  TROCAR_TRY(restored.tissues, anatomy::parse_tissue_table(first.tissue_table_toml, "the session's tissue table"));
  restored.task = tasks::fit_to_patient(std::move(restored.task), *patient);
  restored.plan = tasks::assess_path(restored.task, *patient, restored.needle, info.plan_P.line_P).path;
  restored.experts = cases::find_experts(restored, *patient);
  TROCAR_TRY(restored.substances, tasks::load_substances(data / "substances.toml"));
  restored.is_parenchymal = info.is_parenchymal;
  restored.patient = std::move(patient);
  return restored;
}

link::SetParameters as_command(const storage::SessionParameters& parameters) {
  haptics::HapticOptions options;
  stylus::DeviceCapability device;  // belongs to the server
  TROCAR_CHECK(haptics::restore_options(parameters.options, options, device).has_value());
  const auto has = [&](std::string_view name) {
    return std::ranges::any_of(parameters.options, [&](const std::string& option) { return option.starts_with(name); });
  };
  link::SetParameters command;
  if (has(kForceModel)) command.force_model = to_string(options.force_model);
  if (has("coupling.stiffness=")) command.coupling_stiffness_n_per_mm = options.coupling.stiffness_n_per_mm;
  if (has("coupling.damping=")) command.coupling_damping_ns_per_mm = options.coupling.damping_ns_per_mm;
  if (has("bending=")) command.has_bending = options.has_bending;
  if (has("motion.")) command.motion = options.motion;
  command.tissues_toml = parameters.tissue_table_toml;
  return command;
}

std::string other_forces_note(const storage::SessionInfo& info) {
  if (info.force_version == haptics::kForceVersion) return {};
  return fmt::format(
      "recorded with version {} of the forces, this program has version {}: forces computed anew differ from the "
      "recorded ones",
      info.force_version, haptics::kForceVersion);
}

Result<devices::RecordedMotion> stylus_motion(const storage::Session& session) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  if (session.samples.empty()) return fail("the session has no ticks", "", "give a recorded session");
  TROCAR_TRY(const tasks::Needle needle, tasks::load_needle(data / "needles.toml", session.info.needle));
  const Pose X_WP = cases::room_in_patient(session.info.plan_P.line_P, needle.length_mm).inverse();
  const Pose X_NS = Pose::translation({0.0, 0.0, -needle.length_mm});
  devices::RecordedMotion motion;
  motion.rate_hz = session.info.rate_hz;
  motion.poses.reserve(session.samples.size());
  for (const telemetry::TickSample& sample : session.samples)
    motion.poses.push_back(X_WP * telemetry::device_pose(sample) * X_NS);
  return motion;
}

}  // namespace trocar::attempt
