#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "devices/vendor/detail/dhd_api.h"
#include "devices/vendor/detail/servo_exchange.h"
#include "devices/vendor/servo_pace.h"

namespace trocar::devices::dhd {

/// V, the vendor's axes: x towards the user, y right, z up. D: x right, y away, z up.
Mat3 R_DV() noexcept;
/// H, the vendor's end effector: equal to V at the middle position of the wrist, where the tip of the grip points away
/// from the user, along -x [assumed]. S: +z from the grip to the tip.
Mat3 R_HS() noexcept;

/// An open device and its thread. Invariant: dhdOpen returned `id_`, and the device stays open. The destructor switches
/// the motors off and closes the device.
class Connection final : private ServoBody {
 public:
  static Result<std::unique_ptr<Connection>> open(std::shared_ptr<ServoPace> pace);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int system_type() const noexcept { return type_; }
  const std::string& system_name() const noexcept { return name_; }
  /// Switches the motors on at zero force and starts the thread. `senses_rotation`: false: the rotation of a reading is
  /// the identity.
  Status start(bool senses_rotation);
  /// Call it only after start().
  ServoExchange& exchange() noexcept { return *exchange_; }
  /// The vendor's text for the error that disconnected the device; nullptr: not disconnected.
  const char* last_error() const noexcept { return last_error_.load(); }

 private:
  Connection(const Api& api, char id, std::shared_ptr<ServoPace> pace);
  Status check_state();
  Status keep_watchdog();
  tl::unexpected<Error> failed(const char* what) const;

  void serve(double now_s) noexcept override;
  enum class Sensed { kNew, kRepeated, kFailed };
  Sensed sense(ServoSample& sample) noexcept;
  bool apply(const Wrench& wrench_D) noexcept;
  bool has_force() noexcept;

  const Api api_;
  const char id_;
  const std::shared_ptr<ServoPace> pace_;
  int type_ = 0;
  std::string name_;
  bool senses_rotation_ = true;
  std::optional<ServoExchange> exchange_;
  std::thread thread_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<const char*> last_error_{nullptr};
  // Used only by the thread.
  ServoSample sample_;
  int failures_ = 0;
  int periods_ = 0;
};

}  // namespace trocar::devices::dhd
