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

inline constexpr std::int64_t kBeat_ns = 10'000'000;  ///< Heartbeat period of the client thread.

/// Requests of the caller to the client thread.
struct Outgoing {
  std::vector<Command> commands;
  std::optional<HandTarget> hand;  ///< Newest hand target.
  bool is_leaving = false;
};

/// Data exchanged between the caller of a HapticClient and its thread. The lock is held only for short copies, never
/// during a socket call.
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
  /// Wait for a reply with this number, or for a connected server. They return empty or false after a timeout.
  std::optional<Reply> wait_reply(std::uint32_t request, std::chrono::milliseconds timeout);
  bool wait_heard(std::chrono::milliseconds timeout);

  // The thread's side.
  Outgoing take_outgoing();
  void put_welcome(const Welcome& welcome, bool is_new);
  /// Counts a heartbeat of the thread, which is ready to receive.
  void put_beat();
  /// Call it for every valid message of the server: resets the timeout.
  void put_heard();
  void put_clock(double offset_s, double round_trip_s);
  void put_batch(StateBatch batch, std::uint64_t missing_before);
  void put_reply(Reply reply);
  void put_lost();
  void put_refused(std::uint64_t messages_refused);
  /// Sets the reason why the server refused the connection or a message.
  void put_refusal(std::string text);

 private:
  bool is_connected() const;  ///< Call it with the lock held.

  mutable std::mutex mutex_;
  std::condition_variable news_;
  Outgoing outgoing_;
  ClientView view_;
  int silent_beats_ = 0;  ///< Since the last message of the server; since the start if there was none.
  bool has_session_ = false;
  std::deque<StateBatch> batches_;
  std::size_t samples_held_ = 0;
  std::optional<telemetry::TickSample> newest_;
  std::deque<Reply> replies_;
};

}  // namespace trocar::link::detail
