#include "pacs/sockets.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace trocar::pacs_test {
namespace {

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

std::pair<int, int> listen_somewhere() {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  ::bind(listener, reinterpret_cast<sockaddr*>(&address), size);
  ::listen(listener, 8);
  ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  return {listener, ntohs(address.sin_port)};
}

}  // namespace

int free_port() {
  const auto [listener, port] = listen_somewhere();
  ::close(listener);
  return port;
}

int connect_to(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return socket;
  ::close(socket);
  return -1;
}

void send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::string receive_exactly(int socket, std::size_t count) {
  std::string bytes(count, '\0');
  std::size_t at = 0;
  while (at < count) {
    const ssize_t got = ::recv(socket, bytes.data() + at, count - at, 0);
    if (got <= 0) break;
    at += static_cast<std::size_t>(got);
  }
  bytes.resize(at);
  return bytes;
}

std::string receive_header(int socket) {
  std::string header;
  while (!header.ends_with("\r\n\r\n")) {
    const std::string byte = receive_exactly(socket, 1);
    if (byte.empty()) break;
    header += byte;
  }
  return header;
}

void wait_for_close(int socket) {
  while (!receive_exactly(socket, 1).empty()) {
  }
}

FakeServer::FakeServer(std::vector<Serve> serve) : serve_(std::move(serve)) {
  std::tie(listener_, port_) = listen_somewhere();
  thread_ = std::thread([this] { run(); });
}

FakeServer::~FakeServer() {
  ends_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  {
    const std::lock_guard lock(mutex_);
    if (connection_ >= 0) ::shutdown(connection_, SHUT_RDWR);
  }
  thread_.join();
  ::close(listener_);
}

void FakeServer::run() {
  for (std::size_t n = 0; !ends_; ++n) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    {
      const std::lock_guard lock(mutex_);
      connection_ = socket;
    }
    if (!ends_) serve_[std::min(n, serve_.size() - 1)](socket);
    const std::lock_guard lock(mutex_);
    connection_ = -1;
    ::close(socket);
  }
}

}  // namespace trocar::pacs_test
