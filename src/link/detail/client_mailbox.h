#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "link/haptic_client.h"

namespace trocar::detail {

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
  /// is_connected and silent_s are as of now_s.
  ClientView view(double now_s) const;
  std::vector<NumberedSample> take_samples();
  std::optional<TickSample> newest() const;
  std::vector<Reply> take_replies();
  /// Waits for a reply with this number, or for a server. Empty, false: not within that time.
  std::optional<Reply> wait_reply(std::uint32_t request, std::chrono::milliseconds patience);
  bool wait_heard(std::chrono::milliseconds patience);

  // The thread's side.
  Outgoing take_outgoing();
  void put_welcome(const Welcome& welcome, bool is_new);
  /// A sign of life.
  void put_heard(double now_s);
  void put_clock(double offset_s, double round_trip_s);
  void put_batch(StateBatch batch, std::uint64_t missing_before);
  void put_reply(Reply reply);
  void put_lost();
  void put_refused(std::uint64_t messages_refused);

  explicit ClientMailbox(double start_s) : heard_s_(start_s) {}

 private:
  bool is_connected(double now_s) const;  ///< With the lock.

  mutable std::mutex mutex_;
  std::condition_variable news_;
  Outgoing outgoing_;
  ClientView view_;
  double heard_s_;  ///< Steady clock; the start when never.
  bool has_session_ = false;
  std::deque<StateBatch> batches_;
  std::size_t samples_held_ = 0;
  std::optional<TickSample> newest_;
  std::deque<Reply> replies_;
};

}  // namespace trocar::detail
