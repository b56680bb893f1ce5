#include "link/zmtp/detail/handshake_monitor.h"

#include <fmt/format.h>

#include <cstring>

namespace trocar::link::detail {
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
