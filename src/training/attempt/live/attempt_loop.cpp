#include "attempt/live/attempt_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "attempt/record/journal.h"
#include "attempt/record/session_case.h"
#include "cases/scene_request.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::attempt {
namespace {

link::LoadScene scene_of(const AttemptCase& the_case, const std::string& force_model, const AttemptIdentity& identity,
                         const motion::MotionDrive& breathing, const char* tool) {
  cases::SceneChoice choice;
  choice.tool = tool;
  choice.force_model = force_model;
  choice.patient_source = the_case.server_source;
  choice.patient_seed = identity.patient_seed;
  choice.seed = identity.seed;
  link::LoadScene request = cases::scene_request(*the_case.the_case, choice);
  request.motion = breathing;
  return request;
}

double seconds(Clock::TimePoint time) noexcept {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace

AttemptLoop::AttemptLoop(AttemptCase the_case, LoopOptions options, AttemptOperators operators,
                         std::shared_ptr<HapticServers> servers, ToolSupervisors supervisors, Clock& clock,
                         AttemptExchange& exchange)
    : case_(std::move(the_case)),
      options_(std::move(options)),
      clock_(clock),
      exchange_(exchange),
      servers_(std::move(servers)),
      performer_(std::move(operators.needle)),
      led_transducer_(options_.X_PT_start),
      own_motion_(std::move(operators.transducer)),
      transducer_motion_(own_motion_ ? own_motion_.get() : &led_transducer_) {
  needle_.server = std::move(supervisors.needle);
  transducer_.server = std::move(supervisors.transducer);
  auto steering = std::make_unique<NeedleSteering>();
  steering_ = steering.get();
  if (performer_.the_operator != nullptr) {
    command_ = steering_->begin_with(std::move(performer_.the_operator), 1.0 / performer_.rate_hz,
                                     operators.ends_with_operator);
  } else {
    command_.X_PN = options_.X_PN_start;
    steering_->hand().put(command_.X_PN);
  }
  performer_.the_operator = std::move(steering);
  prepare();
  publish(AttemptPhase::kStarting);
}

void AttemptLoop::prepare() {
  breathing_ = case_.the_case->breathing;
  breathing_.begins_s += seconds(clock_.now());
  if (!performer_.parameters.empty()) needle_.server->set_parameters(as_command(performer_.parameters.front()));
  needle_.server->prepare(
      {scene_of(case_, performer_.force_model, options_, breathing_, "needle"), hand_target(command_, 0.0)});
  if (!transducer_.server) return;
  PreparationRequest request{scene_of(case_, performer_.force_model, options_, breathing_, "probe"), {}};
  request.place.X_PN = transducer_motion_->X_PT_start();
  request.scene.X_PW = transducer_room(request.scene.X_PW, transducer_motion_->X_PT_room());
  transducer_.server->prepare(request);
}

bool AttemptLoop::poll() {
  if (std::holds_alternative<Ended>(state_)) return false;
  const Status status = step();
  if (Recording* now = recording()) watch_disk(*now);
  publish(phase_now(), is_preparing() ? preparation() : Activity{});
  if (status && !finishes_) return true;
  conclude(status);
  return false;
}

void AttemptLoop::abandon() {
  needle_.server->end();
  if (transducer_.server) transducer_.server->end();
  state_.emplace<Ended>();  // closes the file
}

void AttemptLoop::leave() {
  if (std::holds_alternative<Ended>(state_)) return;
  const bool was_inside =
      recording() != nullptr && std::ranges::any_of(recording()->record.samples(), telemetry::is_in_body);
  if (was_inside) return conclude({});
  abandon();
}

Status AttemptLoop::step() {
  TROCAR_TRY_STATUS(take_requests());
  // Ticks first: when a poll finds the server changed, all ticks of the old one were taken.
  TROCAR_TRY_STATUS(step_needle());
  if (transducer_.server) TROCAR_TRY_STATUS(step_transducer());
  if (finishes_) return {};
  if (transducer_.server) {
    needle_.server->hold_start(is_preparing() && transducer_.server->is_loading());
    transducer_.server->hold_start(is_preparing() && needle_.server->is_loading());
    poll_server(*transducer_.server);
  }
  poll_server(*needle_.server);
  TROCAR_TRY_STATUS(check_servers());
  const bool is_transducer_settled =
      !transducer_.server || transducer_.server->is_fresh() || transducer_.server->state() == ServerState::kFailed;
  if (is_preparing() && needle_.server->is_fresh() && is_transducer_settled) TROCAR_TRY_STATUS(start_recording());
  return {};
}

Status AttemptLoop::take_requests() {
  AttemptRequests requests = exchange_.take_requests();
  lead(requests);
  if (requests.stopped) stop_or_resume(*requests.stopped);
  if (requests.performer) steering_->perform(std::move(requests.performer));
  for (const LiveTool* tool : {&needle_, &transducer_}) {
    if (!tool->server) continue;
    for (const link::SetParameters& parameters : requests.parameters) tool->server->set_parameters(parameters);
    if (requests.has_drawn) tool->server->frame_drawn();
  }
  finishes_ = finishes_ || requests.finishes;
  return recording() != nullptr ? take_requests(*recording(), requests) : Status{};
}

/// Those that have no effect before the attempt.
Status AttemptLoop::take_requests(Recording& recording, AttemptRequests& requests) {
  for (tasks::XrayUse& use : requests.xray) {
    if (recording.record.samples().empty()) continue;
    use.time_s = recording.live.time_s();
    if (recording.watch) recording.watch->take(use);
    TROCAR_TRY_STATUS(recording.record.append(use));
  }
  if (requests.repeated_phase && recording.watch) recording.watch->repeat_phase(*requests.repeated_phase);
  for (const tasks::ActionRequest& request : requests.actions) TROCAR_TRY_STATUS(act(recording, request));
  return {};
}

/// To hold the breath or to breathe; other actions are nothing to the patient's breath. Both servers get the drive that
/// goes on where the old one is.
void AttemptLoop::ask_patient(tasks::ActionKind action) {
  if (action != tasks::ActionKind::kHoldBreath && action != tasks::ActionKind::kBreathe) return;
  const double now_s = seconds(clock_.now());
  const motion::MotionDrive next = action == tasks::ActionKind::kHoldBreath ? motion::asked_to_hold(breathing_, now_s)
                                                                            : motion::released(breathing_, now_s);
  if (!motion::moves(breathing_) || next == breathing_) return;
  breathing_ = next;
  for (const LiveTool* tool : {&needle_, &transducer_})
    if (tool->server) tool->server->set_parameters({.motion = breathing_});
}

Status AttemptLoop::act(Recording& recording, const tasks::ActionRequest& request) {
  TROCAR_TRY(const auto action, recording.record.act(request));
  if (action) ask_patient(action->kind);
  if (!recording.watch) return {};
  recording.watch->take_actions();
  constexpr double kLess_mm = 0.5;
  const bool stops =
      action && action->kind == tasks::ActionKind::kAdvanceWire && action->amount < request.amount - kLess_mm;
  if (stops) recording.watch->remark(": it goes no further, do not force it");
  return {};
}

/// So far from the skin that a hand that moves it fast is slow before it touches.
bool AttemptLoop::is_needle_free() const {
  constexpr double kNear_mm = 10.0;
  if (!needle_.last) return false;
  return volume::sample_linear(case_.the_case->patient->skin_distance_mm, needle_.last->rest_tip_mm) > kNear_mm;
}

void AttemptLoop::lead(const AttemptRequests& requests) {
  LedPose& needle = steering_->hand();
  needle.limit(is_needle_free() ? kFreeHand : SpeedLimits{});
  LedPose& transducer = led_transducer_.hand();
  if (requests.needle_clamped) needle.clamp(*requests.needle_clamped);
  if (requests.probe_clamped) transducer.clamp(*requests.probe_clamped);
  // A trainee who does not see where the needle is does not move it: motion of that time is discarded.
  if (requests.needle && needle_.server->is_fresh() && !steering_->is_performing())
    needle.lead(requests.needle->X_P, requests.needle->v_P, requests.needle->w_P);
  if (requests.probe) transducer.lead(requests.probe->X_P, requests.probe->v_P, requests.probe->w_P);
}

void AttemptLoop::stop_or_resume(bool is_stopped) {
  is_stopped_ = is_stopped;
  for (const LiveTool* tool : {&needle_, &transducer_}) {
    if (!tool->server) continue;
    is_stopped ? tool->server->stop_forces() : tool->server->resume_forces();
  }
}

void AttemptLoop::poll_server(ServerSupervisor& server) {
  const std::string event = server.poll();
  if (!event.empty() && !options_.ends_with_needle_server) notes_.push_back(event);
  if (std::string recovery = server.take_recovery(); !recovery.empty()) {
    recovered_ = std::move(recovery);
    ++recoveries_;
  }
  for (std::string& message : server.take_messages()) message_ = std::move(message);
}

Status AttemptLoop::check_servers() {
  const ServerSupervisor& needle = *needle_.server;
  if (needle.state() == ServerState::kFailed && (options_.ends_with_needle_server || is_preparing()))
    return tl::unexpected(needle.failure());
  if (!transducer_.server || transducer_.server->state() != ServerState::kFailed || is_transducer_given_up_) return {};
  // A device in a hand was chosen; without a simulated transducer the attempt continues.
  const Error& failure = transducer_.server->failure();
  if (is_preparing() && !options_.is_transducer_optional) return tl::unexpected(failure);
  is_transducer_given_up_ = options_.ends_with_needle_server;
  if (is_transducer_given_up_) notes_.push_back("the attempt continues without the probe: " + failure.text());
  return {};
}

AttemptLoop::Activity AttemptLoop::preparation() const {
  const ServerSupervisor &needle = *needle_.server, *const transducer = transducer_.server.get();
  if (transducer == nullptr) return {needle.activity(), needle.loading()};
  return {needle.is_fresh() ? transducer->activity() : needle.activity(),
          0.5 * (needle.loading() + transducer->loading())};
}

Status AttemptLoop::start_recording() {
  const link::ClientView& client = needle_.server->client();
  const double wanted_hz = client.status.loop.wanted_hz;
  if (wanted_hz > 0.0) performer_.rate_hz = wanted_hz;
  const RecordOptions options{options_.identity(), options_.session, transducer_.server ? case_.plane : std::nullopt,
                              options_.longest_s};
  AttemptFacts facts;
  facts.device =
      fmt::format("{}, {}, through {}", client.welcome.device.name, client.welcome.device.title, client.welcome.server);
  facts.rate_hz = performer_.rate_hz;
  facts.force_model = performer_.force_model;
  facts.device_preset = preset_of_device(client.welcome.device.name);
  if (const SceneParameters* newest = needle_.server->scenes().newest()) facts.parameters = *newest;
  TROCAR_TRY(AttemptRecord record, AttemptRecord::create(*case_.the_case, options, facts));
  Recording& begun = state_.emplace<Recording>(performer_, std::move(record), command_, options_.longest_s);
  if (options_.has_view) begun.watch.emplace(*case_.the_case, begun.record, case_.plane);
  needle_.was_on = false;
  needle_.server->take_samples();  // at rest, while the transducer's server was still busy
  return {};
}

/// Ends the attempt in order while there is still space to close its session.
void AttemptLoop::watch_disk(Recording& recording) {
  constexpr auto kEvery = std::chrono::seconds(1);
  const Clock::TimePoint now = clock_.now();
  if (!options_.free_bytes || now - recording.disk_polled < kEvery) return;
  recording.disk_polled = now;
  const std::filesystem::path folder = options_.session.parent_path();
  const RecordingSpace room(folder, options_.free_bytes(folder), performer_.rate_hz);
  recording.disk_banner = room.banner();
  if (!room.is_full() || finishes_) return;
  finishes_ = true;
  recording.cut_short =
      fmt::format("The disk is full ({}): the recording ended after {:.1f} s. Nothing recorded so far is lost",
                  folder.string(), recording.live.active_s());
  notes_.push_back(recording.cut_short);
}

void AttemptLoop::conclude(const Status& status) {
  publish(AttemptPhase::kFinishing, {"stopping the servers", 0.0});
  needle_.server->end();
  if (transducer_.server) transducer_.server->end();
  Result<RunResult> result = score(status);
  AttemptUpdate last = compose(result ? AttemptPhase::kFinished : AttemptPhase::kFailed, {});
  last.result = std::move(result);
  state_.emplace<Ended>();  // closes the file
  exchange_.publish(std::move(last));
}

Result<RunResult> AttemptLoop::score(const Status& status) {
  Recording* const now = recording();
  const bool is_recorded = now != nullptr && !now->record.samples().empty();
  const bool is_unsaved = is_recorded && options_.scores_unsaved && now->record.write_failure();
  if (!status && !is_unsaved) return tl::unexpected(status.error());
  if (!is_recorded)
    return fail("the attempt was ended before anything was recorded", options_.session.string(), "start a new attempt");
  const Progress progress = [this](std::string_view step, double fraction) {
    publish(AttemptPhase::kFinishing, {std::string(step), fraction});
  };
  RunResult result;
  if (!now->record.write_failure()) {
    Result<RunResult> finished = now->record.finish(progress);
    if (!finished && !(options_.scores_unsaved && now->record.write_failure())) return finished;
    if (finished) result = *std::move(finished);
  }
  if (now->record.write_failure()) result = now->record.finish_unsaved(progress);
  if (result.cut_short.empty()) result.cut_short = now->cut_short;
  for (const LiveTool* tool : {&needle_, &transducer_})
    if (tool->server) result.servers.push_back(tool->server->figures());
  result.ticks_missing = needle_.server->view().ticks_missing;
  result.paused_s = now->live.paused_s();
  result.unseen_s = now->live.unseen_s();
  result.warnings.insert(result.warnings.begin(), notes_.begin(), notes_.end());
  return result;
}

}  // namespace trocar::attempt
