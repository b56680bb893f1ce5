#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "geometry/pose.h"

namespace trocar::testing {

/// Behaviour of the service for its next state message.
enum class HaplyMood : int {
  kGood,
  kClose,          ///< Closes the connection instead of sending the state.
  kNotJson,        ///< Sends an incomplete JSON document.
  kWrongTypes,     ///< Strings instead of numbers.
  kHugeNumbers,    ///< A position beyond the reach of any arm.
  kStalled,        ///< Sends nothing while this mood is set.
  kTooLong,        ///< Sends a message of a megabyte.
  kNotCalibrated,  ///< status.calibrated false, and so on.
  kNoPower,
  kNotReady,
  kNoDevice,  ///< An empty list.
  kNoGrip,    ///< The grip is missing from the lists.
};

/// A stand-in for the Inverse service on its own loopback port. It follows the vendor's rules (a first state, then one
/// state per command), records violations by the client, and moves a mass with the received forces. It serves one
/// client at a time.
class HaplyService {
 public:
  explicit HaplyService(HaplyMood mood = HaplyMood::kGood);
  ~HaplyService();
  HaplyService(const HaplyService&) = delete;
  HaplyService& operator=(const HaplyService&) = delete;

  std::string address() const { return "ws://127.0.0.1:" + std::to_string(port_); }
  void set_mood(HaplyMood mood) { mood_ = mood; }
  /// Places the cursor at `p_m` (m, vendor's frame), at rest.
  void put_cursor(const Vec3& p_m);
  void set_grip(const Eigen::Quaterniond& q, bool is_a_pressed, bool is_b_pressed);
  /// true: in the first state, the origin is the middle of the workspace.
  void set_centred(bool is_centred) { is_centred_ = is_centred; }

  std::uint64_t commands() const { return commands_; }
  int connections() const { return connections_; }
  bool is_connected() const { return is_connected_; }
  Vec3 last_force_n() const;
  Vec3 cursor_m() const;
  /// Descriptions of the violations of the vendor's rules.
  std::vector<std::string> violations() const;

 private:
  struct Wire;
  void serve();
  void serve_client(Wire& wire);
  bool send_state(Wire& wire, bool is_first);
  std::string state_text(HaplyMood mood, bool is_first) const;
  void take_command(const std::string& text);
  void note(std::string violation);

  int listener_ = -1;
  int port_ = 0;
  std::atomic<HaplyMood> mood_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<bool> is_connected_{false};
  std::atomic<bool> is_centred_{false};
  std::atomic<std::uint64_t> commands_{0};
  std::atomic<int> connections_{0};
  mutable std::mutex mutex_;  ///< Guards the members below.
  int client_ = -1;           ///< Descriptor of the client, used to wake the thread.
  Vec3 p_m_{0.0, -0.12, 0.15};
  Vec3 v_m_per_s_ = Vec3::Zero();
  Eigen::Quaterniond q_grip_ = Eigen::Quaterniond::Identity();
  bool is_a_pressed_ = false;
  bool is_b_pressed_ = false;
  Vec3 force_n_ = Vec3::Zero();
  std::vector<std::string> violations_;
  std::thread thread_;
};

}  // namespace trocar::testing
