#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "link/client/detail/client_mailbox.h"
#include "link/client/detail/clock_offset.h"
#include "link/messages.h"

namespace trocar::link::detail {

/// What a client's thread knows of its server, from message to message. Knows neither sockets nor clocks; what the
/// caller may see goes to the mailbox.
class ClientSession {
 public:
  explicit ClientSession(ClientMailbox& mailbox) : mailbox_(mailbox) {}

  bool is_welcomed() const { return session_ != 0; }
  std::uint64_t ticks_received() const { return ticks_received_; }
  /// A message of the server came. False: it was not for this session, or old, and is counted.
  bool take(ServerMessage message, double now_s);
  /// Something came that is no message.
  void refuse();
  /// The next message of this session with such a body.
  ClientMessage message(ClientBody body);
  /// A command went out; it will have a reply, the server's or our own.
  void expect_reply(std::uint32_t request) { waiting_.push_back(request); }
  /// The server is gone: commands that wait are answered so.
  void lose();

 private:
  bool take_body(const Welcome& welcome, double now_s);
  bool take_body(StateBatch& batch, double now_s);
  bool take_body(Reply& reply, double now_s);
  bool take_body(const Pong& pong, double now_s);
  bool take_body(const Refusal& refusal, double now_s);

  ClientMailbox& mailbox_;
  std::uint64_t session_ = 0;
  std::uint64_t last_sent_ = 0, last_received_ = 0;
  std::uint64_t next_tick_ = 0;
  bool knows_next_tick_ = false;
  std::uint64_t ticks_received_ = 0;
  std::uint64_t refused_ = 0;
  ClockOffset clock_;
  std::vector<std::uint32_t> waiting_;  ///< Commands without reply.
};

}  // namespace trocar::link::detail
