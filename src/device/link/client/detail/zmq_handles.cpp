#include "link/client/detail/zmq_handles.h"

#include <array>
#include <cerrno>

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

}  // namespace trocar::link::detail
