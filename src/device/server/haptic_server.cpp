#include "server/haptic_server.h"

#include <fmt/format.h>

#include <chrono>
#include <future>
#include <optional>
#include <thread>

#include "core/log.h"
#include "core/version.h"
#include "server/detail/threads.h"

namespace trocar::server {
namespace {

constexpr double kNsPerS = 1e9;
constexpr std::chrono::milliseconds kLoadPatience{300};  ///< Wait for a step of loading at the end of the server.

link::Welcome make_welcome(const devices::HapticDevice& device, const std::string& tool, double force_scale) {
  const stylus::DevicePreset& preset = device.preset();
  link::Welcome welcome;
  welcome.server = fmt::format("trocar-hapticd {}", kVersion);
  welcome.tool = tool;
  welcome.device = {device.name(),
                    preset.title,
                    preset.sensed_dof,
                    preset.actuated_dof,
                    preset.workspace_radius_mm,
                    preset.capability.peak_force_n,
                    preset.continuous_force_n.value_or(0.0),
                    preset.capability.peak_torque_nmm,
                    force_scale};
  return welcome;
}

}  // namespace

struct HapticServer::Impl {
  Impl(const ServerOptions& options, std::unique_ptr<devices::HapticDevice> the_device, PatientOpener open_patient,
       link::ServerSocket the_socket)
      : params(servo_params(the_device->preset(), options.rate_hz)),
        device(std::move(the_device)),
        crash_handler(std::in_place, *device),
        socket(std::move(the_socket)),
        url(socket.bound_url()),
        shared(static_cast<std::int64_t>(kNsPerS / options.rate_hz)),
        servo(*device, params),
        control(shared, *device, SceneBuilder(std::move(open_patient), options.tissues_file, device->preset()),
                options.tool, options.flight_folder),
        link(shared, socket, make_welcome(*device, options.tool, params.workspace.force_scale),
             options.priority > 0 ? kLinkPriority : 0) {
    shared.crash_handler = &*crash_handler;
    shared.log_limit = socket.log_limit();
  }
  ~Impl() {
    stop();
    if (control_thread.joinable()) control_thread.join();
  }

  /// After an error, the destructor ends the threads that have started.
  Status start_threads(const ThreadStarter& starter, int priority) {
    control.check_flights();
    TROCAR_TRY(control_thread, starter("control", [this] {
                 control.run();
                 control_end.set_value();
               }));
    TROCAR_TRY(link_thread, starter("link", [this] { link.run(); }));
    TROCAR_TRY(servo_thread, starter("real-time", [this, priority] { run_servo_thread(shared, servo, priority); }));
    return {};
  }

  /// Returns false if the control thread still runs after kLoadPatience.
  bool wait_for_control() {
    if (!control_thread.joinable()) return true;
    if (control_end.get_future().wait_for(kLoadPatience) != std::future_status::ready) return false;
    control_thread.join();
    return true;
  }

  /// The control thread has ended, or loads a scene, which does not write flight records.
  void write_late(const Flight& flight) {
    const Result<std::string> written = control.write(flight);
    log_warning("{}", written ? *written : written.error().text());
  }

  ServerReport stop() {
    if (shared.is_stopping) return {};
    shared.is_fading = true;
    constexpr double kMargin_s = 0.05;
    if (servo_thread.joinable())
      std::this_thread::sleep_for(std::chrono::duration<double>(params.gate.fade_s + kMargin_s));
    shared.is_stopping = true;
    if (servo_thread.joinable()) servo_thread.join();
    if (link_thread.joinable()) link_thread.join();
    shared.control_queue.close();
    const bool has_ended = wait_for_control();
    for (const Flight& flight : shared.control_queue.take_flights()) write_late(flight);
    // Loading a scene does not access the device; reopening it does.
    const bool is_loading = !has_ended && shared.control_queue.status().loading > 0.0;
    if (is_loading) {
      crash_handler.reset();
      device.reset();
    }
    return {is_loading,       shared.statistics.newest().summary(), shared.grant, link.ticks(), shared.records_dropped,
            socket.refused(), socket.batches_not_taken(),           shared.stops};
  }

  ServoParams params;
  std::unique_ptr<devices::HapticDevice> device;
  std::optional<CrashHandler> crash_handler;
  link::ServerSocket socket;
  std::string url;
  Shared shared;
  Servo servo;
  Control control;
  LinkThread link;
  std::promise<void> control_end;
  std::thread control_thread, link_thread, servo_thread;
};

HapticServer::HapticServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HapticServer::HapticServer(HapticServer&&) noexcept = default;
HapticServer& HapticServer::operator=(HapticServer&&) noexcept = default;
HapticServer::~HapticServer() = default;

Result<HapticServer> HapticServer::start(const ServerOptions& options, std::unique_ptr<devices::HapticDevice> device,
                                         PatientOpener open_patient, const ThreadStarter& starter) {
  constexpr double kSlowest_hz = 250.0, kFastest_hz = 4000.0;
  if (!(options.rate_hz >= kSlowest_hz && options.rate_hz <= kFastest_hz))
    return fail_usage(
        fmt::format("rate {} Hz is not between {:.0f} and {:.0f}", options.rate_hz, kSlowest_hz, kFastest_hz), "--rate",
        "choose a rate in this range");
  TROCAR_TRY_STATUS(haptics::parse_tool(options.tool));
  TROCAR_TRY(link::ServerSocket socket, link::ServerSocket::bind(options.endpoint, options.security));
  auto impl = std::make_unique<Impl>(options, std::move(device), std::move(open_patient), std::move(socket));
  TROCAR_TRY_STATUS(impl->start_threads(starter, options.priority));
  return HapticServer(std::move(impl));
}

void HapticServer::load(const link::LoadScene& request) {
  impl_->shared.control_queue.post({0, 0, request});
}

std::string HapticServer::url() const {
  return impl_->url;
}

ServerReport HapticServer::stop() {
  return impl_->stop();
}

}  // namespace trocar::server
