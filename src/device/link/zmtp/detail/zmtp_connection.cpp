#include "link/zmtp/detail/zmtp_connection.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "link/messages.h"

namespace trocar::link::detail {
namespace {

constexpr std::size_t kMostHandshakeBytes = 1024;  ///< The longest command of RFC 26 has 257 bytes plus metadata.
constexpr std::size_t kFrameOverhead = 64;         ///< Of ZMTP and CURVE, in the queue of a peer.
constexpr std::size_t kCurveOverhead = 33;         ///< Bytes of a MESSAGE command of RFC 26 besides the payload.
constexpr std::size_t kMostIdentityBytes = 255;    ///< RFC 23
/// A connection that announces a larger frame is closed; a smaller frame beyond the limit is skipped.
constexpr std::size_t kCutOffBytes = 2 * kMostMessageBytes;
constexpr int kMostSkippedFrames = 64;
constexpr std::uint8_t kCurveMore = 1, kCurveCommand = 2;  ///< Flags in a MESSAGE box.
constexpr std::string_view kReadyName = "\x05READY",
                           kErrorName =
                               "\x05"
                               "ERROR",
                           kRefusedStatus =
                               "\x03"
                               "400";
constexpr std::string_view kSocketType = "ROUTER", kClientSocketType = "DEALER";
constexpr std::string_view kPingName = "\x04PING", kPongName = "\x04PONG";
constexpr std::size_t kPingLifetimeBytes = 2, kMostPingContext = 16;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}
bool begins_with(std::span<const std::byte> bytes, std::string_view name) {
  return bytes.size() >= name.size() && std::memcmp(bytes.data(), name.data(), name.size()) == 0;
}

}  // namespace

ZmtpConnection::ZmtpConnection(const CurveIdentity* identity)
    : mechanism_(identity == nullptr ? "NULL" : "CURVE"),
      bytes_(kMostBytesPerS, kMostBytesAtOnce),
      frames_(kMostMessagesPerS, kMostMessagesAtOnce) {
  if (identity != nullptr) curve_.emplace(*identity);
  out_ = zmtp::make_greeting(mechanism_, curve_.has_value());
}

std::size_t ZmtpConnection::room(double now_s) {
  bytes_.refill(now_s);
  frames_.refill(now_s);
  const bool is_full = outgoing().size() > kMostBytesOut || in_.held() > kCutOffBytes;
  if (state_ == State::kBroken || is_full || !bytes_.has_tokens() || !frames_.has_tokens()) return 0;
  return kReadAtOnce;
}

void ZmtpConnection::append(std::span<const std::byte> bytes) {
  bytes_.take(static_cast<double>(bytes.size()));
  in_.append(bytes);
}

ZmtpConnection::Incoming ZmtpConnection::next(double now_s) {
  frames_.refill(now_s);
  while (state_ != State::kBroken && frames_.has_tokens()) {
    if (state_ == State::kGreeting && !read_greeting()) break;
    if (state_ == State::kBroken) break;
    const bool is_traffic = state_ == State::kTraffic;
    const std::size_t overhead = curve_ ? kCurveOverhead : 0;
    const std::size_t most = !is_traffic   ? kMostHandshakeBytes
                             : is_greeted_ ? kMostMessageBytes + overhead
                                           : kMostBytesBeforeHello + overhead;
    const std::size_t cut_off = is_traffic && is_greeted_ ? kCutOffBytes + overhead : most;
    FrameReader::Frame frame;
    const FrameReader::Outcome outcome = in_.next(most, cut_off, frame);
    if (outcome == FrameReader::Outcome::kNone) break;
    frames_.take(1.0);
    if (outcome == FrameReader::Outcome::kBroken) {
      return break_off(is_traffic && !is_greeted_ ? "a message before Hello that is too large, or not ZMTP"
                                                  : "a message that is too large, or not ZMTP");
    }
    if (outcome == FrameReader::Outcome::kTooLarge) return {Event::kTooLarge, {}};
    if (!is_traffic) {
      take_handshake(frame.body);
      if (is_ready()) return {Event::kReady, {}};
      continue;
    }
    const Incoming incoming = take_frame(frame);
    if (incoming.event != Event::kNone) return incoming;
  }
  return {state_ == State::kBroken ? Event::kBroken : Event::kNone, {}};
}

/// Returns false if it is incomplete.
bool ZmtpConnection::read_greeting() {
  const auto greeting = in_.take_raw(zmtp::kGreetingBytes);
  if (greeting.empty()) return false;
  switch (zmtp::check_greeting(greeting, mechanism_)) {
    case zmtp::GreetingFault::kNotZmtp3:
      break_off("a connection that is not ZMTP 3");
      break;
    case zmtp::GreetingFault::kMechanism:
      break_off(curve_ ? "a client without keys, and this server has keys"
                       : "a client with keys, and this server has none");
      break;
    case zmtp::GreetingFault::kNone:
      state_ = State::kHandshake;
      if (curve_) break;
      std::vector<std::byte> ready;
      append_bytes(ready, bytes_of(kReadyName));
      append_bytes(ready, zmtp::make_metadata(kSocketType));
      zmtp::append_frame(out_, zmtp::kCommand, ready);
      break;
  }
  return true;
}

void ZmtpConnection::take_handshake(std::span<const std::byte> command) {
  if (!curve_) {
    if (!begins_with(command, kReadyName)) {
      break_off("no READY after the greeting");
      return;
    }
    take_metadata(command.subspan(kReadyName.size()));
    return;
  }
  auto answer = curve_->answer(command);
  if (!answer) {
    put_error();
    break_off(answer.error().text());
    return;
  }
  if (!curve_->is_done()) {
    zmtp::append_frame(out_, zmtp::kCommand, answer->command);
    return;
  }
  take_metadata(answer->metadata);
  if (state_ == State::kTraffic)
    zmtp::append_frame(out_, zmtp::kCommand, curve_->ready(zmtp::make_metadata(kSocketType)));
}

void ZmtpConnection::take_metadata(std::span<const std::byte> bytes) {
  const zmtp::Metadata metadata = zmtp::read_metadata(bytes);
  if (!metadata.is_valid || metadata.socket_type != kClientSocketType) {
    break_off("a client whose socket is not a DEALER");
    return;
  }
  if (metadata.identity.size() > kMostIdentityBytes || metadata.identity.starts_with('\0')) {
    break_off("a client whose identity has more than 255 bytes, or begins with the byte 0");
    return;
  }
  if (curve_ && !metadata.identity.empty()) {
    const auto& key = curve_->client_key();
    identity_.assign(key.begin(), key.end());
  }
  identity_ += metadata.identity;
  state_ = State::kTraffic;
}

/// The client's library reports the status to its user.
void ZmtpConnection::put_error() {
  std::vector<std::byte> error;
  append_bytes(error, bytes_of(kErrorName));
  append_bytes(error, bytes_of(kRefusedStatus));
  zmtp::append_frame(out_, zmtp::kCommand, error);
}

ZmtpConnection::Incoming ZmtpConnection::take_frame(const FrameReader::Frame& frame) {
  if (!curve_) {
    if ((frame.flags & zmtp::kCommand) == 0) return take_part(frame.flags & zmtp::kMore, frame.body);
    answer_command(frame.body);
    return {};
  }
  auto opened = curve_->open(frame.body);
  if (!opened) return break_off(opened.error().text());
  opened_ = std::move(opened->payload);
  if ((opened->flags & kCurveCommand) == 0) return take_part(opened->flags & kCurveMore, opened_);
  answer_command(opened_);
  return {};
}

ZmtpConnection::Incoming ZmtpConnection::take_part(std::uint8_t more, std::span<const std::byte> payload) {
  if (more == 0 && multipart_frames_ == 0) return {Event::kMessage, payload};
  const bool is_first = multipart_frames_ == 0;
  multipart_bytes_ += payload.size();
  if (!is_greeted_ && multipart_bytes_ > kMostBytesBeforeHello)
    return break_off("a message before Hello that is too large");
  if (++multipart_frames_ > kMostSkippedFrames || multipart_bytes_ > kCutOffBytes) {
    return break_off("a message of frames without end");
  }
  if (more == 0) {
    multipart_frames_ = 0;
    multipart_bytes_ = 0;
  }
  return {is_first ? Event::kMultipart : Event::kNone, {}};
}

void ZmtpConnection::answer_command(std::span<const std::byte> command) {
  if (!begins_with(command, kPingName) || command.size() < kPingName.size() + kPingLifetimeBytes) return;
  const auto context = command.subspan(kPingName.size() + kPingLifetimeBytes);
  if (context.size() > kMostPingContext || outgoing().size() > kMostBytesOut) return;
  std::vector<std::byte> pong;
  append_bytes(pong, bytes_of(kPongName));
  append_bytes(pong, context);
  if (curve_) {
    zmtp::append_frame(out_, 0, curve_->seal(kCurveCommand, pong));
  } else {
    zmtp::append_frame(out_, zmtp::kCommand, pong);
  }
}

bool ZmtpConnection::put(std::span<const std::byte> message, std::size_t most_waiting) {
  if (!is_ready() || outgoing().size() + message.size() + kFrameOverhead > most_waiting) return false;
  if (curve_) {
    zmtp::append_frame(out_, 0, curve_->seal(0, message));
  } else {
    zmtp::append_frame(out_, 0, message);
  }
  return true;
}

void ZmtpConnection::note_sent(std::size_t bytes) {
  out_sent_ += bytes;
  constexpr std::size_t kKept = 128 * 1024;
  if (out_sent_ < out_.size() && out_sent_ < kKept) return;
  out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(out_sent_));
  out_sent_ = 0;
  if (out_.empty() && out_.capacity() > kKept) std::vector<std::byte>().swap(out_);
}

ZmtpConnection::Incoming ZmtpConnection::break_off(std::string why) {
  state_ = State::kBroken;
  why_ = std::move(why);
  return {Event::kBroken, {}};
}

}  // namespace trocar::link::detail
