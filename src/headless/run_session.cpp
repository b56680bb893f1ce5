#include "headless/run_session.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>

#include "core/data_dir.h"
#include "core/log.h"
#include "core/version.h"
#include "haptics/device_preset.h"
#include "haptics/simulation/virtual_device.h"
#include "haptics/tick.h"
#include "headless/needle_geometry.h"
#include "training/hand.h"
#include "training/operator.h"

namespace trocar {
namespace {

constexpr double kLongestAttempt_s = 120.0;

/// An operator as it was named: the text after the colon, if any, is its speed or its session.
struct OperatorChoice {
  enum class Kind { kExpert, kNovice, kConstantVelocity, kReplay };
  Kind kind = Kind::kExpert;
  double speed_mm_per_s = 0.0;
  std::string session;
};

Result<double> parse_speed(std::string_view text) {
  double speed = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  if (error == std::errc() && end == text.data() + text.size() && speed >= 0.1 && speed <= 500.0) return speed;
  return fail_usage(fmt::format("speed {} is not a number from 0.1 to 500 mm/s", text), "--operator constant-velocity");
}

Result<OperatorChoice> parse_operator(std::string_view name) {
  using Kind = OperatorChoice::Kind;
  if (name == "expert") return OperatorChoice{Kind::kExpert, 0.0, {}};
  if (name == "novice") return OperatorChoice{Kind::kNovice, 0.0, {}};
  constexpr std::string_view kConstant = "constant-velocity:";
  if (name.starts_with(kConstant)) {
    TROCAR_TRY(const double speed, parse_speed(name.substr(kConstant.size())));
    return OperatorChoice{Kind::kConstantVelocity, speed, {}};
  }
  constexpr std::string_view kReplay = "replay:";
  if (name.starts_with(kReplay)) return OperatorChoice{Kind::kReplay, 0.0, std::string(name.substr(kReplay.size()))};
  return fail_usage(fmt::format("no operator named {}", name), "--operator",
                    "use expert, novice, constant-velocity:MM_PER_S or replay:SESSION");
}

/// An operator and the rate it wants to be run at.
struct Performer {
  std::unique_ptr<Operator> the_operator;
  double rate_hz;
  std::string force_model;  ///< Unless the user wants another.
};

Result<Performer> make_performer(const Case& the_case, const RunOptions& options) {
  const OperatorCase what{the_case.plan.line_P, the_case.needle.is_biopsy, options.seed};
  TROCAR_TRY(const OperatorChoice choice, parse_operator(options.operator_name));
  switch (choice.kind) {
    case OperatorChoice::Kind::kExpert:
      return Performer{make_expert(what), options.rate_hz, the_case.task.force_model};
    case OperatorChoice::Kind::kNovice:
      return Performer{make_novice(what), options.rate_hz, the_case.task.force_model};
    case OperatorChoice::Kind::kConstantVelocity:
      return Performer{make_constant_velocity(what, choice.speed_mm_per_s), options.rate_hz, the_case.task.force_model};
    case OperatorChoice::Kind::kReplay:
      break;
  }
  TROCAR_TRY(Session session, load_session(choice.session));
  const double rate = session.info.rate_hz;
  return Performer{make_replay(std::move(session.samples), session.fired), rate, session.info.force_model};
}

Result<DevicePreset> find_device(const RunOptions& options) {
  const std::filesystem::path data = data_dir();
  if (data.empty()) return fail("the data folder was not found", "", "set TROCAR_DATA_DIR to it");
  return load_device_preset(data / "devices.toml", options.device);
}

SessionInfo describe(const Case& the_case, const RunOptions& options, const DevicePreset& device, double rate_hz,
                     ForceModel force_model) {
  SessionInfo info;
  info.program_version = kVersion;
  info.started_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  info.task = the_case.task.name;
  info.patient_name = the_case.patient->name;
  info.patient_source = options.patient_source;
  info.patient_hash = the_case.patient->content_hash;
  info.patient_seed = options.patient_seed;
  info.operator_name = options.operator_name;
  info.force_model = to_string(force_model);
  info.seed = options.seed;
  info.rate_hz = rate_hz;
  info.needle = the_case.needle.name;
  info.device = fmt::format("{}, simulated: {}", device.name, device.title);
  info.tissue_table_toml = the_case.tissues.to_toml();
  info.plan_P = {the_case.task.name + " plan", the_case.plan.line_P};
  info.is_parenchymal = the_case.is_parenchymal;
  for (const TissueParams& tissue : the_case.tissues.tissues) info.tissue_names.push_back(tissue.name);
  for (const LayerParams& layer : the_case.tissues.layers) info.layer_names.push_back(layer.name);
  info.label_names.resize(256);
  for (const Label& label : the_case.patient->label_table.labels) info.label_names[label.id] = label.name;
  return info;
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

struct Recording {
  std::vector<TickSample> samples;
  std::optional<std::size_t> fired;
};

/// The closed loop, until the operator is done.
Result<Recording> perform(Performer& performer, const HapticScene& scene, double mass_kg, SessionWriter& writer,
                          const Progress& progress) {
  Recording recording;
  const double dt_s = 1.0 / performer.rate_hz;
  const auto most_ticks = static_cast<std::size_t>(kLongestAttempt_s * performer.rate_hz);
  recording.samples.reserve(most_ticks / 4);
  VirtualDeviceState device;
  HapticState state;
  OperatorView view;
  view.dt_s = dt_s;
  for (std::size_t i = 0; i < most_ticks; ++i) {
    view.time_s = static_cast<double>(i) * dt_s;
    const HandCommand command = performer.the_operator->next(view);
    if (command.is_done) break;
    if (i == 0) device.X_PN = command.X_PN;
    move_device(device, mass_kg, command, state.last.device_f_n, scene, dt_s);

    const Pose X_DS = scene.X_PD.inverse() * device.X_PN * scene.X_SN.inverse();
    const HapticOutput output = tick(state, {view.time_s, dt_s, X_DS}, scene);
    view.X_PN_device = device.X_PN;
    view.last = output.sample;
    if (command.has_fired && !recording.fired) recording.fired = recording.samples.size();
    recording.samples.push_back(output.sample);
    TROCAR_TRY_STATUS(writer.append(output.sample));
    if (i % 2000 == 0) report(progress, "performing", static_cast<double>(i) / static_cast<double>(most_ticks));
  }
  return recording;
}

}  // namespace

Status check_run(const RunOptions& options) {
  if (!options.force_model.empty()) TROCAR_TRY_STATUS(parse_force_model(options.force_model));
  if (!(options.rate_hz >= 250.0 && options.rate_hz <= 4000.0))
    return fail_usage(fmt::format("rate {} Hz is not between 250 and 4000", options.rate_hz), "--rate");
  TROCAR_TRY_STATUS(find_device(options));
  TROCAR_TRY_STATUS(parse_operator(options.operator_name));
  return {};
}

std::vector<PunctureRecord> find_punctures(const SessionInfo& info, const std::vector<TickSample>& samples) {
  std::vector<PunctureRecord> punctures;
  for (const TickSample& sample : samples) {
    for (const TickEvent& event : sample.events) {
      if (event.kind != EventKind::kPuncture) continue;
      punctures.push_back({info.layer_names.at(event.id), sample.time_s, sample.depth_mm, tip_load_n(sample)});
    }
  }
  return punctures;
}

Result<RunResult> run_session(const Case& the_case, const RunOptions& options, const Progress& progress) {
  TROCAR_TRY_STATUS(check_run(options));
  TROCAR_TRY(Performer performer, make_performer(the_case, options));
  TROCAR_TRY(const DevicePreset device, find_device(options));
  HapticOptions haptics;
  haptics.seed = options.seed;
  const std::string& model = !options.force_model.empty() ? options.force_model : performer.force_model;
  TROCAR_TRY(haptics.force_model, parse_force_model(model));
  apply_device_preset(device, haptics);
  const NeedleGeometry needle = needle_geometry(the_case.needle);
  TROCAR_TRY(const auto scene,
             make_haptic_scene(the_case.patient, the_case.tissues, needle, device.capability, haptics));

  const SessionInfo info = describe(the_case, options, device, performer.rate_hz, haptics.force_model);
  TROCAR_TRY(SessionWriter writer, SessionWriter::create(options.session, info));
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const Recording recording, perform(performer, *scene, device.apparent_mass_kg, writer, progress));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  log_info("{} ticks performed and recorded in {:.0f} ms", recording.samples.size(), took.count());

  RunResult result;
  result.outcome = score_attempt(the_case.task, *the_case.patient, the_case.tissues, the_case.needle, the_case.plan,
                                 recording.samples, recording.fired);
  TROCAR_TRY_STATUS(writer.finish(result.outcome, recording.fired));
  result.punctures = find_punctures(info, recording.samples);
  result.ticks = recording.samples.size();
  result.simulated_s = recording.samples.empty() ? 0.0 : recording.samples.back().time_s;
  return result;
}

}  // namespace trocar
