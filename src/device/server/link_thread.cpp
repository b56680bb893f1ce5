#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/log.h"
#include "realtime/periodic_loop.h"
#include "server/detail/threads.h"

namespace trocar::server {
namespace {

constexpr double kBatch_s = 0.005;
constexpr double kStatus_s = 0.05;
constexpr std::size_t kSendAt = 128;  // samples from which a batch is sent early
constexpr int kWait_ms = 1;
constexpr int kMostMessagesARound = 64;    // between two reads of the ring of records
constexpr double kLongestRound_s = 0.003;  // the same, plus the time of one message
constexpr double kStalled_s = 1.0;         // age of the window's last frame that causes a warning

}  // namespace

LinkThread::LinkThread(Shared& shared, link::ServerSocket& socket, link::Welcome welcome, int priority)
    : shared_(shared),
      socket_(socket),
      welcome_(std::move(welcome)),
      priority_(priority),
      recorder_(1e9 / static_cast<double>(shared.period_ns)) {}

void LinkThread::run() {
  const CrashStack stack;
  const realtime::RealTimeGrant grant = realtime::request_real_time(priority_);
  log_info("link thread: {}", grant.text());
  const LimitedLog limited(*shared_.log_limit);
  while (!shared_.is_stopping.load(std::memory_order_relaxed)) {
    receive_round();
    const double now_s = realtime::seconds(realtime::now_ns());
    socket_.drop_lost(now_s);
    watch_control();
    const std::optional<double> heard_s = socket_.controller_heard_s();
    shared_.heard_ns.store(heard_s ? static_cast<std::int64_t>(*heard_s * 1e9) : 0, std::memory_order_relaxed);
    for (const AddressedReply& answer : shared_.control_queue.take_replies())
      socket_.send_reply(answer.session, answer.reply);

    drain();
    if (now_s - sent_s_ < kBatch_s) continue;
    if (now_s - told_s_ >= kStatus_s) {
      batch_.status = make_status(now_s);
      told_s_ = now_s;
    }
    flush();
    sent_s_ = now_s;
  }
  drain();
  flush();
  if (auto flight = recorder_.finish()) save(*std::move(flight));
}

/// Limited in messages and time, so that batches are sent under any load from clients.
void LinkThread::receive_round() {
  const double begin_s = realtime::seconds(realtime::now_ns());
  double now_s = begin_s;
  for (int taken = 0; taken < kMostMessagesARound && now_s - begin_s < kLongestRound_s; ++taken) {
    const auto received = socket_.receive(taken == 0 ? kWait_ms : 0, welcome_, now_s);
    watch_control();  // before the message: a kStart of the client that has just got control comes after the stop
    if (!received) return;
    take(*received);
    now_s = realtime::seconds(realtime::now_ns());
  }
}

void LinkThread::drain() {
  ServoRecord record;
  while (shared_.records.pop(record)) {
    // A gap or a new scene ends a batch, because its ticks are numbered from the first.
    const bool is_next = record.tick == batch_.first_tick + batch_.samples.size() && record.scene == batch_.scene;
    if (!batch_.samples.empty() && !is_next) flush();
    if (batch_.samples.empty()) batch_.first_tick = record.tick;
    batch_.scene = record.scene;
    batch_.samples.push_back(record.sample);
    if (record.shape) batch_.shape = record.shape;
    if (batch_.samples.size() >= kSendAt) flush();
    if (record.drop_n > 0.0) {
      drop_n_ = record.drop_n;
      drop_s_ = record.drop_s;
    }
    actions_ |= record.actions;
    coupling_share_ = std::min(coupling_share_, record.sample.coupling_share);
    ticks_ = record.tick + 1;
    if (auto flight = recorder_.add(record)) save(*std::move(flight));
    newest_ = record;
  }
}

void LinkThread::save(Flight flight) {
  if (shared_.control_queue.post(std::move(flight))) return;
  const std::string text = fmt::format("a flight record was dropped: {} others wait to be written", kMostFlights);
  log_warning("{}", text);
  shared_.control_queue.update([&](ControlStatus& status) { status.warning = text; });
}

void LinkThread::flush() {
  if (batch_.samples.empty() && !batch_.status) return;
  socket_.send_batch(std::exchange(batch_, {}));
}

void LinkThread::take(const link::Received& received) {
  if (const auto* beat = std::get_if<link::Heartbeat>(&received.body)) {
    if (received.has_control) window_age_s_ = beat->window_age_s;
  } else if (const auto* command = std::get_if<link::Command>(&received.body)) {
    take(received, *command);
  } else if (const auto* target = std::get_if<link::HandTarget>(&received.body)) {
    // Sent again until it was taken, it is one placement.
    if (target->is_placed && std::exchange(placed_s_, target->server_time_s) != target->server_time_s) {
      ++placements_;
      pressed_mm_ = target->pressed_mm;
    }
    shared_.hand.write({*target, placements_, pressed_mm_});
  }
}

void LinkThread::watch_control() {
  const std::uint64_t controller = socket_.controller();
  if (controller == in_control_) return;
  placed_s_ = kNotPlaced_s;
  shared_.commands.stop(realtime::now_ns());
  in_control_ = controller;
  window_age_s_ = 0.0;
}

void LinkThread::reply(const link::Received& received, std::uint32_t request, bool is_done, std::string text) {
  socket_.send_reply(received.session, {request, is_done, std::move(text)});
}

void LinkThread::take(const link::Received& received, const link::Command& command) {
  const auto* simple = std::get_if<link::ServerCommand>(&command.what);
  if (simple == nullptr || *simple == link::ServerCommand::kReconnect) {
    ControlJob job{received.session, command.request, link::ServerCommand::kReconnect};
    std::visit([&](const auto& what) { job.what = what; }, command.what);
    if (!shared_.control_queue.post(std::move(job)))
      reply(received, command.request, false, "busy: other jobs are queued — send it again when they are done");
    return;
  }
  if (*simple == link::ServerCommand::kStart && !shared_.control_queue.status().has_scene) {
    reply(received, command.request, false, "no scene loaded — load one first");
    return;
  }
  const bool is_taken = shared_.commands.push(*simple, realtime::now_ns());
  if (is_taken && *simple == link::ServerCommand::kResetFault)
    shared_.control_queue.update([](ControlStatus& status) { status.warning.clear(); });
  reply(received, command.request, is_taken, is_taken ? "done" : "too many commands at once — send it again");
}

std::string LinkThread::warning() const {
  if (window_age_s_ > kStalled_s)
    return fmt::format("the client's window has not drawn a frame for {:.1f} s", window_age_s_);
  return shared_.control_queue.status().warning;
}

link::ServerStatus LinkThread::make_status(double now_s) {
  const ControlStatus control = shared_.control_queue.status();
  link::ServerStatus status;
  status.server_time_s = now_s;
  status.gate_mode = newest_.sample.gate_mode;
  status.fault = newest_.sample.gate_fault;
  status.warning = warning();
  if (shared_.has_grant.load(std::memory_order_acquire)) status.grant = shared_.grant.text();
  status.patient = control.patient;
  status.patient_hash = control.patient_hash;
  status.force_model = control.force_model;
  status.task = control.task;
  status.loading = control.loading;
  status.loop = shared_.statistics.newest().summary();
  status.ticks = ticks_;
  status.ticks_dropped = shared_.records_dropped.load(std::memory_order_relaxed);
  status.messages_refused = socket_.refused().total();
  status.gate_actions = std::exchange(actions_, 0);
  status.coupling_share = std::exchange(coupling_share_, 1.0);
  status.drop_n = drop_n_;
  status.drop_s = drop_s_;
  status.is_device_connected = newest_.status != devices::DeviceStatus::kDisconnected;
  status.has_controller = in_control_ != 0;
  const bool is_running =
      shared_.commands.have_stops_taken_effect() && shared_.is_wanted.load(std::memory_order_relaxed);
  status.state = newest_.sample.gate_fault != telemetry::GateFault::kNone ? link::ServerState::kFault
                 : control.loading > 0.0                                  ? link::ServerState::kLoading
                 : !control.has_scene                                     ? link::ServerState::kNoScene
                 : is_running                                             ? link::ServerState::kRunning
                                                                          : link::ServerState::kReady;
  return status;
}

}  // namespace trocar::server
