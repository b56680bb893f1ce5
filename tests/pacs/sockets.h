#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace trocar::pacs_test {

/// A port of this machine that nobody uses now.
int free_port();

/// A connection to a port of this machine; -1: refused. The caller closes it.
int connect_to(int port);

// Bytes of a connection. Nothing is reported: tests look at what the program says.
void send_all(int socket, std::string_view bytes);
/// Fewer bytes if the other end closes.
std::string receive_exactly(int socket, std::size_t count);
/// Up to the end of an HTTP header.
std::string receive_header(int socket);
/// Returns when the other end closes.
void wait_for_close(int socket);

/// A server on the loopback interface, in a thread: serves one connection after the other with the functions of
/// `serve`, the last one again and again. The destructor closes all.
class FakeServer {
 public:
  using Serve = std::function<void(int socket)>;
  explicit FakeServer(std::vector<Serve> serve);
  ~FakeServer();
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  int port() const { return port_; }

 private:
  void run();

  std::vector<Serve> serve_;
  int listener_ = -1;
  int port_ = 0;
  std::mutex mutex_;
  int connection_ = -1;  ///< Open now; guarded by mutex_.
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace trocar::pacs_test
