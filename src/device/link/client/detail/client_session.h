#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "link/client/detail/client_mailbox.h"
#include "link/client/detail/clock_offset.h"
#include "link/messages.h"

namespace trocar::link::detail {

/// State of a client's session with its server. Uses neither sockets nor clocks. Results for the caller go to the
/// mailbox.
class ClientSession {
 public:
  explicit ClientSession(ClientMailbox& mailbox) : mailbox_(mailbox) {}

  bool is_welcomed() const { return session_ != 0; }
  std::uint64_t ticks_received() const { return ticks_received_; }
  /// Handles a message of the server. Returns false if the message was refused: it is not of this session, old, or a
  /// refusal without a session.
  bool take(ServerMessage message, double now_s);
  /// Counts a received message that is invalid.
  void refuse();
  /// Makes the next message of this session, with this body.
  ClientMessage message(ClientBody body);
  /// Call it after a command was sent. The command gets a reply from the server, or one from lose().
  void expect_reply(std::uint32_t request) { waiting_.push_back(request); }
  /// Ends the session: commands without a reply get an error reply.
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
