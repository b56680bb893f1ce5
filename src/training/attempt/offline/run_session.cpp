#include "attempt/offline/run_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "attempt/live/performer.h"
#include "attempt/record/attempt_record.h"
#include "cases/scene_request.h"
#include "core/files/folders.h"
#include "core/files/unfinished_output.h"
#include "core/interruption.h"
#include "core/log.h"
#include "haptics/option_texts.h"
#include "haptics/tick.h"
#include "metrics/metric.h"
#include "stylus/device_preset.h"
#include "stylus/virtual_stylus.h"
#include "tasks/operator.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

Result<stylus::DevicePreset> find_device(const RunOptions& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  return stylus::load_device_preset(data / "devices.toml", options.device);
}

/// One step of the device with the operator's hand and the force of the last tick.
void move_device(stylus::VirtualDeviceState& device, double mass_kg, const tasks::HandCommand& command,
                 const Vec3& force_P, const haptics::HapticScene& scene, double dt_s) noexcept {
  if (command.is_rigid) {
    device = {command.X_PN, command.v_P};
    return;
  }
  constexpr tasks::HandParams kHand;
  const tasks::HandSpring spring = tasks::hand_spring(kHand, command);
  const stylus::HandHold hold{spring.anchor_P,
                              spring.anchor_velocity_P,
                              spring.stiffness_n_per_mm,
                              spring.damping_ns_per_mm,
                              spring.mass_kg,
                              tasks::follow_rotation(kHand, device.X_PN.R(), command.X_PN.R(), dt_s)};
  const stylus::VirtualDeviceParams params{mass_kg, scene.device.stylus_weight_n};
  stylus::step_device(device, params, hold, force_P, scene.gravity_P, dt_s);
}

/// The scenes of an attempt: one, or in a replay one per change of parameters.
class SceneSchedule {
 public:
  struct Entry {
    std::size_t tick = 0;  ///< The first tick with it.
    std::shared_ptr<const haptics::HapticScene> scene;
    SceneParameters parameters;
  };
  static Result<SceneSchedule> make(const cases::Case& the_case, const Performer& performer, const RunOptions& options,
                                    const stylus::DevicePreset& device);

  const Entry& first() const noexcept { return entries_.front(); }
  /// The scene of a tick; ticks must be requested in order.
  const Entry& at(std::size_t tick) noexcept {
    while (now_ + 1 < entries_.size() && entries_[now_ + 1].tick <= tick) ++now_;
    return entries_[now_];
  }

 private:
  Status add(const cases::Case& the_case, const storage::SessionParameters& parameters, haptics::HapticOptions options,
             stylus::DeviceCapability device);
  std::vector<Entry> entries_;  ///< Not empty, sorted by tick.
  std::size_t now_ = 0;
};

Result<SceneSchedule> SceneSchedule::make(const cases::Case& the_case, const Performer& performer,
                                          const RunOptions& options, const stylus::DevicePreset& device) {
  haptics::HapticOptions haptics;
  haptics.seed = options.seed;
  haptics.motion = the_case.breathing;
  haptics::apply_device_preset(device, haptics);
  SceneSchedule schedule;
  if (performer.parameters.empty()) {
    const std::vector<std::string> force_model{"force_model=" + performer.force_model};
    TROCAR_TRY_STATUS(
        schedule.add(the_case, {0, 0.0, {}, force_model, the_case.tissues.to_toml()}, haptics, device.capability));
  }
  for (const storage::SessionParameters& parameters : performer.parameters)
    TROCAR_TRY_STATUS(schedule.add(the_case, parameters, haptics, device.capability));
  return schedule;
}

Status SceneSchedule::add(const cases::Case& the_case, const storage::SessionParameters& parameters,
                          haptics::HapticOptions options, stylus::DeviceCapability device) {
  TROCAR_TRY_STATUS(haptics::restore_options(parameters.options, options, device));
  TROCAR_TRY(const anatomy::TissueTable tissues,
             anatomy::parse_tissue_table(parameters.tissue_table_toml, "the parameters in force"));
  Entry entry;
  entry.tick = parameters.tick;
  TROCAR_TRY(entry.scene, haptics::make_haptic_scene(the_case.patient, tissues, cases::needle_geometry(the_case.needle),
                                                     device, options));
  entry.parameters = {haptics::option_texts(*entry.scene), parameters.tissue_table_toml};
  entries_.push_back(std::move(entry));
  return {};
}

RecordOptions record_options(const RunOptions& options, const Performer& performer) {
  const auto plane = performer.replayed != nullptr ? performer.replayed->info.plane : std::nullopt;
  return {options.identity(), options.session, plane};
}

/// When a tick is, and where its tool: regular, or as recorded by the session that is replayed.
class RecordedTicks {
 public:
  explicit RecordedTicks(const Performer& performer)
      : dt_s_(1.0 / performer.rate_hz), session_(performer.replayed.get()) {}

  double time_s(std::size_t tick) const noexcept {
    if (session_ == nullptr) return static_cast<double>(tick) * dt_s_;
    const auto& samples = session_->samples;
    return samples[std::min(tick, samples.size() - 1)].time_s;
  }
  double dt_s(std::size_t tick) const noexcept {
    constexpr double kRounding_s = 1e-9;  // of recorded times
    if (session_ == nullptr || tick == 0) return dt_s_;
    const double step_s = time_s(tick) - time_s(tick - 1);
    return std::abs(step_s - dt_s_) < kRounding_s ? dt_s_ : std::clamp(step_s, haptics::kMinDt_s, haptics::kMaxDt_s);
  }
  /// Empty: the operator's hand moves it.
  std::optional<telemetry::ToolPose> tool(std::size_t tick) const noexcept {
    if (session_ == nullptr || session_->samples.empty()) return {};
    const telemetry::TickSample& sample = session_->samples[std::min(tick, session_->samples.size() - 1)];
    const telemetry::ToolPose tool{sample.device_rotation_wxyz, sample.device_mm};
    return tool.is_valid() ? tool : telemetry::to_tool_pose(telemetry::device_pose(sample));
  }
  /// Where the patient is: as its clock says, or as recorded.
  motion::PatientMotion motion(std::size_t tick, const motion::MotionClock& clock) const noexcept {
    if (session_ == nullptr || session_->samples.empty()) return haptics::motion_of(clock, time_s(tick));
    return metrics::recorded_motion(motion::moves(clock.drive) ? clock.model : nullptr,
                                    session_->samples[std::min(tick, session_->samples.size() - 1)]);
  }
  /// The interruption that ends at the tick; null: none.
  const tasks::Interruption* interruption(std::size_t tick) const noexcept {
    if (session_ == nullptr) return nullptr;
    const auto found = std::ranges::find(session_->interruptions, time_s(tick), &tasks::Interruption::to_s);
    return found == session_->interruptions.end() ? nullptr : &*found;
  }
  /// Appends what the replayed session has besides needle and actions, up to a time: transducer, X-ray.
  Status append_others(double time_s, AttemptRecord& record) {
    if (session_ == nullptr) return {};
    TROCAR_TRY_STATUS(append_until(time_s, session_->transducer, transducer_, record));
    return append_until(time_s, session_->xray, xray_, record);
  }
  std::size_t most_ticks() const noexcept {
    constexpr double kMostTicks = 1e9;
    if (session_ != nullptr) return session_->samples.size() + 1;
    return static_cast<std::size_t>(std::min(kLongestAttempt_s / dt_s_, kMostTicks));
  }

 private:
  template <class Row>
  static Status append_until(double time_s, const std::vector<Row>& rows, std::size_t& next, AttemptRecord& record) {
    for (; next < rows.size() && rows[next].time_s <= time_s; ++next) TROCAR_TRY_STATUS(record.append(rows[next]));
    return {};
  }

  double dt_s_;
  const storage::Session* session_;
  std::size_t transducer_ = 0, xray_ = 0;  ///< Numbers of appended rows.
};

/// What moves the patient after an operator's action.
motion::MotionDrive asked(const motion::MotionDrive& drive, tasks::ActionKind action, double time_s) noexcept {
  if (action == tasks::ActionKind::kHoldBreath) return motion::asked_to_hold(drive, time_s);
  return action == tasks::ActionKind::kBreathe ? motion::released(drive, time_s) : drive;
}

/// The closed loop, until the operator has finished. Returns the number of ticks.
Result<std::size_t> perform(const Performer& performer, SceneSchedule& scenes, double mass_kg, AttemptRecord& record,
                            const Progress& progress) {
  RecordedTicks recorded(performer);
  const std::size_t most_ticks = recorded.most_ticks();
  const SceneSchedule::Entry* before = nullptr;
  stylus::VirtualDeviceState device;
  haptics::HapticState state;
  tasks::OperatorView view;
  const haptics::HapticScene& begin = *scenes.first().scene;
  motion::MotionClock clock{begin.patient->motion.get(), begin.options.motion};
  constexpr double kShapeEvery_s = 0.01;  // as a server
  double next_shape_s = 0.0;
  for (std::size_t i = 0; i < most_ticks; ++i) {
    view.time_s = recorded.time_s(i);
    view.dt_s = recorded.dt_s(i);
    if (is_interrupted()) return tl::unexpected(interruption_error("trocar run"));
    const tasks::HandCommand command = performer.the_operator->next(view);
    if (command.is_done) return i;
    const SceneSchedule::Entry& now = scenes.at(i);
    const haptics::HapticScene& scene = *now.scene;
    if (i == 0) device.X_PN = command.X_PN;
    if (command.action) clock.drive = asked(clock.drive, command.action->kind, view.time_s);
    const bool is_another_model = before != nullptr && before->scene->options.force_model != scene.options.force_model;
    if (is_another_model) state = {};  // as in a server: the insertion restarts
    move_device(device, mass_kg, command, state.last.device_f_n, scene, view.dt_s);
    if (const tasks::Interruption* gap = recorded.interruption(i)) {
      if (gap->reason == tasks::kServerWasAway) state = {};
      TROCAR_TRY_STATUS(record.append(*gap));
    }

    const telemetry::ToolPose tool = recorded.tool(i).value_or(telemetry::to_tool_pose(device.X_PN));
    const motion::PatientMotion motion = recorded.motion(i, clock);
    const haptics::HapticOutput output = tick(state, {view.time_s, view.dt_s, tool, true, motion}, scene);
    view.X_PN_device = device.X_PN;
    view.last = output.sample;
    record.note(command);
    TROCAR_TRY_STATUS(record.append(output.sample));
    view.returned = tasks::last_return(record.actions());
    TROCAR_TRY_STATUS(recorded.append_others(view.time_s, record));
    if (view.time_s >= next_shape_s) {
      telemetry::NeedleShape shape = haptics::needle_shape(state.needle, {scene, motion}, true);
      shape.time_s = view.time_s;
      next_shape_s = view.time_s + kShapeEvery_s;
      TROCAR_TRY_STATUS(record.append(shape));
    }
    if (before != &now) TROCAR_TRY_STATUS(record.note_parameters(now.parameters));
    before = &now;
    if (i % 2000 == 0) report(progress, "performing", static_cast<double>(i) / static_cast<double>(most_ticks));
  }
  return most_ticks;
}

}  // namespace

Status check_run(const RunOptions& options) {
  if (!options.force_model.empty()) TROCAR_TRY_STATUS(haptics::parse_force_model(options.force_model));
  if (!(options.rate_hz >= 250.0 && options.rate_hz <= 4000.0))
    return fail_usage(fmt::format("rate {} Hz is not between 250 and 4000", options.rate_hz), "--rate",
                      "choose a rate in this range");
  TROCAR_TRY_STATUS(find_device(options));
  return check_operator(options.operator_name);
}

Result<RunResult> run_session(const cases::Case& the_case, const RunOptions& given, const Progress& progress) {
  TROCAR_TRY_STATUS(check_run(given));
  TROCAR_TRY(const Performer performer, make_performer(the_case, given));
  const RunOptions options = options_of(performer, given);
  TROCAR_TRY(const stylus::DevicePreset device, find_device(options));
  TROCAR_TRY(SceneSchedule scenes, SceneSchedule::make(the_case, performer, options, device));

  const AttemptFacts facts{fmt::format("{}, simulated: {}", device.name, device.title), performer.rate_hz,
                           to_string(scenes.first().scene->options.force_model), device.name,
                           scenes.first().parameters};
  const InterruptibleWork interruptible;
  std::optional<UnfinishedOutput> unfinished;  // declared before the record, whose destructor still writes
  TROCAR_TRY(AttemptRecord record, AttemptRecord::create(the_case, record_options(options, performer), facts));
  unfinished.emplace(storage::session_files(options.session));
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const std::size_t ticks, perform(performer, scenes, device.apparent_mass_kg, record, progress));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  log_info("{} ticks performed and recorded in {:.0f} ms", ticks, took.count());
  TROCAR_TRY(RunResult result, record.finish());
  unfinished->keep();
  return result;
}

}  // namespace trocar::attempt
