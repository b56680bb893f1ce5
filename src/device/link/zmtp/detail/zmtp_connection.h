#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "link/messages.h"
#include "link/zmtp/detail/curve_handshake.h"
#include "link/zmtp/detail/peer_table.h"
#include "link/zmtp/detail/zmtp_frames.h"

namespace trocar::link::detail {

inline constexpr std::size_t kReadAtOnce = 64 * 1024;  ///< Most bytes that are read from a socket in one call.

/// The server's side of one ZMTP 3 connection, without its socket: bytes in, messages and bytes out. Its buffers and
/// rates are bounded in bytes and frames for any input. Mechanisms: NULL, or CURVE with an identity.
class ZmtpConnection {
 public:
  /// `identity` must outlive the connection; null: the mechanism is NULL.
  explicit ZmtpConnection(const CurveIdentity* identity);

  enum class Event {
    kNone,       ///< No complete frame, or the rate limit was reached.
    kReady,      ///< The handshake is done: identity() is valid.
    kMessage,    ///< One message of one frame.
    kMultipart,  ///< The beginning of a message of several frames: it is skipped.
    kTooLarge,   ///< A message above the size limit: it is skipped.
    kBroken,     ///< The connection cannot continue; why() has the reason.
  };
  struct Incoming {
    Event event = Event::kNone;
    std::span<const std::byte> message;  ///< Valid until the next call.
  };

  /// Number of bytes that may be read from the socket now; 0: the rate limit was reached, or a buffer is full.
  std::size_t room(double now_s);
  void append(std::span<const std::byte> bytes);
  Incoming next(double now_s);

  /// A peer that has sent Hello may send kMostMessageBytes, another peer kMostBytesBeforeHello.
  void set_greeted(bool is_greeted) { is_greeted_ = is_greeted; }
  bool is_greeted() const { return is_greeted_; }
  /// Routing id of the peer, preceded by its key if it has one. Empty before the handshake is done, or if the peer gave
  /// none.
  const std::string& identity() const { return identity_; }
  bool is_ready() const { return state_ == State::kTraffic; }
  const std::string& why() const { return why_; }

  /// Queues a message. Returns false if more than `most_waiting` bytes would be queued for the peer, or the handshake
  /// is not done.
  bool put(std::span<const std::byte> message, std::size_t most_waiting = kMostBytesOut);
  std::span<const std::byte> outgoing() const { return std::span<const std::byte>(out_).subspan(out_sent_); }
  void note_sent(std::size_t bytes);

 private:
  enum class State { kGreeting, kHandshake, kTraffic, kBroken };
  bool read_greeting();
  void take_handshake(std::span<const std::byte> command);
  void take_metadata(std::span<const std::byte> metadata);
  void put_error();
  Incoming take_frame(const FrameReader::Frame& frame);
  Incoming take_part(std::uint8_t flags, std::span<const std::byte> payload);
  void answer_command(std::span<const std::byte> command);
  Incoming break_off(std::string why);

  State state_ = State::kGreeting;
  std::optional<CurveHandshake> curve_;
  std::string_view mechanism_;
  FrameReader in_;
  TokenBucket bytes_, frames_;
  std::vector<std::byte> out_, opened_;
  std::size_t out_sent_ = 0;
  std::size_t multipart_bytes_ = 0;
  int multipart_frames_ = 0;  ///< Frames so far of the message that is skipped; 0: none.
  bool is_greeted_ = false;
  std::string identity_, why_;
};

}  // namespace trocar::link::detail
