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
                         const char* tool) {
  cases::SceneChoice choice;
  choice.tool = tool;
  choice.force_model = force_model;
  choice.patient_source = the_case.server_source;
  choice.patient_seed = identity.patient_seed;
  choice.seed = identity.seed;
  return cases::scene_request(*the_case.the_case, choice);
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
      needle_(std::move(supervisors.needle)),
      transducer_(std::move(supervisors.transducer)),
      performer_(std::move(operators.needle)),
      led_transducer_(options_.X_PT_start),
      own_motion_(std::move(operators.transducer)),
      transducer_motion_(own_motion_ ? own_motion_.get() : &led_transducer_) {
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
  if (!performer_.parameters.empty()) needle_->set_parameters(as_command(performer_.parameters.front()));
  needle_->prepare({scene_of(case_, performer_.force_model, options_, "needle"), hand_target(command_, 0.0)});
  if (!transducer_) return;
  PreparationRequest request{scene_of(case_, performer_.force_model, options_, "probe"), {}};
  request.place.X_PN = transducer_motion_->X_PT_start();
  request.scene.X_PW = transducer_room(request.scene.X_PW, transducer_motion_->X_PT_room());
  transducer_->prepare(request);
}

bool AttemptLoop::poll() {
  if (has_ended_) return false;
  const Status status = step();
  watch_disk();
  publish(phase_now());
  if (status && !finishes_) return true;
  conclude(status);
  return false;
}

void AttemptLoop::abandon() {
  has_ended_ = true;
  needle_->end();
  if (transducer_) transducer_->end();
  live_.reset();
  record_.reset();  // closes the file
}

void AttemptLoop::leave() {
  if (has_ended_) return;
  const bool was_inside = record_ && std::ranges::any_of(record_->samples(), telemetry::is_in_body);
  if (was_inside) return conclude({});
  abandon();
}

Status AttemptLoop::step() {
  TROCAR_TRY_STATUS(take_requests());
  // Ticks first: when a poll finds the server changed, all ticks of the old one were taken.
  TROCAR_TRY_STATUS(step_needle());
  if (transducer_) TROCAR_TRY_STATUS(step_transducer());
  if (finishes_) return {};
  if (transducer_) {
    needle_->hold_start(!has_ever_been_on_ && transducer_->is_loading());
    transducer_->hold_start(!has_ever_been_on_ && needle_->is_loading());
    poll_server(*transducer_);
  }
  poll_server(*needle_);
  TROCAR_TRY_STATUS(check_servers());
  const bool is_transducer_settled =
      !transducer_ || transducer_->is_fresh() || transducer_->state() == ServerState::kFailed;
  if (needle_->is_fresh() && is_transducer_settled) {
    has_ever_been_on_ = true;
    if (!record_) TROCAR_TRY_STATUS(start_recording());
  }
  return {};
}

Status AttemptLoop::take_requests() {
  AttemptRequests requests = exchange_.take_requests();
  lead(requests);
  if (requests.stopped) stop_or_resume(*requests.stopped);
  if (requests.performer) steering_->perform(std::move(requests.performer));
  for (const link::SetParameters& parameters : requests.parameters) {
    needle_->set_parameters(parameters);
    if (transducer_) transducer_->set_parameters(parameters);
  }
  if (requests.has_drawn) {
    needle_->frame_drawn();
    if (transducer_) transducer_->frame_drawn();
  }
  finishes_ = finishes_ || requests.finishes;
  for (tasks::XrayUse& use : requests.xray) {
    if (!record_ || record_->samples().empty()) continue;  // before the attempt
    use.time_s = live_->time_s();
    note_contrast(use);
    TROCAR_TRY_STATUS(record_->append(use));
  }
  tell_injection();
  if (requests.repeated_phase && phases_) phases_->repeat(*requests.repeated_phase);
  for (const tasks::ActionRequest& request : requests.actions)
    if (record_) TROCAR_TRY_STATUS(act(request));
  return {};
}

Status AttemptLoop::act(const tasks::ActionRequest& request) {
  TROCAR_TRY(const auto action, record_->act(request));
  note_shots();
  note_actions();
  constexpr double kLess_mm = 0.5;
  const bool stops = action && action->kind == tasks::ActionKind::kAdvanceWire &&
                     action->amount < request.amount - kLess_mm && options_.has_view;
  if (stops) events_.back().text += ": it goes no further, do not force it";
  return {};
}

/// So far from the skin that a hand that moves it fast is slow before it touches.
bool AttemptLoop::is_needle_free() const {
  constexpr double kNear_mm = 10.0;
  if (!last_needle_) return false;

  return volume::sample_linear(case_.the_case->patient->skin_distance_mm, last_needle_->rest_tip_mm) > kNear_mm;
}

void AttemptLoop::lead(const AttemptRequests& requests) {
  LedPose& needle = steering_->hand();
  needle.limit(is_needle_free() ? kFreeHand : SpeedLimits{});
  LedPose& transducer = led_transducer_.hand();
  if (requests.needle_clamped) needle.clamp(*requests.needle_clamped);
  if (requests.probe_clamped) transducer.clamp(*requests.probe_clamped);
  // A trainee who does not see where the needle is does not move it: motion of that time is discarded.
  if (requests.needle && needle_->is_fresh() && !steering_->is_performing())
    needle.lead(requests.needle->X_P, requests.needle->v_P, requests.needle->w_P);
  if (requests.probe) transducer.lead(requests.probe->X_P, requests.probe->v_P, requests.probe->w_P);
}

void AttemptLoop::stop_or_resume(bool is_stopped) {
  is_stopped_ = is_stopped;
  for (ServerSupervisor* server : {needle_.get(), transducer_.get()}) {
    if (server == nullptr) continue;
    is_stopped ? server->stop_forces() : server->resume_forces();
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
  const bool is_needle_fatal = options_.ends_with_needle_server || !has_ever_been_on_;
  if (needle_->state() == ServerState::kFailed && is_needle_fatal) return tl::unexpected(needle_->failure());
  if (transducer_ && transducer_->state() == ServerState::kFailed && !is_transducer_given_up_) {
    // A device in a hand was chosen; without a simulated transducer the attempt continues.
    if (!has_ever_been_on_ && !options_.is_transducer_optional) return tl::unexpected(transducer_->failure());
    is_transducer_given_up_ = options_.ends_with_needle_server;
    if (is_transducer_given_up_)
      notes_.push_back("the attempt continues without the probe: " + transducer_->failure().text());
  }
  if (has_ever_been_on_) return {};
  progress_ = needle_->is_fresh() && transducer_ ? transducer_->activity() : needle_->activity();
  progress_fraction_ = needle_->loading();
  if (transducer_) progress_fraction_ = 0.5 * (progress_fraction_ + transducer_->loading());
  return {};
}

Status AttemptLoop::start_recording() {
  const link::ClientView& client = needle_->client();
  const double wanted_hz = client.status.loop.wanted_hz;
  if (wanted_hz > 0.0) performer_.rate_hz = wanted_hz;
  const RecordOptions options{options_.identity(), options_.session, transducer_ ? case_.plane : std::nullopt,
                              options_.longest_s};
  AttemptFacts facts;
  facts.device =
      fmt::format("{}, {}, through {}", client.welcome.device.name, client.welcome.device.title, client.welcome.server);
  facts.rate_hz = performer_.rate_hz;
  facts.force_model = performer_.force_model;
  facts.device_preset = preset_of_device(client.welcome.device.name);
  if (const SceneParameters* newest = needle_->scenes().newest()) facts.parameters = *newest;
  TROCAR_TRY(AttemptRecord record, AttemptRecord::create(*case_.the_case, options, facts));
  record_.emplace(std::move(record));
  const cases::Case& the_case = *case_.the_case;
  if (options_.has_view) {
    pain_.emplace(the_case.task, *the_case.patient);
    harm_.emplace(the_case.task, *the_case.patient, the_case.needle);
  }
  if (options_.has_view && case_.plane)
    phases_.emplace(the_case.task, *the_case.patient, the_case.needle, the_case.plan, *case_.plane);
  live_.emplace(performer_, *record_, command_, options_.longest_s);
  was_needle_on_ = false;
  needle_->take_samples();  // at rest, while the transducer's server was still busy
  return {};
}

/// Ends the attempt in order while there is still space to close its session.
void AttemptLoop::watch_disk() {
  constexpr auto kEvery = std::chrono::seconds(1);
  const Clock::TimePoint now = clock_.now();
  if (!record_ || !options_.free_bytes || now - disk_polled_ < kEvery) return;
  disk_polled_ = now;
  const std::filesystem::path folder = options_.session.parent_path();
  const RecordingSpace room(folder, options_.free_bytes(folder), performer_.rate_hz);
  disk_banner_ = room.banner();
  if (!room.is_full() || finishes_) return;
  finishes_ = true;
  cut_short_ = fmt::format("The disk is full ({}): the recording ended after {:.1f} s. Nothing recorded so far is lost",
                           folder.string(), live_->active_s());
  notes_.push_back(cut_short_);
}

void AttemptLoop::conclude(const Status& status) {
  has_ended_ = true;
  progress_ = "stopping the servers";
  progress_fraction_ = 0.0;
  publish(AttemptPhase::kFinishing);
  trace_.flush();
  needle_->end();
  if (transducer_) transducer_->end();
  Result<RunResult> result = score(status);
  const AttemptPhase end = result ? AttemptPhase::kFinished : AttemptPhase::kFailed;
  live_.reset();
  record_.reset();  // closes the file
  publish(end, std::move(result));
}

Result<RunResult> AttemptLoop::score(const Status& status) {
  const bool is_recorded = record_ && !record_->samples().empty();
  const bool is_unsaved = is_recorded && options_.scores_unsaved && record_->write_failure();
  if (!status && !is_unsaved) return tl::unexpected(status.error());
  if (!is_recorded)
    return fail("the attempt was ended before anything was recorded", options_.session.string(), "start a new attempt");
  const Progress progress = [this](std::string_view step, double fraction) {
    progress_ = step;
    progress_fraction_ = fraction;
    publish(AttemptPhase::kFinishing);
  };
  RunResult result;
  if (!record_->write_failure()) {
    Result<RunResult> finished = record_->finish(progress);
    if (!finished && !(options_.scores_unsaved && record_->write_failure())) return finished;
    if (finished) result = *std::move(finished);
  }
  if (record_->write_failure()) result = record_->finish_unsaved(progress);
  if (result.cut_short.empty()) result.cut_short = cut_short_;
  for (const ServerSupervisor* server : {needle_.get(), transducer_.get()})
    if (server != nullptr) result.servers.push_back(server->figures());
  result.ticks_missing = needle_->view().ticks_missing;
  result.paused_s = live_->paused_s();
  result.unseen_s = live_->unseen_s();
  result.warnings.insert(result.warnings.begin(), notes_.begin(), notes_.end());
  return result;
}

}  // namespace trocar::attempt
