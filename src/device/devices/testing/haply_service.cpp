#include "devices/testing/haply_service.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

namespace trocar::testing {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using Json = nlohmann::json;

constexpr const char* kDeviceId = "049D";
constexpr double kMass_kg = 0.15;
constexpr double kDamping_ns_per_m = 2.0;
constexpr double kStep_s = 0.0005;
constexpr std::size_t kTooLongBytes = 1'000'000;

bool has_more_to_read(int descriptor) {
  pollfd watched{descriptor, POLLIN, 0};
  return ::poll(&watched, 1, 0) > 0;
}

}  // namespace

struct HaplyService::Wire {
  asio::io_context context;
  beast::websocket::stream<asio::ip::tcp::socket> stream{context};
  beast::flat_buffer buffer;
  bool is_early = false;  ///< There was something to read before the last state was sent.
};

HaplyService::HaplyService(HaplyMood mood) : mood_(mood) {
  // Bound here, so that the port is known; served by the thread.
  asio::io_context context;
  asio::ip::tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  port_ = acceptor.local_endpoint().port();
  listener_ = acceptor.release();
  thread_ = std::thread([this] { serve(); });
}

HaplyService::~HaplyService() {
  is_stopping_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  {
    const std::lock_guard lock(mutex_);
    if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);
  }
  thread_.join();
  ::close(listener_);
}

void HaplyService::put_cursor(const Vec3& p_m) {
  const std::lock_guard lock(mutex_);
  p_m_ = p_m;
  v_m_per_s_.setZero();
}

void HaplyService::set_grip(const Eigen::Quaterniond& q, bool is_a_pressed, bool is_b_pressed) {
  const std::lock_guard lock(mutex_);
  q_grip_ = q;
  is_a_pressed_ = is_a_pressed;
  is_b_pressed_ = is_b_pressed;
}

Vec3 HaplyService::last_force_n() const {
  const std::lock_guard lock(mutex_);
  return force_n_;
}

Vec3 HaplyService::cursor_m() const {
  const std::lock_guard lock(mutex_);
  return p_m_;
}

std::vector<std::string> HaplyService::violations() const {
  const std::lock_guard lock(mutex_);
  return violations_;
}

void HaplyService::note(std::string violation) {
  const std::lock_guard lock(mutex_);
  violations_.push_back(std::move(violation));
}

void HaplyService::serve() {
  while (!is_stopping_) {
    const int client = ::accept(listener_, nullptr, nullptr);
    if (client < 0) break;
    {
      const std::lock_guard lock(mutex_);
      client_ = client;
    }
    ++connections_;
    is_connected_ = true;
    Wire wire;
    beast::get_lowest_layer(wire.stream).assign(asio::ip::tcp::v4(), client);
    serve_client(wire);
    {
      const std::lock_guard lock(mutex_);
      client_ = -1;
    }
    is_connected_ = false;
  }
}

void HaplyService::serve_client(Wire& wire) {
  error_code error;
  wire.stream.accept(error);
  wire.stream.text(true);
  if (error || !send_state(wire, true)) return;
  while (!is_stopping_) {
    wire.buffer.clear();
    wire.stream.read(wire.buffer, error);
    if (error) return;  // a close may come at any time
    if (wire.is_early) note("a second command before the next state");
    take_command(beast::buffers_to_string(wire.buffer.cdata()));
    if (!send_state(wire, false)) return;
  }
}

bool HaplyService::send_state(Wire& wire, bool is_first) {
  const int descriptor = beast::get_lowest_layer(wire.stream).native_handle();
  while (mood_ == HaplyMood::kStalled && !is_stopping_) {
    if (has_more_to_read(descriptor)) break;  // goodbye
    ::poll(nullptr, 0, 1);
  }
  if (is_stopping_ || mood_ == HaplyMood::kClose) return false;
  wire.is_early = mood_ == HaplyMood::kGood && has_more_to_read(descriptor);
  error_code error;
  wire.stream.write(asio::buffer(state_text(mood_, is_first)), error);
  return !error;
}

std::string HaplyService::state_text(HaplyMood mood, bool is_first) const {
  if (mood == HaplyMood::kNotJson) return R"({"inverse3":[{"device_id":"049D","state":{)";
  if (mood == HaplyMood::kTooLong) return std::string(kTooLongBytes, ' ');
  const std::lock_guard lock(mutex_);
  Json device = {{"device_id", kDeviceId},
                 {"state",
                  {{"cursor_position", {{"x", p_m_.x()}, {"y", p_m_.y()}, {"z", p_m_.z()}}},
                   {"cursor_velocity", {{"x", v_m_per_s_.x()}, {"y", v_m_per_s_.y()}, {"z", v_m_per_s_.z()}}}}},
                 {"status",
                  {{"calibrated", mood != HaplyMood::kNotCalibrated},
                   {"power_supply", mood != HaplyMood::kNoPower},
                   {"ready", mood != HaplyMood::kNotReady}}}};
  if (is_first) device["config"] = {{"preset", is_centred_ ? "arm_front_centered" : "defaults"}};
  if (mood == HaplyMood::kWrongTypes) device["state"]["cursor_position"]["x"] = "0.1";
  if (mood == HaplyMood::kHugeNumbers) device["state"]["cursor_position"]["y"] = 1e300;
  const Json grip = {
      {"device_id", "61576"},
      {"state",
       {{"orientation", {{"w", q_grip_.w()}, {"x", q_grip_.x()}, {"y", q_grip_.y()}, {"z", q_grip_.z()}}},
        {"buttons", {{"a", is_a_pressed_}, {"b", is_b_pressed_}, {"c", false}}}}}};
  Json document = {{"inverse3", Json::array()}, {"wireless_verse_grip", Json::array()}};
  if (mood != HaplyMood::kNoDevice) document["inverse3"].push_back(device);
  if (mood != HaplyMood::kNoGrip) document["wireless_verse_grip"].push_back(grip);
  return document.dump();
}

void HaplyService::take_command(const std::string& text) {
  ++commands_;
  const Json command = Json::parse(text, nullptr, false);
  const Json::json_pointer device("/inverse3/0");
  if (command.is_discarded() || !command.contains(device)) return note("no command: " + text);
  if (command[device].value("device_id", "") != kDeviceId) return note("the device's id is missing: " + text);
  const Json::json_pointer values("/commands/set_cursor_force/values");
  if (!command[device].contains(values)) return note("no force: " + text);
  Vec3 force_n;
  int axis = 0;
  for (const char* name : {"x", "y", "z"}) {
    const Json value = command[device][values].value(name, Json());
    if (!value.is_number() || !std::isfinite(value.get<double>())) return note("a force that is not finite: " + text);
    force_n[axis++] = value.get<double>();
  }
  const std::lock_guard lock(mutex_);
  force_n_ = force_n;
  v_m_per_s_ += kStep_s / kMass_kg * (force_n - kDamping_ns_per_m * v_m_per_s_);
  p_m_ += kStep_s * v_m_per_s_;
}

}  // namespace trocar::testing
