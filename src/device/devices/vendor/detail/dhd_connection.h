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
/// H, the vendor's end effector, which is V where the wrist is in its middle: the grip's tip then points away from the
/// user, along -x [assumed]. S: +z from the grip to the tip.
Mat3 R_HS() noexcept;

/// An open device and the thread that talks to it. Invariant: while it lives, dhdOpen was answered with `id_`; its end
/// leaves the motors off and the device closed.
class Connection final : private ServoBody {
 public:
  static Result<std::unique_ptr<Connection>> open(std::shared_ptr<ServoPace> pace);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int system_type() const noexcept { return type_; }
  const std::string& system_name() const noexcept { return name_; }
  /// Motors on at zero force, and the thread runs. `senses_rotation`: else its frame is left out.
  Status start(bool senses_rotation);
  /// After start.
  ServoExchange& exchange() noexcept { return *exchange_; }
  /// The vendor's words for the error that lost the device; nullptr: it is not lost.
  const char* last_error() const noexcept { return last_error_.load(); }

 private:
  Connection(const Api& api, char id, std::shared_ptr<ServoPace> pace);
  Status check_state();
  Status keep_watchdog();
  tl::unexpected<Error> failed(const char* what) const;

  void serve(double now_s) noexcept override;
  enum class Sensed { kNew, kRepeated, kFailed };
  Sensed sense(ServoSample& sample) noexcept;
  bool apply(const haptics::Wrench& wrench_D) noexcept;
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
  // Of the thread.
  ServoSample sample_;
  int failures_ = 0;
  int periods_ = 0;
};

}  // namespace trocar::devices::dhd
