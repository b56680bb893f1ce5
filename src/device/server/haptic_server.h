#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "link/endpoint.h"
#include "link/messages.h"
#include "link/server_socket.h"
#include "realtime/real_time_grant.h"
#include "server/scene_builder.h"

namespace trocar::server {

struct ServerOptions {
  link::Endpoint endpoint;
  std::optional<link::ServerSecurity> security;
  double rate_hz = 1000.0;      ///< 250..4000
  std::string tool = "needle";  ///< What this server is for: needle | probe | finger. Scenes of others are refused.
  int priority = 80;            ///< Of SCHED_FIFO, for the real-time thread; the link's gets kLinkPriority.
  std::filesystem::path tissues_file;   ///< data/tissues.toml
  std::filesystem::path flight_folder;  ///< Flight records are written here on a fault; empty: not written.
};
inline constexpr int kLinkPriority = 20;

/// Starts a thread. An argument, so that a test can let one fail. Errors: the system has no thread left.
using ThreadStarter = std::function<Result<std::thread>(const char* name, std::function<void()> body)>;
Result<std::thread> start_thread(const char* name, std::function<void()> body);

/// How a server did, for people and benchmarks.
struct ServerReport {
  /// A scene was still being loaded. Threads and device are at rest all the same, but destroying the server waits for
  /// the loading to end: a program that ends calls std::_Exit instead.
  bool is_loading = false;
  realtime::LoopSummary loop;
  realtime::RealTimeGrant grant;
  std::uint64_t ticks = 0, ticks_dropped = 0;
  link::RefusedMessages refused;
  std::uint64_t batches_not_taken = 0;
};

/// A haptic server: a real-time thread for the device, a thread for the link, a control thread for all that takes time
/// (scenes, files, opening the device again). Starts when it is made and stops, forces faded, when it is destroyed.
class HapticServer {
 public:
  /// Errors: the endpoint (see ServerSocket::bind), a rate out of range, a thread that does not start (those that had
  /// started have ended then).
  static Result<HapticServer> start(const ServerOptions& options, std::unique_ptr<devices::HapticDevice> device,
                                    PatientOpener open_patient, const ThreadStarter& starter = start_thread);
  HapticServer(HapticServer&&) noexcept;
  HapticServer& operator=(HapticServer&&) noexcept;
  ~HapticServer();

  /// Loads a scene as a client's message would, without a client.
  void load(const link::LoadScene& request);
  std::string url() const;
  /// Fades the forces, then ends the threads; waits 0.3 s at most for a scene that is being loaded. Once.
  ServerReport stop();

 private:
  struct Impl;
  explicit HapticServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::server
