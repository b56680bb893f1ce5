#include "devices/vendor/haply_device.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/start_thread.h"
#include "devices/detail/factories.h"
#include "devices/vendor/detail/haply_messages.h"
#include "devices/vendor/detail/websocket.h"
#include "devices/workspace_map.h"
#include "realtime/periodic_loop.h"

namespace trocar::devices {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kConnectLimit{2000};
constexpr milliseconds kFirstStateLimit{2000};
constexpr milliseconds kSendLimit{100};
constexpr milliseconds kStateLimit{1000};  // a service without messages for longer is disconnected
constexpr milliseconds kGoodbyeLimit{200};
constexpr milliseconds kLook{20};  // polling interval of a waiting thread for its end

const char* advice_for(HaplyCondition condition) noexcept {
  switch (condition) {
    case HaplyCondition::kNoDevice:
      return "plug it in and look for it in the Haply Hub";
    case HaplyCondition::kNoPower:
      return "plug in its power supply";
    case HaplyCondition::kNotCalibrated:
      return "put the grip on its rest until the light is steady, or calibrate it in the Haply Hub";
    case HaplyCondition::kNotReady:
      return "wait until its light is steady, or start it anew in the Haply Hub";
    case HaplyCondition::kReady:
    case HaplyCondition::kMalformed:
      break;
  }
  return "see that this is the Inverse service, version 3.1 or later";
}

}  // namespace

Result<std::unique_ptr<HapticDevice>> HaplyDevice::open(const stylus::DevicePreset& preset,
                                                        const std::string& address) {
  std::unique_ptr<HaplyDevice> device(new HaplyDevice(preset, address));
  TROCAR_TRY_STATUS(device->start());
  // Values reported by the service: constant from here on.
  if (!*device->has_grip_) device->preset_.sensed_dof = 3;
  device->preset_.actuated_dof = 3;
  device->preset_.capability.peak_torque_nmm = 0.0;
  return device;
}

HaplyDevice::HaplyDevice(const stylus::DevicePreset& preset, std::string address)
    : preset_(preset), address_(std::move(address)) {
  const std::size_t hash = address_.find('#');
  if (hash == std::string::npos) return;
  device_id_ = address_.substr(hash + 1);
  address_.resize(hash);
}

HaplyDevice::~HaplyDevice() {
  stop();
}

Status HaplyDevice::start() {
  TROCAR_TRY(const WebSocketAddress address, parse_websocket_address(address_));
  auto socket = WebSocket::connect(address, kMostHaplyBytes, kConnectLimit);
  if (!socket) {
    return fail(socket.error().what, address_, "start the Inverse service (Haply Hub, or haply-inverse-service)");
  }
  socket_ = std::move(*socket);
  std::string message;
  if (socket_->receive(message, kFirstStateLimit) != WebSocket::Received::kMessage) {
    return fail("the Inverse service sends no data", address_, "restart it");
  }
  TROCAR_TRY_STATUS(take_first_state(message));
  unusable_ = 0;
  written_ns_ = 0;
  force_.update();  // discards wrenches written before the device was opened
  is_stopping_ = false;
  is_gone_ = false;
  auto thread = start_thread("device", [this] { run(); });
  if (!thread) {
    is_gone_ = true;
    socket_.reset();
    return tl::unexpected(std::move(thread).error());
  }
  thread_ = *std::move(thread);
  return {};
}

Status HaplyDevice::take_first_state(const std::string& message) {
  const HaplyState first = parse_haply_state(message, device_id_);
  if (first.condition != HaplyCondition::kReady) {
    return fail(to_string(first.condition), address_, advice_for(first.condition));
  }
  if (has_grip_.value_or(false) && !first.q_grip) {
    return fail("the grip is missing", address_, "switch it on, or restart the server without it");
  }
  if (!has_grip_) has_grip_ = first.q_grip.has_value();
  device_id_ = first.device_id;
  is_centred_ = first.is_centred;
  state_.write({pose_of(first), first.buttons});
  return {};
}

/// A grip that is connected later is ignored if the device was opened without one.
Pose HaplyDevice::pose_of(HaplyState state) const noexcept {
  if (!has_grip_.value_or(false)) state.q_grip.reset();
  return haply_pose(state, is_centred_);
}

void HaplyDevice::stop() noexcept {
  is_stopping_ = true;
  if (thread_.joinable()) thread_.join();
  socket_.reset();
}

/// At the top of the loop, exactly one state awaits its command.
void HaplyDevice::run() {
  std::string message;
  std::int64_t due_ns = realtime::now_ns();
  bool is_answer_due = true;
  while (!is_stopping_.load(std::memory_order_relaxed)) {
    realtime::sleep_until_ns(due_ns);
    due_ns = std::max(due_ns + kHaplyPeriod_ns, realtime::now_ns());
    is_answer_due = false;
    if (!answer(unusable_ == 0 ? force_now() : Vec3::Zero().eval()) || !wait_for_state(message)) break;
    is_answer_due = true;
    if (!take_state(message)) break;
  }
  is_gone_.store(true, std::memory_order_release);
  say_goodbye(is_answer_due);
}

/// Returns false if the device is disconnected.
bool HaplyDevice::take_state(const std::string& message) {
  const HaplyState state = parse_haply_state(message, device_id_);
  const bool is_valid = state.condition == HaplyCondition::kReady && (state.q_grip.has_value() || !*has_grip_);
  if (is_valid) {
    unusable_ = 0;
    state_.write({pose_of(state), state.buttons});
    return true;
  }
  const bool is_unclear = state.condition == HaplyCondition::kReady || state.condition == HaplyCondition::kMalformed;
  return is_unclear && ++unusable_ < kHaplyMostUnusable;
}

bool HaplyDevice::answer(const Vec3& f_D) {
  return socket_->send(haply_force_command(device_id_, haply_force(f_D)), kSendLimit);
}

/// Returns false if no state arrived in time, or the device is closing.
bool HaplyDevice::wait_for_state(std::string& message) {
  for (milliseconds waited{0}; waited < kStateLimit; waited += kLook) {
    const WebSocket::Received received = socket_->receive(message, kLook);
    if (received != WebSocket::Received::kNothingYet) return received == WebSocket::Received::kMessage;
    if (waited >= kStateLimit / 2 && is_stopping_.load(std::memory_order_relaxed)) return false;
  }
  return false;
}

Vec3 HaplyDevice::force_now() noexcept {
  const std::int64_t now = realtime::now_ns();
  if (force_.update()) written_ns_ = now;
  return now - written_ns_ <= kHaplyForceAge_ns ? force_.value() : Vec3::Zero().eval();
}

/// Sends zero force, then closes the connection; also without a pending state, because a remaining force is worse.
void HaplyDevice::say_goodbye(bool is_answer_due) {
  const bool is_sent = answer(Vec3::Zero());
  std::string message;
  if (is_sent && is_answer_due) socket_->receive(message, kStateLimit);  // the reply confirms it
  socket_->close(kGoodbyeLimit);
}

DeviceReading HaplyDevice::read(double) noexcept {
  const bool is_new = state_.update();
  const Sample& sample = state_.value();
  if (is_gone_.load(std::memory_order_acquire)) return {DeviceStatus::kDisconnected, sample.X_DS, 0};
  return {is_new ? DeviceStatus::kFresh : DeviceStatus::kRepeated, sample.X_DS, sample.buttons};
}

bool HaplyDevice::write(const Wrench& wrench_D) noexcept {
  const bool is_taken = wrench_D.force_n.allFinite() && !is_gone_.load(std::memory_order_acquire);
  force_.write(is_taken ? wrench_D.force_n : Vec3::Zero().eval());
  return is_taken;
}

Status HaplyDevice::reconnect() {
  stop();
  state_.update();  // discards the last state of the previous connection
  return start();
}

OpenedDevice open_haply(const DeviceSpec& spec, const DeviceOptions& options) {
  const std::string address = spec.argument.empty() ? kHaplyAddress : spec.argument;
  TROCAR_TRY(stylus::DevicePreset row, load_preset_of(options, "inverse3"));
  TROCAR_TRY(const stylus::DevicePreset preset,
             with_stylus_profile(std::move(row), options.stylus_folder, HaplyDevice::name_of(address)));
  return HaplyDevice::open(preset, address);
}

}  // namespace trocar::devices
