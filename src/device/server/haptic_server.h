#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/result.h"
#include "core/start_thread.h"
#include "devices/haptic_device.h"
#include "link/endpoint.h"
#include "link/messages.h"
#include "link/server_socket.h"
#include "realtime/periodic_loop.h"
#include "server/scene_builder.h"
#include "server/servo_commands.h"

namespace trocar::server {

struct ServerOptions {
  link::Endpoint endpoint;
  std::optional<link::ServerSecurity> security;
  double rate_hz = 1000.0;      ///< 250..4000
  std::string tool = "needle";  ///< Tool of this server: needle | probe | finger. Scenes of other tools are refused.
  int priority = 80;            ///< SCHED_FIFO priority of the real-time thread; the link thread has kLinkPriority.
  std::filesystem::path tissues_file;   ///< data/tissues.toml
  std::filesystem::path flight_folder;  ///< Flight records are written here on a fault; empty: not written.
};
inline constexpr int kLinkPriority = 20;

/// start_thread(), or that of a test that makes a thread fail.
using ThreadStarter = std::function<Result<std::thread>(const char* name, std::function<void()> body)>;

/// Statistics of a server, for messages and benchmarks.
struct ServerReport {
  /// A scene was still being loaded. The other threads have ended and the device is closed, but the destructor of the
  /// server waits until the loading ends. A program that exits calls std::_Exit instead.
  bool is_loading = false;
  realtime::LoopSummary loop;
  realtime::RealTimeGrant grant;
  std::uint64_t ticks = 0, ticks_dropped = 0;
  link::RefusedMessages refused;
  std::uint64_t batches_not_taken = 0;
  StopStatistics stops;
};

/// A haptic server: a real-time thread for the device, a thread for the link, and a control thread for slow work
/// (scenes, files, reopening the device). start() starts it. The destructor fades the forces and stops it.
class HapticServer {
 public:
  /// Errors: the endpoint (see ServerSocket::bind), a rate out of range, or a thread that does not start (the threads
  /// that had started have then ended).
  static Result<HapticServer> start(const ServerOptions& options, std::unique_ptr<devices::HapticDevice> device,
                                    PatientOpener open_patient, const ThreadStarter& starter = start_thread);
  HapticServer(HapticServer&&) noexcept;
  HapticServer& operator=(HapticServer&&) noexcept;
  ~HapticServer();

  /// Loads a scene like the LoadScene message of a client, without a client.
  void load(const link::LoadScene& request);
  std::string url() const;
  /// Fades the forces, then ends the threads; waits at most 0.3 s for a scene that is being loaded. Call it once.
  ServerReport stop();

 private:
  struct Impl;
  explicit HapticServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::server
