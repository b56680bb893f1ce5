#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "core/files/folders.h"

namespace trocar::testing {

/// A stand-in for spacenavd on a socket in its own folder; $SPNAV_SOCKET names it during the lifetime of this object.
/// It serves one client at a time. An event is eight 32-bit integers: the kind, then its data.
class SpacenavDaemon {
 public:
  /// `speaks_version_1`: false: like daemons before 1.0, which do not answer the version request.
  explicit SpacenavDaemon(bool speaks_version_1 = true);
  ~SpacenavDaemon();
  SpacenavDaemon(const SpacenavDaemon&) = delete;
  SpacenavDaemon& operator=(const SpacenavDaemon&) = delete;

  void push_cap(const std::array<int, 6>& counts);
  void press(int button, bool is_pressed);
  void unplug_device();
  /// Sends any bytes to the client.
  void send(std::string_view bytes);
  void hang_up();
  bool is_connected() const { return is_connected_; }

 private:
  void serve();
  void send_event(const std::array<std::int32_t, 8>& event);

  TemporaryFolder folder_;
  std::string path_;
  bool speaks_version_1_;
  int listener_ = -1;
  std::atomic<bool> is_stopping_{false};
  std::atomic<bool> is_connected_{false};
  std::mutex mutex_;
  int client_ = -1;
  std::thread thread_;
};

}  // namespace trocar::testing
