#pragma once

#include <zmq.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace trocar::link::detail {

/// Owner of a ZeroMQ context. shut_down() ends the waits of all its sockets (error ETERM), in any thread.
class ZmqContext {
 public:
  ZmqContext() noexcept : context_(zmq_ctx_new()) {}
  ~ZmqContext();
  ZmqContext(const ZmqContext&) = delete;
  ZmqContext& operator=(const ZmqContext&) = delete;

  void* get() const noexcept { return context_; }
  void shut_down() noexcept { zmq_ctx_shutdown(context_); }

 private:
  void* context_;
};

/// One frame that was received; the bytes are the library's and live as long as this.
class ZmqFrame {
 public:
  ZmqFrame() noexcept { zmq_msg_init(&message_); }
  ~ZmqFrame() { zmq_msg_close(&message_); }
  ZmqFrame(const ZmqFrame&) = delete;
  ZmqFrame& operator=(const ZmqFrame&) = delete;

  std::span<const std::byte> bytes() const noexcept {
    return {static_cast<const std::byte*>(zmq_msg_data(&message_)), zmq_msg_size(&message_)};
  }
  std::string_view text() const noexcept {
    return {static_cast<const char*>(zmq_msg_data(&message_)), zmq_msg_size(&message_)};
  }
  bool has_more() const noexcept { return zmq_msg_more(&message_) != 0; }
  zmq_msg_t* get() noexcept { return &message_; }

 private:
  // The library's readers take it unconst.
  mutable zmq_msg_t message_;
};

/// Owner of a socket, used by one thread. Nothing throws; the numbers are the library's (errno where false).
class ZmqSocket {
 public:
  ZmqSocket() noexcept = default;
  ZmqSocket(const ZmqContext& context, int type) noexcept : socket_(zmq_socket(context.get(), type)) {}
  ZmqSocket(ZmqSocket&& other) noexcept : socket_(std::exchange(other.socket_, nullptr)) {}
  ZmqSocket& operator=(ZmqSocket&& other) noexcept;
  ~ZmqSocket() { close(); }

  bool is_open() const noexcept { return socket_ != nullptr; }
  void* get() const noexcept { return socket_; }
  void close() noexcept;

  bool set(int option, int value) noexcept { return zmq_setsockopt(socket_, option, &value, sizeof value) == 0; }
  bool set_long(int option, std::int64_t value) noexcept {
    return zmq_setsockopt(socket_, option, &value, sizeof value) == 0;
  }
  bool set_text(int option, std::string_view value) noexcept {
    return zmq_setsockopt(socket_, option, value.data(), value.size()) == 0;
  }
  /// A key in Z85 or a text that the library wants with its closing zero.
  bool set_key(int option, const std::string& value) noexcept {
    return zmq_setsockopt(socket_, option, value.c_str(), value.size() + 1) == 0;
  }
  std::string last_endpoint() const;

  /// False: not sent, and errno says why.
  bool send(std::span<const std::byte> bytes, int flags) noexcept;
  bool send(std::string_view text, int flags) noexcept { return send(std::as_bytes(std::span(text)), flags); }
  bool receive(ZmqFrame& frame, int flags) noexcept;
  /// Drops what is left of a message whose last frame that was read is `frame`.
  void drop_rest(ZmqFrame& frame) noexcept;
  /// Waits for something to receive, at most so long (ms; -1: for ever).
  bool wait_readable(int wait_ms) noexcept;

 private:
  void* socket_ = nullptr;
};

}  // namespace trocar::link::detail
