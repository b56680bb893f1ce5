#include "attempt/live/attempt_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "attempt/guide/gun_shot.h"
#include "attempt/live/attempt_event.h"
#include "attempt/record/recording_room.h"
#include "cases/scene_request.h"
#include "telemetry/tick_pose.h"

namespace trocar::attempt {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{2};
/// Older ticks arrive too late for a reply; see run_realtime_session.
constexpr double kAnswered_s = 0.05;
constexpr double kLongestPersons_s = 900.0;  ///< Every tick is kept in memory until the scoring. [assumed]
constexpr double kLongestStep_s = 0.02;      ///< Of a hand between two ticks.
constexpr double kBeforeEntry_mm = 20.0;
constexpr double kAboveSkin_mm = 10.0;  ///< Initial height of the transducer.

/// As an absolute path, since a server has its own working folder.
std::string as_server_sees(const std::string& patient) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(patient, ignored)) return patient;
  return std::filesystem::absolute(patient, ignored).lexically_normal().string();
}

SeatRequest seat_request(const cases::OpenCase& open_case, const AttemptOptions& options, const char* tool) {
  cases::SceneChoice choice;
  choice.tool = tool;
  choice.force_model = options.force_model.empty() ? open_case.force_model : options.force_model;
  choice.patient_source = as_server_sees(open_case.server_source);
  choice.patient_seed = open_case.choice.patient_seed;
  choice.seed = options.seed;
  return {cases::scene_request(open_case.the_case, choice), {}};
}

Pose before_entry(const Segment& path_P) {
  return needle_pose(path_P.a - kBeforeEntry_mm * path_P.direction(), path_P.direction());
}

}  // namespace

AttemptLoop::AttemptLoop(std::shared_ptr<const cases::OpenCase> open_case, const AttemptOptions& options,
                         std::shared_ptr<SeatServers> servers, AttemptDesk& desk)
    : open_case_(std::move(open_case)), options_(options), servers_(std::move(servers)), desk_(desk) {
  auto steering = std::make_unique<SteeredNeedle>();
  steering_ = steering.get();
  performer_.the_operator = std::move(steering);
  performer_.rate_hz = options.rate_hz;
  performer_.force_model = options.force_model.empty() ? open_case_->force_model : options.force_model;
  begins_ = !options.waits_for_begin;
}

void AttemptLoop::run(const std::stop_token& stop) {
  progress_ = "starting the haptic servers";
  publish(AttemptPhase::kStarting);
  Status status = start();
  while (status && !stop.stop_requested() && !finishes_) {
    status = step();
    watch_disk();
    publish(phase_now());
    options_.clock->sleep_for(kBetweenLooks);
  }
  if (!stop.stop_requested()) conclude(std::move(status));
}

Status AttemptLoop::start() {
  std::error_code ignored;
  if (std::filesystem::exists(options_.session, ignored))
    return fail_usage("there is a session of that name already", options_.session.string(), "choose another name");
  if (servers_ && !servers_->fits(options_)) servers_.reset();
  if (!servers_) {
    TROCAR_TRY(servers_, SeatServers::start(options_));
  }
  const Segment& path_P = open_case_->the_case.plan.line_P;
  needle_.emplace(*servers_->needle, options_.patience, true, *options_.clock);
  SeatRequest needle = seat_request(*open_case_, options_, "needle");
  command_.X_PN = options_.X_PN_start.value_or(before_entry(path_P));
  steering_->hand().put(command_.X_PN);
  needle.place = hand_target(command_, 0.0);
  needle_->hold(needle);
  if (!servers_->probe) return {};

  probe_.emplace(*servers_->probe, options_.patience, true, *options_.clock);
  SeatRequest probe = seat_request(*open_case_, options_, "probe");
  const Pose X_PT = options_.X_PT_start.value_or(open_case_->X_PT_start);
  probe_hand_.put(X_PT * Pose::translation({0.0, -kAboveSkin_mm, 0.0}));
  probe_hand_.lead(X_PT, Vec3::Zero(), Vec3::Zero());
  probe.place.X_PN = probe_hand_.X_P();
  probe.scene.X_PW = probe_room(probe.scene.X_PW, X_PT);
  probe_->hold(probe);
  return {};
}

void AttemptLoop::look_at(ToolServer& server) {
  const std::string happened = server.look();
  if (!happened.empty()) notes_.push_back(happened);
  if (std::string recovery = server.take_recovery(); !recovery.empty()) {
    recovered_ = std::move(recovery);
    ++recoveries_;
  }
  for (std::string& message : server.take_messages()) message_ = std::move(message);
}

/// Before the forces were on for the first time, nothing can be restored: any failure ends the attempt.
Status AttemptLoop::check_start() {
  if (has_ever_been_on_) return {};
  if (needle_->has_given_up()) return tl::unexpected(needle_->failure());
  // A missing transducer in a real hand fails the attempt; a simulated one does not.
  const bool is_probe_in_hand = device_hold(options_.device_probe) != DeviceHold::kOurHand;
  if (probe_ && is_probe_in_hand && probe_->has_given_up()) return tl::unexpected(probe_->failure());
  progress_ = needle_->is_on() && probe_ ? probe_->doing() : needle_->doing();
  progress_fraction_ = needle_->loading();
  if (probe_) progress_fraction_ = 0.5 * (progress_fraction_ + probe_->loading());
  return {};
}

Status AttemptLoop::step() {
  TROCAR_TRY_STATUS(take_wishes());
  // Ticks first: when look() detects a change of the server, all ticks of the old one have been taken.
  TROCAR_TRY_STATUS(step_needle());
  if (probe_) TROCAR_TRY_STATUS(step_probe());
  look_at(*needle_);
  if (probe_) look_at(*probe_);
  TROCAR_TRY_STATUS(check_start());
  const bool is_probe_settled = !probe_ || probe_->is_on() || probe_->has_given_up();
  if (needle_->is_on() && is_probe_settled) {
    has_ever_been_on_ = true;
    if (begins_ && !record_) TROCAR_TRY_STATUS(start_recording());
  }
  return {};
}

/// Ends the attempt while there is still space to close its session.
void AttemptLoop::watch_disk() {
  constexpr auto kEvery = std::chrono::seconds(1);
  const auto now = options_.clock->now();
  if (!record_ || !options_.free_bytes || now - disk_looked_at_ < kEvery) return;
  disk_looked_at_ = now;
  const std::filesystem::path folder = options_.session.parent_path();
  const RecordingRoom room(folder, options_.free_bytes(folder), performer_.rate_hz);
  disk_banner_ = room.banner();
  if (!room.is_full() || finishes_) return;
  finishes_ = true;
  cut_short_ = fmt::format("The disk is full ({}): the recording ended after {:.1f} s. Nothing recorded so far is lost",
                           folder.string(), live_->active_s());
  notes_.push_back(cut_short_);
}

Status AttemptLoop::take_wishes() {
  AttemptWishes wishes;
  {
    const std::lock_guard lock(desk_.mutex);
    std::swap(wishes, desk_.wishes);
  }
  lead_hands(wishes);
  if (wishes.begins) begins_ = true;
  if (wishes.fires) steering_->fire();
  if (wishes.stopped) stop_or_resume(*wishes.stopped);
  if (wishes.performer) steering_->perform(std::move(wishes.performer));
  for (const std::vector<std::string>& settings : wishes.settings) {
    needle_->set_parameters(settings);
    if (probe_) probe_->set_parameters(settings);
  }
  if (wishes.has_drawn) {
    needle_->frame_drawn();
    if (probe_) probe_->frame_drawn();
  }
  finishes_ = finishes_ || wishes.finishes;
  return {};
}

void AttemptLoop::lead_hands(const AttemptWishes& wishes) {
  LedHand& needle = steering_->hand();
  if (wishes.needle_clamped) needle.clamp(*wishes.needle_clamped);
  if (wishes.probe_clamped) probe_hand_.clamp(*wishes.probe_clamped);
  // Motions of the hand while the needle's position is unknown are discarded.
  if (wishes.needle && needle_->is_on() && !steering_->is_performing())
    needle.lead(wishes.needle->X_P, wishes.needle->v_P, wishes.needle->w_P);
  if (wishes.probe) probe_hand_.lead(wishes.probe->X_P, wishes.probe->v_P, wishes.probe->w_P);
}

void AttemptLoop::stop_or_resume(bool is_stopped) {
  is_stopped_ = is_stopped;
  for (std::optional<ToolServer>* server : {&needle_, &probe_}) {
    if (!*server) continue;
    is_stopped ? (*server)->stop_forces() : (*server)->resume_forces();
  }
}

Status AttemptLoop::start_recording() {
  RunOptions run;
  run.operator_name = options_.trainee;
  run.patient_source = open_case_->choice.patient_source;
  run.patient_seed = open_case_->choice.patient_seed;
  run.seed = options_.seed;
  run.rate_hz = performer_.rate_hz = needle_->wanted_hz() > 0.0 ? needle_->wanted_hz() : options_.rate_hz;
  run.session = options_.session;
  const link::Welcome& welcome = needle_->client().welcome;
  AttemptFacts facts;
  facts.device = fmt::format("{}, {}, through {}", welcome.device.name, welcome.device.title, welcome.server);
  facts.rate_hz = performer_.rate_hz;
  facts.force_model = performer_.force_model;
  facts.device_preset = preset_of_device(welcome.device.name);
  facts.level = options_.level;
  if (const KnownScenes* known = needle_->scenes(); known != nullptr && known->newest() != nullptr)
    facts.parameters = *known->newest();
  TROCAR_TRY(AttemptRecord record, AttemptRecord::create(open_case_->the_case, run, facts));
  record_.emplace(std::move(record));
  live_.emplace(performer_, *record_, command_, kLongestPersons_s);
  was_needle_on_ = false;
  needle_->take_samples();  // at rest, while the probe's server was still busy
  return {};
}

Status AttemptLoop::step_needle() {
  const std::vector<link::NumberedSample> samples = needle_->take_samples();
  if (!needle_->is_on() && samples.empty()) {
    was_needle_on_ = false;
    return {};
  }
  if (samples.empty()) return {};
  if (!was_needle_on_) {
    if (live_) live_->begin(needle_->clock_offset_s(), needle_->seatings() != seatings_);
    seatings_ = needle_->seatings();
    if (has_ever_been_on_) steering_->resume_at(telemetry::device_pose(samples.front().sample));
    needle_time_s_ = samples.front().sample.time_s;
  }
  was_needle_on_ = true;
  if (live_) {
    TROCAR_TRY_STATUS(record(samples));
  } else {
    answer_unrecorded(samples);
  }
  link::HandTarget target = live_ ? live_->hand() : hand_target(command_, needle_time_s_ + 1.0 / performer_.rate_hz);
  needle_->set_hand(target);
  needle_->place_at(telemetry::felt_needle(samples.back().sample));  // in its channel, whatever the grip's rotation
  return {};
}

void AttemptLoop::answer_unrecorded(const std::vector<link::NumberedSample>& samples) {
  tasks::OperatorView view;
  for (const link::NumberedSample& numbered : samples) {
    view.last = numbered.sample;
    view.dt_s = std::clamp(numbered.sample.time_s - needle_time_s_, 0.0, kLongestStep_s);
    view.X_PN_device = telemetry::device_pose(numbered.sample);
    needle_time_s_ = numbered.sample.time_s;
    command_ = performer_.the_operator->next(view);
  }
  last_needle_ = samples.back().sample;
  last_needle_->time_s = 0.0;
}

Status AttemptLoop::record(const std::vector<link::NumberedSample>& samples) {
  for (const link::NumberedSample& numbered : samples) {
    if (numbered.sample.time_s < samples.back().sample.time_s - kAnswered_s) {
      TROCAR_TRY_STATUS(live_->take_unseen(numbered.sample));
    } else {
      TROCAR_TRY(const bool goes_on, live_->take(numbered.sample));
      finishes_ = finishes_ || !goes_on;
    }
    if (const KnownScenes* known = needle_->scenes()) TROCAR_TRY_STATUS(record_->note_scene(numbered.scene, *known));
    note_tick(live_->last());
  }
  note_shot();
  command_ = live_->command();
  last_needle_ = live_->last();
  return {};
}

void AttemptLoop::note_tick(const telemetry::TickSample& sample) {
  trace_.add({sample.time_s, sample.depth_mm, telemetry::axial_resistance_n(sample)});
  if (!contact_s_ && sample.phase != telemetry::InsertionPhase::kOutside) contact_s_ = sample.time_s;
  for (const telemetry::TickEvent& event : sample.events) {
    if (event.kind == telemetry::EventKind::kNone) break;
    if (auto told = describe_event(record_->info(), sample, event)) events_.push_back(*std::move(told));
  }
}

void AttemptLoop::note_shot() {
  const std::optional<std::size_t>& fired = record_->fired();
  if (shot_ || !fired || *fired >= record_->samples().size()) return;
  shot_ = std::make_shared<const GunShot>(make_gun_shot(open_case_->the_case, record_->samples()[*fired]));
  // The composition of the core is displayed next to its picture.
  events_.push_back({shot_->time_s, shot_->depth_mm, telemetry::EventKind::kNone, "shot",
                     fmt::format("the gun was fired at {:.0f}\u00a0mm", shot_->depth_mm)});
}

Status AttemptLoop::step_probe() {
  const std::vector<link::NumberedSample> samples = probe_->take_samples();
  if (samples.empty()) {
    was_probe_on_ = was_probe_on_ && probe_->is_on();
    return {};
  }
  const double now_s = samples.back().sample.time_s;
  if (!was_probe_on_) probe_time_s_ = samples.front().sample.time_s;
  was_probe_on_ = true;
  probe_hand_.step(std::min(now_s - probe_time_s_, kAnswered_s));
  probe_time_s_ = now_s;
  last_probe_ = samples.back().sample;
  link::HandTarget target;
  target.X_PN = probe_hand_.X_P();
  target.v_P = probe_hand_.v_P();
  target.w_P = probe_hand_.w_P();
  target.server_time_s = now_s;
  probe_->set_hand(target);
  probe_->place_at(telemetry::device_pose(*last_probe_));
  return live_ ? live_->note_transducer(samples, probe_->clock_offset_s()) : Status{};
}

Result<RunResult> AttemptLoop::score(const Status& status) {
  const bool is_recorded = record_ && !record_->samples().empty();
  if (!status && !(is_recorded && record_->write_failure())) return tl::unexpected(status.error());
  if (!is_recorded)
    return fail("the attempt was ended before anything was recorded", options_.session.string(), "start a new attempt");
  RunResult result;
  if (!record_->write_failure()) {
    Result<RunResult> finished = record_->finish();
    if (!finished && !record_->write_failure()) return finished;
    if (finished) result = *std::move(finished);
  }
  if (record_->write_failure()) result = record_->finish_unsaved();
  if (result.cut_short.empty()) result.cut_short = cut_short_;
  for (const std::optional<ToolServer>* server : {&needle_, &probe_})
    if (*server) result.servers.push_back((*server)->figures());
  result.ticks_missing = needle_->view().ticks_missing;
  result.warnings.insert(result.warnings.begin(), notes_.begin(), notes_.end());
  if (result.ticks_missing > 0)
    result.warnings.push_back(
        fmt::format("{} ticks of the needle did not arrive: the session has gaps there", result.ticks_missing));
  if (live_->paused_s() > 0.0)
    result.warnings.push_back(
        fmt::format("the needle's server was away: {:.1f} s are missing from the session", live_->paused_s()));
  return result;
}

void AttemptLoop::conclude(Status status) {
  progress_ = "scoring";
  progress_fraction_ = 0.0;
  publish(AttemptPhase::kFinishing);
  trace_.flush();
  if (needle_) needle_->end();
  if (probe_) probe_->end();
  Result<RunResult> result = score(status);
  const AttemptPhase end = result ? AttemptPhase::kFinished : AttemptPhase::kFailed;
  live_.reset();
  record_.reset();  // closes the file
  publish(end, std::move(result));
}

}  // namespace trocar::attempt
