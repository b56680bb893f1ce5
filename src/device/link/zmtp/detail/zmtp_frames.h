#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace trocar::link::detail {

inline void append_bytes(std::vector<std::byte>& bytes, std::span<const std::byte> more) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + more.size());
  if (!more.empty()) std::memcpy(bytes.data() + begin, more.data(), more.size());
}

/// ZMTP 3 (ZeroMQ RFC 23): greeting, frames and metadata of a connection, without sockets.
namespace zmtp {

inline constexpr std::size_t kGreetingBytes = 64;
inline constexpr std::size_t kMostMechanismBytes = 20;
inline constexpr std::uint8_t kMore = 1, kLong = 2, kCommand = 4;  ///< Flag bits of a frame.

std::vector<std::byte> make_greeting(std::string_view mechanism, bool is_server);
enum class GreetingFault { kNone, kNotZmtp3, kMechanism };
/// Checks a greeting of 64 bytes.
GreetingFault check_greeting(std::span<const std::byte> greeting, std::string_view mechanism);

void append_frame(std::vector<std::byte>& bytes, std::uint8_t flags, std::span<const std::byte> body);
std::vector<std::byte> make_metadata(std::string_view socket_type);
struct Metadata {
  bool is_valid = false;
  std::string_view socket_type, identity;  ///< Point into the bytes that were read.
};
Metadata read_metadata(std::span<const std::byte> bytes);

}  // namespace zmtp

/// Splits a stream of bytes into frames. Buffers at most one frame of the size limit and the bytes appended last.
class FrameReader {
 public:
  enum class Outcome {
    kNone,      ///< More bytes are needed.
    kFrame,     ///< A whole frame.
    kTooLarge,  ///< A frame above the size limit: reported once, its body is skipped.
    kBroken,    ///< Not a frame, or above the cut-off: the connection cannot continue.
  };
  struct Frame {
    std::uint8_t flags = 0;
    std::span<const std::byte> body;  ///< Valid until the next call.
  };

  void append(std::span<const std::byte> bytes);
  /// Takes the first `count` bytes unparsed (the greeting); empty if fewer are buffered.
  std::span<const std::byte> take_raw(std::size_t count);
  Outcome next(std::size_t most_bytes, std::size_t cut_off_bytes, Frame& frame);
  std::size_t held() const { return bytes_.size() - begin_; }

 private:
  void drop_taken();

  std::vector<std::byte> bytes_;
  std::size_t begin_ = 0;    ///< The bytes before it were taken.
  std::size_t skipped_ = 0;  ///< Bytes still to be skipped, of a frame that is too large.
};

}  // namespace trocar::link::detail
