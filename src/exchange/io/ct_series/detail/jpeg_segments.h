#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace trocar::io::detail {

/// Second bytes of the markers of JPEG (ISO 10918-1, B.1.1.3).
namespace jpeg_markers {
inline constexpr std::uint8_t kLosslessFrame = 0xc3;  ///< SOF3
inline constexpr std::uint8_t kHuffmanTables = 0xc4;
inline constexpr std::uint8_t kStart = 0xd8;
inline constexpr std::uint8_t kEnd = 0xd9;
inline constexpr std::uint8_t kScan = 0xda;
inline constexpr std::uint8_t kQuantisation = 0xdb;
inline constexpr std::uint8_t kRestartInterval = 0xdd;
}  // namespace jpeg_markers

struct JpegSegment {
  std::uint8_t marker = 0;
  std::span<const char> content;                                           ///< Without marker and length.
  std::uint32_t number(std::size_t at, std::size_t bytes) const noexcept;  ///< Big-endian; 0 beyond the end.
};

/// Walks over the segments of a JPEG stream.
class JpegWalk {
 public:
  explicit JpegWalk(std::span<const char> stream) noexcept : rest_(stream) {}
  /// Empty where no marker follows, at the end, and if the segment ends beyond the stream.
  std::optional<JpegSegment> next() noexcept;
  /// The coded pixels after a scan's header, with their restart markers, up to the next other marker or the end.
  std::span<const char> coded() noexcept;

 private:
  std::span<const char> rest_;
};

/// The stream of a baseline, extended or progressive JPEG of one component without comments and application data.
/// Empty if it is not such a stream: no frame header or two of them, bytes between the segments, a cut stream, a
/// foreign segment. Debian's GDCM ends the program at what libjpeg only warns of.
std::optional<std::vector<char>> plain_jpeg(std::span<const char> stream);

/// Image size and kind of numbers in the header of a compressed image.
struct CodestreamSize {
  int columns = 0;
  int rows = 0;
  int components = 0;
  int bits = 0;            ///< Of a number.
  bool is_signed = false;  ///< JPEG 2000 only: JPEG and JPEG-LS state no sign.
};

/// Image size of a JPEG, JPEG-LS (SOF segment; ISO 10918-1, 14495-1) or JPEG 2000 codestream (SIZ segment; ISO 15444-1,
/// A.5.1). Empty for another format, or if the stream ends before that segment.
std::optional<CodestreamSize> codestream_size(std::span<const char> stream) noexcept;

}  // namespace trocar::io::detail
