#include "devices/testing/spacenav_daemon.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace trocar::testing {
namespace {

// spacenavd's protocol (libspnav, src/proto.h).
constexpr std::int32_t kMotion = 0;
constexpr std::int32_t kPress = 1;
constexpr std::int32_t kRelease = 2;
constexpr std::int32_t kDeviceMessage = 3;
constexpr std::int32_t kDeviceRemoved = 1;
constexpr int kPeriod_ms = 16;

}  // namespace

SpacenavDaemon::SpacenavDaemon(bool speaks_version_1)
    : path_((folder_.path() / "spnav.sock").string()), speaks_version_1_(speaks_version_1) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy_n(path_.c_str(), std::min(path_.size() + 1, sizeof address.sun_path), address.sun_path);
  listener_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT_EQ(::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::listen(listener_, 1), 0);
  ::setenv("SPNAV_SOCKET", path_.c_str(), 1);
  thread_ = std::thread([this] { serve(); });
}

SpacenavDaemon::~SpacenavDaemon() {
  is_stopping_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  hang_up();
  thread_.join();
  ::close(listener_);
  ::unsetenv("SPNAV_SOCKET");
}

void SpacenavDaemon::serve() {
  while (!is_stopping_) {
    const int client = ::accept(listener_, nullptr, nullptr);
    if (client < 0) return;
    std::int32_t word = 0;
    if (speaks_version_1_ && ::read(client, &word, sizeof word) == sizeof word) {
      EXPECT_EQ(::send(client, &word, sizeof word, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof word));
    }
    {
      const std::lock_guard lock(mutex_);
      client_ = client;
    }
    is_connected_ = true;
    while (::read(client, &word, sizeof word) > 0) {
    }
    const std::lock_guard lock(mutex_);
    is_connected_ = false;
    ::close(client);
    client_ = -1;
  }
}

void SpacenavDaemon::push_cap(const std::array<int, 6>& c) {
  send_event({kMotion, c[0], c[1], c[2], c[3], c[4], c[5], kPeriod_ms});
}

void SpacenavDaemon::press(int button, bool is_pressed) {
  send_event({is_pressed ? kPress : kRelease, button});
}

void SpacenavDaemon::unplug_device() {
  send_event({kDeviceMessage, kDeviceRemoved});
}

void SpacenavDaemon::send_event(const std::array<std::int32_t, 8>& event) {
  send({reinterpret_cast<const char*>(event.data()), sizeof event});
}

void SpacenavDaemon::send(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (client_ < 0) return;
  EXPECT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
}

void SpacenavDaemon::hang_up() {
  const std::lock_guard lock(mutex_);
  if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);
}

}  // namespace trocar::testing
