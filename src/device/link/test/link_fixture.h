#pragma once

#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/files/folders.h"
#include "link/codec.h"
#include "link/endpoint.h"
#include "link/server_socket.h"
#include "realtime/periodic_loop.h"

namespace trocar::testing {

/// Timeout of a test for an expected event; a passing test never waits so long.
inline constexpr std::chrono::seconds kPatience(30);
inline constexpr int kPatience_ms = 30'000;

/// Polls until `is_so` returns true. Returns false after kPatience.
inline bool eventually(const std::function<bool()>& is_so) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

inline link::Endpoint ipc_endpoint(const TemporaryFolder& folder) {
  return {"ipc://" + (folder / "socket").string(), false};
}
/// An endpoint that is unique in this program.
inline link::Endpoint any_endpoint() {
  static const TemporaryFolder folder;
  static std::atomic<int> count = 0;
  return {"ipc://" + (folder / std::to_string(++count)).string(), false};
}
inline link::Endpoint any_port() {
  return {"tcp://127.0.0.1:0", true};
}

inline link::Welcome test_welcome() {
  link::Welcome welcome;
  welcome.server = "a server";
  welcome.tool = "needle";
  welcome.device.name = "virtual";
  return welcome;
}

/// Writes another version into an encoded message.
inline void set_version(link::Bytes& bytes, std::uint32_t version) {
  const auto at = [&](std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  };
  // The root's table begins with the offset back to its vtable. The third number of the vtable is the offset of the
  // first field.
  const std::size_t table = at(0);
  const std::size_t vtable = table - at(table);
  std::uint16_t field = 0;
  std::memcpy(&field, bytes.data() + vtable + 4, sizeof field);
  std::memcpy(bytes.data() + table + field, &version, sizeof version);
}

/// Consecutive ticks; the time of each tick is its number.
inline link::StateBatch test_batch(std::uint64_t first, std::size_t count) {
  link::StateBatch batch;
  batch.first_tick = first;
  for (std::size_t i = 0; i < count; ++i) {
    telemetry::TickSample sample;
    sample.time_s = static_cast<double>(first + i);
    batch.samples.push_back(sample);
  }
  return batch;
}

/// A server in a thread: answers commands, records received messages, and runs calls of a test between them.
class RunningServer {
 public:
  explicit RunningServer(const link::Endpoint& endpoint, std::optional<link::ServerSecurity> security = {}) {
    auto socket = link::ServerSocket::bind(endpoint, std::move(security));
    if (!socket) {
      error_ = socket.error().text();
      return;
    }
    url_ = socket->bound_url();
    thread_ = std::thread([this, server = std::move(*socket)]() mutable { run(server); });
  }
  ~RunningServer() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }
  const std::string& url() const { return url_; }
  const std::string& error() const { return error_; }

  /// Runs `call` in the server's thread and waits until it has returned.
  void with_socket(const std::function<void(link::ServerSocket&)>& call) {
    std::atomic<bool> is_done = false;
    {
      const std::lock_guard lock(mutex_);
      calls_.push_back([&](link::ServerSocket& socket) {
        call(socket);
        is_done = true;
      });
    }
    eventually([&] { return is_done.load(); });
  }
  void send(const link::StateBatch& batch) {
    with_socket([&](link::ServerSocket& socket) { socket.send_batch(batch); });
  }
  template <class Body>
  std::vector<Body> received() {
    const std::lock_guard lock(mutex_);
    std::vector<Body> bodies;
    for (const link::Received& one : received_) {
      if (const auto* body = std::get_if<Body>(&one.body)) bodies.push_back(*body);
    }
    return bodies;
  }

 private:
  void run(link::ServerSocket& server) {
    const link::Welcome welcome = test_welcome();
    while (!is_stopping_) {
      auto got = server.receive(1, welcome, realtime::seconds(realtime::now_ns()));
      std::vector<std::function<void(link::ServerSocket&)>> calls;
      {
        const std::lock_guard lock(mutex_);
        if (got) received_.push_back(*got);
        calls.swap(calls_);
      }
      for (const auto& call : calls) call(server);
      if (!got) continue;
      if (const auto* command = std::get_if<link::Command>(&got->body)) {
        const bool is_done = std::holds_alternative<link::ServerCommand>(command->what);
        server.send_reply(got->session, {command->request, is_done, is_done ? "done" : "this server only obeys"});
      }
    }
  }

  std::string url_, error_;
  std::mutex mutex_;
  std::vector<link::Received> received_;
  std::vector<std::function<void(link::ServerSocket&)>> calls_;
  std::atomic<bool> is_stopping_ = false;
  std::thread thread_;
};

}  // namespace trocar::testing
