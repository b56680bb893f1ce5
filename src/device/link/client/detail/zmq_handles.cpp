#include "link/client/detail/zmq_handles.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace trocar::link::detail {

ZmqContext::~ZmqContext() {
  if (context_ == nullptr) return;
  while (zmq_ctx_term(context_) != 0 && zmq_errno() == EINTR) {
  }
}

ZmqSocket& ZmqSocket::operator=(ZmqSocket&& other) noexcept {
  if (this != &other) {
    close();
    socket_ = std::exchange(other.socket_, nullptr);
  }
  return *this;
}

void ZmqSocket::close() noexcept {
  if (socket_ != nullptr) zmq_close(socket_);
  socket_ = nullptr;
}

std::string ZmqSocket::last_endpoint() const {
  std::array<char, 512> text{};
  std::size_t size = text.size();
  if (zmq_getsockopt(socket_, ZMQ_LAST_ENDPOINT, text.data(), &size) != 0) return {};
  return text.data();
}

bool ZmqSocket::send(std::span<const std::byte> bytes, int flags) noexcept {
  int sent = -1;
  do {
    sent = zmq_send(socket_, bytes.data(), bytes.size(), flags);
  } while (sent < 0 && zmq_errno() == EINTR);
  return sent >= 0;
}

bool ZmqSocket::receive(ZmqFrame& frame, int flags) noexcept {
  int size = -1;
  do {
    size = zmq_msg_recv(frame.get(), socket_, flags);
  } while (size < 0 && zmq_errno() == EINTR);
  return size >= 0;
}

void ZmqSocket::drop_rest(ZmqFrame& frame) noexcept {
  while (frame.has_more() && receive(frame, ZMQ_DONTWAIT)) {
  }
}

bool ZmqSocket::wait_readable(int wait_ms) noexcept {
  zmq_pollitem_t item{socket_, 0, ZMQ_POLLIN, 0};
  return zmq_poll(&item, 1, wait_ms) > 0;
}

namespace {

constexpr int kFailures =
    ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

std::string describe(int event, int value) {
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) {
    return "the server refused the keys: the client's key is not in its allow-list, or the server's public key differs";
  }
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL && value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) {
    return "only one side uses keys: use --keys on both sides, or on neither";
  }
  return "the server closed the connection before it was set up";
}

}  // namespace

bool HandshakeMonitor::watch(const ZmqContext& context, ZmqSocket& socket) {
  const std::string address = fmt::format("inproc://handshakes-{}", ++watched_);
  events_ = ZmqSocket();
  if (zmq_socket_monitor(socket.get(), address.c_str(), kFailures) != 0) return false;
  events_ = ZmqSocket(context, ZMQ_PAIR);
  return events_.is_open() && events_.set(ZMQ_LINGER, 0) && zmq_connect(events_.get(), address.c_str()) == 0;
}

std::optional<std::string> HandshakeMonitor::take() {
  if (!events_.is_open()) return {};
  std::optional<std::string> newest;
  ZmqFrame frame;
  while (events_.receive(frame, ZMQ_DONTWAIT)) {
    // A frame with 16 bits of event and 32 bits of value, then the address.
    std::uint16_t event = 0;
    std::uint32_t value = 0;
    if (frame.bytes().size() == sizeof event + sizeof value) {
      std::memcpy(&event, frame.bytes().data(), sizeof event);
      std::memcpy(&value, frame.bytes().data() + sizeof event, sizeof value);
      newest = describe(event, static_cast<int>(value));
    }
    events_.drop_rest(frame);
  }
  return newest;
}

}  // namespace trocar::link::detail
