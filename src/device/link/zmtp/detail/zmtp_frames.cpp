#include "link/zmtp/detail/zmtp_frames.h"

#include <algorithm>
#include <cstring>

namespace trocar::link::detail {
namespace zmtp {
namespace {

// Bytes of the greeting.
constexpr std::byte kSignatureBegin{0xFF}, kSignatureEnd{0x7F};
constexpr std::size_t kSignatureEndAt = 9, kMajorAt = 10, kMechanismAt = 12, kServerAt = 32;
constexpr std::byte kMajor{3};
constexpr std::size_t kShortest = 1, kLongest = 9;  ///< Bytes of a frame's flags and size.
constexpr std::size_t kMostShortBody = 255;

void append_number(std::vector<std::byte>& bytes, std::uint64_t number, int count) {
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<std::byte>(number >> (8 * i)));
}
void append_text(std::vector<std::byte>& bytes, std::string_view text) {
  append_bytes(bytes, std::as_bytes(std::span(text)));
}
void append_property(std::vector<std::byte>& bytes, std::string_view name, std::string_view value) {
  append_number(bytes, name.size(), 1);
  append_text(bytes, name);
  append_number(bytes, value.size(), 4);
  append_text(bytes, value);
}
std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::vector<std::byte> make_greeting(std::string_view mechanism, bool is_server) {
  std::vector<std::byte> greeting(kGreetingBytes);
  greeting.front() = kSignatureBegin;
  greeting[kSignatureEndAt] = kSignatureEnd;
  greeting[kMajorAt] = kMajor;
  std::memcpy(greeting.data() + kMechanismAt, mechanism.data(), mechanism.size());
  greeting[kServerAt] = std::byte{is_server};
  return greeting;
}

GreetingFault check_greeting(std::span<const std::byte> greeting, std::string_view mechanism) {
  const bool is_zmtp = greeting.front() == kSignatureBegin && (greeting[kSignatureEndAt] & std::byte{1}) != std::byte{};
  if (!is_zmtp || greeting[kMajorAt] < kMajor) return GreetingFault::kNotZmtp3;
  std::string_view theirs = text_of(greeting.subspan(kMechanismAt, kMostMechanismBytes));
  theirs = theirs.substr(0, theirs.find('\0'));
  return theirs == mechanism ? GreetingFault::kNone : GreetingFault::kMechanism;
}

void append_frame(std::vector<std::byte>& bytes, std::uint8_t flags, std::span<const std::byte> body) {
  const bool is_long = body.size() > kMostShortBody;
  bytes.push_back(static_cast<std::byte>(flags | (is_long ? kLong : 0)));
  append_number(bytes, body.size(), is_long ? kLongest - 1 : kShortest);
  append_bytes(bytes, body);
}

std::vector<std::byte> make_metadata(std::string_view socket_type) {
  std::vector<std::byte> bytes;
  append_property(bytes, "Socket-Type", socket_type);
  append_property(bytes, "Identity", "");
  return bytes;
}

Metadata read_metadata(std::span<const std::byte> bytes) {
  Metadata metadata;
  while (!bytes.empty()) {
    const auto name_bytes = std::to_integer<std::size_t>(bytes.front());
    if (bytes.size() < 1 + name_bytes + 4) return {};
    const std::string_view name = text_of(bytes.subspan(1, name_bytes));
    bytes = bytes.subspan(1 + name_bytes);
    std::size_t value_bytes = 0;
    for (int i = 0; i < 4; ++i) value_bytes = (value_bytes << 8) | std::to_integer<std::size_t>(bytes[std::size_t(i)]);
    bytes = bytes.subspan(4);
    if (bytes.size() < value_bytes) return {};
    const std::string_view value = text_of(bytes.first(value_bytes));
    bytes = bytes.subspan(value_bytes);
    if (name == "Socket-Type") metadata.socket_type = value;
    if (name == "Identity") metadata.identity = value;
  }
  metadata.is_valid = true;
  return metadata;
}

}  // namespace zmtp

void FrameReader::append(std::span<const std::byte> bytes) {
  const std::size_t dropped = std::min(skipped_, bytes.size());
  skipped_ -= dropped;
  bytes = bytes.subspan(dropped);
  drop_taken();
  append_bytes(bytes_, bytes);
}

std::span<const std::byte> FrameReader::take_raw(std::size_t count) {
  if (held() < count) return {};
  const auto raw = std::span<const std::byte>(bytes_).subspan(begin_, count);
  begin_ += count;
  return raw;
}

FrameReader::Outcome FrameReader::next(std::size_t most_bytes, std::size_t cut_off_bytes, Frame& frame) {
  const auto bytes = std::span<const std::byte>(bytes_).subspan(begin_);
  if (bytes.empty()) return Outcome::kNone;
  const auto flags = std::to_integer<std::uint8_t>(bytes.front());
  if ((flags & ~(zmtp::kMore | zmtp::kLong | zmtp::kCommand)) != 0) return Outcome::kBroken;
  const std::size_t header = (flags & zmtp::kLong) != 0 ? 9 : 2;
  if (bytes.size() < header) return Outcome::kNone;
  std::uint64_t size = 0;
  for (std::size_t i = 1; i < header; ++i) size = (size << 8) | std::to_integer<std::uint64_t>(bytes[i]);
  if (size > cut_off_bytes) return Outcome::kBroken;
  const auto whole = static_cast<std::size_t>(size);
  if (whole > most_bytes) {
    const std::size_t here = std::min(whole, bytes.size() - header);
    begin_ += header + here;
    skipped_ = whole - here;
    frame = {flags, {}};
    return Outcome::kTooLarge;
  }
  if (bytes.size() < header + whole) return Outcome::kNone;
  frame = {flags, bytes.subspan(header, whole)};
  begin_ += header + whole;
  return Outcome::kFrame;
}

/// Memory of a large message is released with it.
void FrameReader::drop_taken() {
  if (begin_ == 0) return;
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  constexpr std::size_t kKept = 128 * 1024;
  if (bytes_.empty() && bytes_.capacity() > kKept) std::vector<std::byte>().swap(bytes_);
}

}  // namespace trocar::link::detail
