#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "link/client/haptic_client.h"

namespace trocar::link::detail {

inline constexpr std::int64_t kBeat_ns = 10'000'000;  ///< Between two beats of a client's thread.

/// What the caller wants of the client's thread.
struct Outgoing {
  std::vector<Command> commands;
  std::optional<HandTarget> hand;  ///< The newest.
  bool is_leaving = false;
};

/// Between the caller of a HapticClient and its thread. The lock is held for short copies only, never across a socket.
class ClientMailbox {
 public:
  // The caller's side.
  void post(Command command);
  void post(const HandTarget& hand);
  void leave();
  ClientView view() const;
  std::vector<NumberedSample> take_samples();
  std::optional<telemetry::TickSample> newest() const;
  std::vector<Reply> take_replies();
  /// Waits for a reply with this number, or for a server. Empty, false: not within that time.
  std::optional<Reply> wait_reply(std::uint32_t request, std::chrono::milliseconds patience);
  bool wait_heard(std::chrono::milliseconds patience);

  // The thread's side.
  Outgoing take_outgoing();
  void put_welcome(const Welcome& welcome, bool is_new);
  /// A beat of the thread's clock: it is ready to hear.
  void put_beat();
  /// A sign of life.
  void put_heard();
  void put_clock(double offset_s, double round_trip_s);
  void put_batch(StateBatch batch, std::uint64_t missing_before);
  void put_reply(Reply reply);
  void put_lost();
  void put_refused(std::uint64_t messages_refused);
  /// Why the server does not talk to us, or did not take a message.
  void put_refusal(std::string text);

 private:
  bool is_connected() const;  ///< With the lock.

  mutable std::mutex mutex_;
  std::condition_variable news_;
  Outgoing outgoing_;
  ClientView view_;
  int silent_beats_ = 0;  ///< Since the server was last heard; since the start when never.
  bool has_session_ = false;
  std::deque<StateBatch> batches_;
  std::size_t samples_held_ = 0;
  std::optional<telemetry::TickSample> newest_;
  std::deque<Reply> replies_;
};

}  // namespace trocar::link::detail
