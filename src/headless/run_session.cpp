#include "headless/run_session.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "core/data_dir.h"
#include "core/interruption.h"
#include "core/log.h"
#include "core/unfinished_output.h"
#include "haptics/device_preset.h"
#include "haptics/simulation/virtual_device.h"
#include "haptics/tick.h"
#include "headless/attempt_record.h"
#include "headless/needle_geometry.h"
#include "headless/performer.h"
#include "training/hand.h"

namespace trocar {
namespace {

Result<DevicePreset> find_device(const RunOptions& options) {
  const std::filesystem::path data = data_dir();
  if (data.empty()) return fail("the data folder was not found", "", "set TROCAR_DATA_DIR to it");
  return load_device_preset(data / "devices.toml", options.device);
}

/// One step of the device under the operator's hand and the force of the last tick.
void move_device(VirtualDeviceState& device, double mass_kg, const HandCommand& command, const Vec3& force_P,
                 const HapticScene& scene, double dt_s) noexcept {
  if (command.is_rigid) {
    device = {command.X_PN, command.v_P};
    return;
  }
  constexpr HandParams kHand;
  const HandSpring spring = hand_spring(kHand, command);
  const HandHold hold{spring.anchor_P,
                      spring.anchor_velocity_P,
                      spring.stiffness_n_per_mm,
                      spring.damping_ns_per_mm,
                      spring.mass_kg,
                      follow_rotation(kHand, device.X_PN.R(), command.X_PN.R(), dt_s)};
  const VirtualDeviceParams params{mass_kg, scene.device.stylus_weight_n};
  step_device(device, params, hold, force_P, scene.gravity_P, dt_s);
}

/// The closed loop, until the operator is done. Gives how many ticks it took.
Result<std::size_t> perform(const Performer& performer, const HapticScene& scene, double mass_kg, AttemptRecord& record,
                            const Progress& progress) {
  const double dt_s = 1.0 / performer.rate_hz;
  const auto most_ticks = static_cast<std::size_t>(kLongestAttempt_s * performer.rate_hz);
  VirtualDeviceState device;
  HapticState state;
  OperatorView view;
  view.dt_s = dt_s;
  for (std::size_t i = 0; i < most_ticks; ++i) {
    view.time_s = static_cast<double>(i) * dt_s;
    if (is_interrupted()) return tl::unexpected(interruption_error("trocar run"));
    const HandCommand command = performer.the_operator->next(view);
    if (command.is_done) return i;
    if (i == 0) device.X_PN = command.X_PN;
    move_device(device, mass_kg, command, state.last.device_f_n, scene, dt_s);

    const Pose X_DS = scene.X_PD.inverse() * device.X_PN * scene.X_SN.inverse();
    const HapticOutput output = tick(state, {view.time_s, dt_s, X_DS}, scene);
    view.X_PN_device = device.X_PN;
    view.last = output.sample;
    record.note(command);
    TROCAR_TRY_STATUS(record.append(output.sample));
    if (i % 2000 == 0) report(progress, "performing", static_cast<double>(i) / static_cast<double>(most_ticks));
  }
  return most_ticks;
}

}  // namespace

Status check_run(const RunOptions& options) {
  if (!options.force_model.empty()) TROCAR_TRY_STATUS(parse_force_model(options.force_model));
  if (!(options.rate_hz >= 250.0 && options.rate_hz <= 4000.0))
    return fail_usage(fmt::format("rate {} Hz is not between 250 and 4000", options.rate_hz), "--rate",
                      "choose a rate in this range");
  TROCAR_TRY_STATUS(find_device(options));
  return check_operator(options.operator_name);
}

Result<RunResult> run_session(const Case& the_case, const RunOptions& options, const Progress& progress) {
  TROCAR_TRY_STATUS(check_run(options));
  TROCAR_TRY(const Performer performer, make_performer(the_case, options));
  TROCAR_TRY(const DevicePreset device, find_device(options));
  HapticOptions haptics;
  haptics.seed = options.seed;
  TROCAR_TRY(haptics.force_model, parse_force_model(performer.force_model));
  apply_device_preset(device, haptics);
  const NeedleGeometry needle = needle_geometry(the_case.needle);
  TROCAR_TRY(const auto scene,
             make_haptic_scene(the_case.patient, the_case.tissues, needle, device.capability, haptics));

  const AttemptFacts facts{fmt::format("{}, simulated: {}", device.name, device.title), performer.rate_hz,
                           to_string(haptics.force_model)};
  const InterruptibleWork interruptible;
  std::optional<UnfinishedOutput> unfinished;  // ends after the record, which still writes when it ends
  TROCAR_TRY(AttemptRecord record, AttemptRecord::create(the_case, options, facts));
  unfinished.emplace(session_files(options.session));
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const std::size_t ticks, perform(performer, *scene, device.apparent_mass_kg, record, progress));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  log_info("{} ticks performed and recorded in {:.0f} ms", ticks, took.count());
  TROCAR_TRY(RunResult result, record.finish());
  unfinished->keep();
  return result;
}

}  // namespace trocar
