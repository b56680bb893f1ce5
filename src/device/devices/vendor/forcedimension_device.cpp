#include "devices/vendor/forcedimension_device.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/log.h"
#include "core/start_thread.h"
#include "devices/detail/factories.h"
#include "devices/vendor/detail/dhd_api.h"
#include "devices/vendor/detail/servo_exchange.h"
#include "realtime/loop_statistics.h"
#include "realtime/periodic_loop.h"

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

namespace trocar::devices {
namespace {

/// Twice the usual rate: adds half a millisecond of delay in each direction. The devices support 4 kHz. [assumed]
constexpr std::int64_t kServoPeriod_ns = 500'000;
constexpr int kServoPriority = 81;  // just above the loop that it serves (request_real_time's default)

class RealTimePace final : public ServoPace {
 public:
  void run(const std::atomic<bool>& is_stopping, ServoBody& body) noexcept override {
    realtime::request_real_time(kServoPriority);
    realtime::LoopStatistics statistics(kServoPeriod_ns);
    realtime::run_periodic(kServoPeriod_ns, is_stopping, statistics,
                           [&](const realtime::Period&, const realtime::LoopStatistics&) {
                             body.serve(realtime::seconds(realtime::now_ns()));
                           });
  }
};

Result<std::string> preset_of_type(int type, const std::string& name) {
  switch (type) {
    case dhd::kOmega6:
    case dhd::kOmega6Left:
      return "omega6";
    case dhd::kOmega7:
    case dhd::kOmega7Left:
      return "omega7";
    case dhd::kSigma7:
    case dhd::kSigma7Left:
      return "sigma7";
    case dhd::kDelta6:
      return "delta6";
    case dhd::kFalcon:
      return "falcon";
    default:
      return fail(fmt::format("unknown Force Dimension device \"{}\" (type {})", name, type), "Force Dimension",
                  "name a row of data/devices.toml as its preset");
  }
}

/// Invariant: connection_ is set, except after a failed reconnect.
class ForceDimensionDevice final : public HapticDevice {
 public:
  ForceDimensionDevice(std::shared_ptr<ServoPace> pace, stylus::DevicePreset preset,
                       std::unique_ptr<dhd::Connection> connection)
      : pace_(std::move(pace)),
        preset_(std::move(preset)),
        type_(connection->system_type()),
        connection_(std::move(connection)) {}

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return fmt::format("forcedimension:{}", preset_.name); }
  DeviceReading read(double now_s) noexcept override {
    if (connection_) last_ = connection_->exchange().read(now_s);
    if (!connection_) last_.status = DeviceStatus::kDisconnected;
    return last_;
  }
  bool write(const Wrench& wrench_D) noexcept override {
    return connection_ && connection_->exchange().write(wrench_D, preset_.capability);
  }
  Status reconnect() override {
    const char* cause = connection_ ? connection_->last_error() : nullptr;
    const std::string suffix = cause != nullptr ? fmt::format("; last error: {}", cause) : std::string();
    connection_.reset();
    auto opened = dhd::Connection::open(pace_);
    if (!opened) {
      Error error = std::move(opened).error();
      error.what += suffix;
      return tl::unexpected(std::move(error));
    }
    if ((*opened)->system_type() != type_) {
      return fail(fmt::format("a different device is connected: {}", (*opened)->system_name()), preset_.title,
                  "restart with it");
    }
    TROCAR_TRY_STATUS((*opened)->start(preset_.sensed_dof == 6));
    connection_ = *std::move(opened);
    return {};
  }

 private:
  const std::shared_ptr<ServoPace> pace_;
  const stylus::DevicePreset preset_;
  const int type_;
  std::unique_ptr<dhd::Connection> connection_;
  DeviceReading last_;
};

}  // namespace

Result<std::unique_ptr<HapticDevice>> open_forcedimension_device(const ForceDimensionOptions& options) {
  const std::shared_ptr<ServoPace> pace = options.pace ? options.pace : std::make_shared<RealTimePace>();
  TROCAR_TRY(std::unique_ptr<dhd::Connection> connection, dhd::Connection::open(pace));
  std::string row = options.preset;
  if (row.empty()) {
    TROCAR_TRY(row, preset_of_type(connection->system_type(), connection->system_name()));
  }
  TROCAR_TRY(stylus::DevicePreset preset, stylus::load_device_preset(options.devices_file, row));
  // The vendor's library compensates the weight; a second compensation would lift the device.
  preset.capability.stylus_weight_n = 0.0;
  TROCAR_TRY_STATUS(connection->start(preset.sensed_dof == 6));
  return std::make_unique<ForceDimensionDevice>(pace, std::move(preset), std::move(connection));
}

OpenedDevice open_forcedimension(const DeviceSpec&, const DeviceOptions& options) {
  ForceDimensionOptions own;
  own.devices_file = options.devices_file;
  own.preset = options.preset;
  return open_forcedimension_device(own);
}

}  // namespace trocar::devices

namespace trocar::devices::dhd {
namespace {

constexpr double kNmmPerNm = 1000.0;
constexpr double kWatchdog_s = 0.020;  // if the vendor's is off: as ours, ServoExchange::kOldestWrench_s
constexpr int kFailuresToLose = 5;     // consecutive failed calls [assumed]
constexpr int kPeriodsPerStatus = 50;  // 25 ms at 2 kHz: interval of reading the motors' state [assumed]

}  // namespace

Mat3 R_DV() noexcept {
  Mat3 R;
  R << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  return R;
}

Mat3 R_HS() noexcept {
  Mat3 R;
  R << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  return R;
}

Connection::Connection(const Api& api, char id, std::shared_ptr<ServoPace> pace)
    : api_(api), id_(id), pace_(std::move(pace)), type_(api.get_system_type(id)) {
  const char* name = api.get_system_name(id);
  name_ = name != nullptr ? name : "Force Dimension device";
}

Result<std::unique_ptr<Connection>> Connection::open(std::shared_ptr<ServoPace> pace) {
  TROCAR_TRY(const Api api, load_api());
  const int id = api.open();
  if (id < 0) {
    return fail(fmt::format("no Force Dimension device: {}", api.error_text()), "dhdOpen",
                "connect it, switch it on, and allow yourself its USB port (udev rule of the SDK)");
  }
  auto connection = std::unique_ptr<Connection>(new Connection(api, static_cast<char>(id), std::move(pace)));
  TROCAR_TRY_STATUS(connection->check_state());
  return connection;
}

tl::unexpected<Error> Connection::failed(const char* what) const {
  return fail(fmt::format("{}: {}", what, api_.error_text()), name_,
              "switch the device off and on, then open it again");
}

Status Connection::check_state() {
  std::array<int, kStatusLength> status{};
  if (api_.get_status(status.data(), id_) < kNoError) return failed("the device does not report its state");
  if (status[kStatusPower] == 0) return fail("the device has no power", name_, "switch it on, then open it again");
  if (status[kStatusReset] != 0) {
    return fail("the device is not calibrated", name_,
                "put its handle into the calibration pit until the light is steady, then open it again");
  }
  return {};
}

/// The vendor's watchdog stops the force without new commands. Its setting is kept; it is switched on if it is off.
Status Connection::keep_watchdog() {
  unsigned char counts = 0;
  const bool is_known = api_.get_watchdog != nullptr && api_.get_watchdog(&counts, id_) >= kNoError;
  if (is_known && counts > 0) return {};
  const bool can_set = api_.set_watchdog != nullptr && api_.enable_expert_mode != nullptr &&
                       api_.disable_expert_mode != nullptr && api_.enable_expert_mode() >= kNoError;
  if (!can_set) {
    log_warning("{}: its library has no watchdog; only Trocar's own timeout stops an outdated force", name_);
    return {};
  }
  const auto wanted = static_cast<unsigned char>(std::lround(kWatchdog_s / kWatchdogCount_s));
  const bool is_set = api_.set_watchdog(wanted, id_) >= kNoError;
  api_.disable_expert_mode();
  if (!is_set) log_warning("{}: cannot switch on its watchdog: {}", name_, api_.error_text());
  return {};
}

Status Connection::start(bool senses_rotation) {
  senses_rotation_ = senses_rotation;
  TROCAR_TRY_STATUS(keep_watchdog());
  if (api_.set_gravity_compensation(kOn, id_) < kNoError) return failed("cannot switch on its gravity compensation");
  if (sense(sample_) == Sensed::kFailed) return failed("cannot read its pose");
  if (api_.enable_force(kOn, id_) < kNoError) return failed("cannot switch on its motors");
  if (!apply(Wrench{})) return failed("it does not accept forces");
  exchange_.emplace(sample_);
  TROCAR_TRY(thread_, start_thread("device", [this] { pace_->run(is_stopping_, *this); }));
  return {};
}

Connection::~Connection() {
  if (exchange_) exchange_->close();
  is_stopping_.store(true);
  pace_->wake();
  if (thread_.joinable()) thread_.join();
  if (exchange_) apply(Wrench{});
  api_.enable_force(kOff, id_);
  api_.close(id_);
}

void Connection::serve(double now_s) noexcept {
  if (sample_.is_lost) return;
  const Sensed sensed = sense(sample_);
  const Wrench wrench_D = exchange_->wanted(now_s);
  // The library converts forces to motor torques with the pose: no force without a finite pose.
  const bool is_applied = apply(sample_.X_DS.is_finite() ? wrench_D : Wrench{});
  failures_ = sensed != Sensed::kFailed && is_applied ? 0 : failures_ + 1;
  if (!is_applied) sample_.is_force_refused = true;
  if (failures_ >= kFailuresToLose) {
    sample_.is_lost = true;
    last_error_.store(api_.error_text(), std::memory_order_relaxed);
  } else if (++periods_ % kPeriodsPerStatus == 0) {
    sample_.is_force_refused = !has_force();
  }
  if (sensed == Sensed::kNew || sample_.is_lost) exchange_->sensed(sample_);
}

/// Reads into the sample, which keeps its pose if the device does not respond.
Connection::Sensed Connection::sense(ServoSample& sample) noexcept {
  Vec3 p_VH = Vec3::Zero();
  double rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int answer = api_.get_pose(&p_VH.x(), &p_VH.y(), &p_VH.z(), rows, id_);
  if (answer < kNoError) return Sensed::kFailed;
  Mat3 R_VH;
  R_VH << rows[0][0], rows[0][1], rows[0][2],  //
      rows[1][0], rows[1][1], rows[1][2],      //
      rows[2][0], rows[2][1], rows[2][2];
  const Mat3 R_DS = senses_rotation_ ? Mat3(R_DV() * R_VH * R_HS()) : Mat3(Mat3::Identity());
  sample.X_DS = {R_DS, kMmPerM * (R_DV() * p_VH)};
  sample.buttons = 0;
  if (api_.get_button(0, id_) == kOn) sample.buttons |= kButtonMain;
  if (api_.get_button(1, id_) == kOn) sample.buttons |= kButtonSecond;
  return answer == kTimeGuard ? Sensed::kRepeated : Sensed::kNew;
}

bool Connection::apply(const Wrench& wrench_D) noexcept {
  const Vec3 f = R_DV().transpose() * wrench_D.force_n;
  const Vec3 t = R_DV().transpose() * wrench_D.torque_nmm / kNmmPerNm;
  return api_.set_wrench(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), 0.0, id_) >= kNoError;
}

/// Returns false if its button, velocity brake or watchdog keeps the motors off. Only the person at the device can
/// switch them on again (force button).
bool Connection::has_force() noexcept {
  std::array<int, kStatusLength> status{};
  return api_.get_status(status.data(), id_) < kNoError || status[kStatusForce] != 0;
}

}  // namespace trocar::devices::dhd
