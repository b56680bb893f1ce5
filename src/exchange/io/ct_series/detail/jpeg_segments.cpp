#include "io/ct_series/detail/jpeg_segments.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace trocar::io::detail {
namespace {

using namespace jpeg_markers;

constexpr unsigned char kMark = 0xff;

unsigned char octet(std::span<const char> bytes, std::size_t at) noexcept {
  return static_cast<unsigned char>(bytes[at]);
}

bool is_restart(unsigned char marker) noexcept {
  return marker >= 0xd0 && marker <= 0xd7;
}
/// Application data and comments.
bool is_remark(unsigned char marker) noexcept {
  return (marker >= 0xe0 && marker <= 0xef) || marker == 0xfe;
}

void append(std::vector<char>& out, std::uint8_t marker, std::span<const char> content, bool has_length) {
  out.push_back(static_cast<char>(kMark));
  out.push_back(static_cast<char>(marker));
  if (has_length) {
    const std::size_t length = content.size() + 2;
    out.push_back(static_cast<char>(length >> 8));
    out.push_back(static_cast<char>(length & 0xff));
  }
  out.insert(out.end(), content.begin(), content.end());
}

}  // namespace

std::uint32_t JpegSegment::number(std::size_t at, std::size_t bytes) const noexcept {
  if (at > content.size() || content.size() - at < bytes) return 0;
  std::uint32_t value = 0;
  for (std::size_t n = 0; n < bytes; ++n) value = value << 8 | octet(content, at + n);
  return value;
}

std::optional<JpegSegment> JpegWalk::next() noexcept {
  while (rest_.size() >= 2 && octet(rest_, 0) == kMark && octet(rest_, 1) == kMark) rest_ = rest_.subspan(1);
  if (rest_.size() < 2 || octet(rest_, 0) != kMark || octet(rest_, 1) == 0) return std::nullopt;
  JpegSegment segment{octet(rest_, 1), {}};
  rest_ = rest_.subspan(2);
  if (segment.marker == kStart || segment.marker == kEnd) return segment;
  if (rest_.size() < 2) return std::nullopt;
  const std::size_t length = static_cast<std::size_t>(octet(rest_, 0)) << 8 | octet(rest_, 1);
  if (length < 2 || length > rest_.size()) return std::nullopt;
  segment.content = rest_.subspan(2, length - 2);
  rest_ = rest_.subspan(length);
  return segment;
}

std::span<const char> JpegWalk::coded() noexcept {
  std::size_t end = 0;
  for (; end < rest_.size(); ++end) {
    if (octet(rest_, end) != kMark || end + 1 == rest_.size()) continue;
    const unsigned char marker = octet(rest_, end + 1);
    if (marker != 0 && marker != kMark && !is_restart(marker)) break;
  }
  const auto coded = rest_.first(end);
  rest_ = rest_.subspan(end);
  return coded;
}

std::optional<std::vector<char>> plain_jpeg(std::span<const char> stream) {
  constexpr std::uint8_t kFirstFrame = 0xc0, kLastFrame = 0xc2;  // baseline, extended, progressive
  std::vector<char> plain;
  plain.reserve(stream.size());
  JpegWalk walk(stream);
  const auto start = walk.next();
  if (!start || start->marker != kStart) return std::nullopt;
  append(plain, kStart, {}, false);
  std::optional<std::uint8_t> frame;
  bool has_scan = false;
  while (const auto segment = walk.next()) {
    const std::uint8_t marker = segment->marker;
    if (is_remark(marker)) continue;
    if (marker == kEnd) {
      append(plain, kEnd, {}, false);
      return has_scan ? std::optional(std::move(plain)) : std::nullopt;
    }
    const bool is_frame = marker >= kFirstFrame && marker <= kLastFrame;
    const bool is_table = marker == kHuffmanTables || marker == kQuantisation || marker == kRestartInterval;
    if (!is_frame && !is_table && marker != kScan) return std::nullopt;
    if (is_frame && (frame || segment->content.size() != 9)) return std::nullopt;  // one component
    if (is_frame) frame = marker;
    append(plain, marker, segment->content, true);
    if (marker != kScan) continue;
    // Only a progressive image has several scans.
    if (!frame || (has_scan && *frame != kLastFrame) || segment->content.size() != 6) return std::nullopt;
    has_scan = true;
    const auto coded = walk.coded();
    plain.insert(plain.end(), coded.begin(), coded.end());
  }
  return std::nullopt;
}

namespace {

constexpr std::uint32_t kJpegStart = 0xffd8;
constexpr std::uint32_t kJpeg2000Start = 0xff4f;
constexpr std::uint32_t kJpeg2000Size = 0xff51;
constexpr std::uint32_t kStartOfScan = 0xffda;

/// Big-endian numbers, as all of these formats have them; beyond the end: empty.
class Bytes {
 public:
  explicit Bytes(std::span<const char> bytes) noexcept : bytes_(bytes) {}
  std::optional<std::uint32_t> at(std::size_t offset, std::size_t count) const noexcept {
    if (offset > bytes_.size() || bytes_.size() - offset < count) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t n = 0; n < count; ++n) value = value << 8 | static_cast<unsigned char>(bytes_[offset + n]);
    return value;
  }

 private:
  std::span<const char> bytes_;
};

std::optional<CodestreamSize> to_size(std::uint32_t columns, std::uint32_t rows, std::uint32_t components,
                                      std::uint32_t bits) noexcept {
  constexpr auto kMost = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
  if (columns > kMost || rows > kMost) return std::nullopt;
  return CodestreamSize{static_cast<int>(columns), static_cast<int>(rows), static_cast<int>(components),
                        static_cast<int>(bits), false};
}

/// Frame headers are C0 to CF but for tables (C4), extensions (C8) and arithmetic conditioning (CC); F7 is JPEG-LS.
bool is_frame_header(std::uint32_t marker) noexcept {
  if (marker == 0xfff7) return true;
  return marker >= 0xffc0 && marker <= 0xffcf && marker != 0xffc4 && marker != 0xffc8 && marker != 0xffcc;
}

std::optional<CodestreamSize> jpeg_size(const Bytes& bytes) noexcept {
  for (std::size_t at = 2;;) {
    const auto marker = bytes.at(at, 2);
    if (!marker || *marker < 0xff01 || *marker == kStartOfScan) return std::nullopt;
    if (*marker == 0xffff) {  // a fill byte
      ++at;
      continue;
    }
    const auto length = bytes.at(at + 2, 2);
    if (!length || *length < 2) return std::nullopt;
    if (is_frame_header(*marker)) {
      const auto bits = bytes.at(at + 4, 1);
      const auto rows = bytes.at(at + 5, 2);
      const auto columns = bytes.at(at + 7, 2);
      const auto components = bytes.at(at + 9, 1);
      if (!components) return std::nullopt;
      return to_size(*columns, *rows, *components, *bits);
    }
    at += 2 + *length;
  }
}

std::optional<CodestreamSize> jpeg2000_size(const Bytes& bytes) noexcept {
  const auto right = bytes.at(8, 4);
  const auto bottom = bytes.at(12, 4);
  const auto left = bytes.at(16, 4);
  const auto top = bytes.at(20, 4);
  const auto components = bytes.at(40, 2);
  const auto numbers = bytes.at(42, 1);  // of the first component: sign, and bits less one
  if (!numbers || *right < *left || *bottom < *top) return std::nullopt;
  auto size = to_size(*right - *left, *bottom - *top, *components, (*numbers & 0x7f) + 1);
  if (size) size->is_signed = (*numbers & 0x80) != 0;
  return size;
}

}  // namespace

std::optional<CodestreamSize> codestream_size(std::span<const char> stream) noexcept {
  const Bytes bytes(stream);
  const auto start = bytes.at(0, 2);
  if (start == kJpegStart) return jpeg_size(bytes);
  if (start == kJpeg2000Start && bytes.at(2, 2) == kJpeg2000Size) return jpeg2000_size(bytes);
  return std::nullopt;
}

}  // namespace trocar::io::detail
