#include "devices/vendor/openhaptics_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text.h"
#include "devices/detail/factories.h"
#include "devices/vendor/detail/hd_connection.h"
#include "devices/workspace_map.h"
#include "realtime/periodic_loop.h"

namespace trocar::devices {
namespace {

double steady_s() noexcept {
  return realtime::seconds(realtime::now_ns());
}

struct ModelRow {
  std::string_view word;  ///< In the model's name, in lower case.
  std::string_view preset;
};
/// In this order: "Touch X" is the successor of the PHANTOM Desktop, "Touch" that of the Omni.
constexpr std::array kModels{ModelRow{"premium", "premium"}, ModelRow{"desktop", "desktop"},
                             ModelRow{"touch x", "desktop"}, ModelRow{"touchx", "desktop"},
                             ModelRow{"omni", "omni"},       ModelRow{"touch", "omni"}};

Result<std::string> preset_of_model(const std::string& model) {
  const std::string small = ascii::lower_case(model);
  for (const ModelRow& row : kModels) {
    if (small.find(row.word) != std::string::npos) return std::string(row.preset);
  }
  return fail(fmt::format("unknown OpenHaptics device model \"{}\"", model), "OpenHaptics",
              "name a row of data/devices.toml as its preset");
}

void tighten(double& value, const std::optional<double>& said) noexcept {
  if (said) value = std::min(value, *said);
}
void tighten(std::optional<double>& value, const std::optional<double>& said) noexcept {
  if (said) value = value ? std::min(*value, *said) : *said;
}

/// The preset, limited to the values that the device reports.
stylus::DevicePreset tightened(stylus::DevicePreset preset, const hd::Description& said) {
  stylus::DeviceCapability& capability = preset.capability;
  tighten(capability.peak_force_n, said.peak_force_n);
  tighten(preset.continuous_force_n, said.continuous_force_n);
  tighten(capability.max_stiffness_n_per_mm, said.stiffness_n_per_mm);
  if (said.output_dof > 3) {
    tighten(capability.peak_torque_nmm, said.peak_torque_nmm);
    if (preset.has_torque()) tighten(preset.continuous_torque_nmm, said.continuous_torque_nmm);
  } else {
    preset.actuated_dof = 3;
    capability.peak_torque_nmm = 0.0;
    preset.continuous_torque_nmm.reset();
  }
  // A softer spring keeps its damping time.
  stylus::CouplingParams& coupling = preset.coupling;
  const double share = std::min(1.0, capability.max_stiffness_n_per_mm / coupling.stiffness_n_per_mm);
  coupling.stiffness_n_per_mm *= share;
  coupling.damping_ns_per_mm *= share;
  return preset;
}

std::string name_of(const OpenHapticsOptions& options) {
  return options.device.empty() ? "openhaptics" : fmt::format("openhaptics:{}", options.device);
}

/// Invariant: connection_ is set, except after a failed reconnect.
class OpenHapticsDevice final : public HapticDevice {
 public:
  OpenHapticsDevice(OpenHapticsOptions options, stylus::DevicePreset preset, std::unique_ptr<hd::Connection> connection)
      : options_(std::move(options)),
        preset_(std::move(preset)),
        model_(connection->description().model),
        connection_(std::move(connection)) {}

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return name_of(options_); }
  DeviceReading read(double now_s) noexcept override {
    if (connection_) last_ = connection_->exchange().read(now_s);
    if (!connection_) last_.status = DeviceStatus::kDisconnected;
    return last_;
  }
  bool write(const Wrench& wrench_D) noexcept override {
    return connection_ && connection_->exchange().write(wrench_D, preset_.capability);
  }
  Status reconnect() override {
    const std::string cause = connection_ ? connection_->last_error() : std::string();
    connection_.reset();
    auto opened = hd::Connection::open(options_.device, options_.clock_s, false);
    if (!opened) {
      Error error = std::move(opened).error();
      if (!cause.empty()) error.what += fmt::format("; last error: {}", cause);
      return tl::unexpected(std::move(error));
    }
    if ((*opened)->description().model != model_) {
      return fail(fmt::format("a different device is connected: {}", (*opened)->description().model), model_,
                  "restart with it");
    }
    connection_ = *std::move(opened);
    return {};
  }

 private:
  const OpenHapticsOptions options_;
  const stylus::DevicePreset preset_;
  const std::string model_;
  std::unique_ptr<hd::Connection> connection_;
  DeviceReading last_;
};

}  // namespace

Result<std::unique_ptr<HapticDevice>> open_openhaptics_device(const OpenHapticsOptions& wanted) {
  OpenHapticsOptions options = wanted;
  if (options.clock_s == nullptr) options.clock_s = &steady_s;
  TROCAR_TRY(std::unique_ptr<hd::Connection> connection,
             hd::Connection::open(options.device, options.clock_s, options.is_calibrating));
  const hd::Description& said = connection->description();
  if (options.preset.empty()) {
    TROCAR_TRY(options.preset, preset_of_model(said.model));
  }
  TROCAR_TRY(const stylus::DevicePreset row, stylus::load_device_preset(options.devices_file, options.preset));
  TROCAR_TRY(stylus::DevicePreset preset,
             with_stylus_profile(tightened(row, said), options.stylus_folder, name_of(options)));
  return std::make_unique<OpenHapticsDevice>(std::move(options), std::move(preset), std::move(connection));
}

OpenedDevice open_openhaptics(const DeviceSpec& spec, const DeviceOptions& options) {
  OpenHapticsOptions own;
  own.device = spec.argument;
  own.devices_file = options.devices_file;
  own.preset = options.preset;
  own.is_calibrating = options.is_calibrating;
  own.stylus_folder = options.stylus_folder;
  return open_openhaptics_device(own);
}

}  // namespace trocar::devices
