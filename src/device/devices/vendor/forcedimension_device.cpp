#include "devices/vendor/forcedimension_device.h"

#include <fmt/format.h>

#include "devices/detail/factories.h"
#include "devices/vendor/detail/dhd_connection.h"
#include "realtime/loop_statistics.h"
#include "realtime/periodic_loop.h"
#include "realtime/real_time_grant.h"

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
  ForceDimensionDevice(std::shared_ptr<ServoPace> pace, haptics::DevicePreset preset,
                       std::unique_ptr<dhd::Connection> connection)
      : pace_(std::move(pace)),
        preset_(std::move(preset)),
        type_(connection->system_type()),
        connection_(std::move(connection)) {}

  const haptics::DevicePreset& preset() const noexcept override { return preset_; }
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
  const haptics::DevicePreset preset_;
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
  TROCAR_TRY(haptics::DevicePreset preset, haptics::load_device_preset(options.devices_file, row));
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
