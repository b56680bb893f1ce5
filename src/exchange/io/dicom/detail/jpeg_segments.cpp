#include "io/dicom/detail/jpeg_segments.h"

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

}  // namespace trocar::io::detail
