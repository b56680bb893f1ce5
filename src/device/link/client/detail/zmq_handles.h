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

/// One received frame. The library owns the bytes; they are valid during the lifetime of this object.
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
  // The library's read functions take a non-const pointer.
  mutable zmq_msg_t message_;
};

/// Owner of a socket, used by one thread. No function throws. Options and flags are those of the library; errno is set
/// if a function returns false.
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
  /// Sets a key in Z85 or a text that the library needs with its terminating zero.
  bool set_key(int option, const std::string& value) noexcept {
    return zmq_setsockopt(socket_, option, value.c_str(), value.size() + 1) == 0;
  }
  std::string last_endpoint() const;

  /// Returns false if it was not sent; errno has the reason.
  bool send(std::span<const std::byte> bytes, int flags) noexcept;
  bool send(std::string_view text, int flags) noexcept { return send(std::as_bytes(std::span(text)), flags); }
  bool receive(ZmqFrame& frame, int flags) noexcept;
  /// Drops the remaining frames of a message. `frame`: the last frame that was read.
  void drop_rest(ZmqFrame& frame) noexcept;
  /// Waits for data to receive, at most `wait_ms` (-1: no limit).
  bool wait_readable(int wait_ms) noexcept;

 private:
  void* socket_ = nullptr;
};

/// Reports why connections of a client's socket fail during the handshake: wrong keys, or keys on only one side.
class HandshakeMonitor {
 public:
  /// Watches `socket` from now on. Returns false if this is not possible; take() then returns nothing.
  bool watch(const ZmqContext& context, ZmqSocket& socket);
  /// Returns the newest failure since the last call.
  std::optional<std::string> take();

 private:
  ZmqSocket events_;
  int watched_ = 0;
};

}  // namespace trocar::link::detail
