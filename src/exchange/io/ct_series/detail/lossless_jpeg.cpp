#include "io/ct_series/detail/lossless_jpeg.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/ct_series/detail/jpeg_segments.h"

namespace trocar::io::detail {
namespace {

constexpr int kLongestCode = 16;
constexpr int kMostExtraBits = 16;  ///< Bits of a difference; 16 of them are the one number 32768.

/// The code that the next sixteen bits start with. No length: none.
struct HuffmanCode {
  std::uint8_t length = 0;
  std::uint8_t extra_bits = 0;
};
using HuffmanTable = std::vector<HuffmanCode>;  ///< For all values of sixteen bits.

struct LosslessHeader {
  int bits = 0;
  int columns = 0;
  int rows = 0;
  int predictor = 0;
  int point_transform = 0;
  std::size_t restart_interval = 0;  ///< Pixels; 0: none.
  HuffmanTable codes;
  std::span<const char> coded;
};

/// The tables of one segment; false if one is damaged. Those for cosine coefficients (class 1) are passed over.
bool take_tables(const JpegSegment& segment, std::array<HuffmanTable, 4>& tables) {
  for (std::size_t at = 0; at < segment.content.size();) {
    const std::uint32_t kind = segment.number(at, 1) >> 4, slot = segment.number(at, 1) & 0xf;
    const std::size_t symbols_at = at + 1 + kLongestCode;
    if (kind > 1 || slot >= tables.size() || symbols_at > segment.content.size()) return false;
    HuffmanTable table(1 << kLongestCode);
    std::size_t next = 0, symbol = 0;
    for (int length = 1; length <= kLongestCode; ++length) {
      const std::size_t width = std::size_t{1} << (kLongestCode - length);
      for (std::uint32_t n = segment.number(at + static_cast<std::size_t>(length), 1); n > 0; --n, ++symbol) {
        if (symbols_at + symbol >= segment.content.size() || next + width > table.size()) return false;
        const std::uint32_t extra_bits = segment.number(symbols_at + symbol, 1);
        if (kind == 0 && extra_bits > kMostExtraBits) return false;
        for (std::size_t end = next + width; next < end; ++next)
          table[next] = {static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(extra_bits)};
      }
    }
    if (kind == 0) tables[slot] = std::move(table);
    at = symbols_at + symbol;
  }
  return true;
}

/// The header of the only scan of the only component.
bool take_scan(const JpegSegment& scan, std::uint32_t component, std::array<HuffmanTable, 4>& tables,
               LosslessHeader& header) {
  if (scan.content.size() != 6 || scan.number(0, 1) != 1 || scan.number(1, 1) != component) return false;
  const std::uint32_t slot = scan.number(2, 1) >> 4;
  header.predictor = static_cast<int>(scan.number(3, 1));
  header.point_transform = static_cast<int>(scan.number(5, 1));
  if (slot >= tables.size() || tables[slot].empty()) return false;
  header.codes = std::move(tables[slot]);
  return header.predictor >= 1 && header.predictor <= 7 && scan.number(4, 1) == 0 &&
         header.point_transform < header.bits;
}

std::optional<LosslessHeader> read_header(std::span<const char> stream) {
  LosslessHeader header;
  std::array<HuffmanTable, 4> tables;
  std::optional<std::uint32_t> component;
  JpegWalk walk(stream);
  const auto start = walk.next();
  if (!start || start->marker != jpeg_markers::kStart) return std::nullopt;
  while (const auto segment = walk.next()) {
    switch (segment->marker) {
      case jpeg_markers::kLosslessFrame:
        if (component || segment->content.size() != 9 || segment->number(5, 1) != 1) return std::nullopt;
        header.bits = static_cast<int>(segment->number(0, 1));
        header.rows = static_cast<int>(segment->number(1, 2));
        header.columns = static_cast<int>(segment->number(3, 2));
        component = segment->number(6, 1);
        break;
      case jpeg_markers::kHuffmanTables:
        if (!take_tables(*segment, tables)) return std::nullopt;
        break;
      case jpeg_markers::kRestartInterval:
        header.restart_interval = segment->number(0, 2);
        break;
      case jpeg_markers::kScan:
        if (!component || !take_scan(*segment, *component, tables, header)) return std::nullopt;
        header.coded = walk.coded();
        return header;
      case jpeg_markers::kQuantisation:
        break;  // has no meaning here, but some writers have it
      default:
        // Application data and comments.
        if (segment->marker < 0xe0 || segment->marker == 0xff) return std::nullopt;
    }
  }
  return std::nullopt;
}

/// The bits of the coded pixels, most significant first; a byte FF is followed by a 0.
class CodedBits {
 public:
  explicit CodedBits(std::span<const char> bytes) noexcept : bytes_(bytes) {}

  /// The next sixteen bits; zeros where the bytes end.
  std::uint32_t peek() noexcept {
    while (count_ < 16) {
      window_ = window_ << 8 | next_byte();
      count_ += 8;
    }
    return window_ >> (count_ - 16) & 0xffff;
  }
  void skip(int bits) noexcept { count_ -= bits; }
  std::uint32_t take(int bits) noexcept {
    const std::uint32_t value = peek() >> (16 - bits);
    skip(bits);
    return value;
  }
  /// True if bits were taken that are not there.
  bool is_overrun() const noexcept { return count_ < made_up_; }
  /// Goes on after the next restart marker; false if there is none right here.
  bool restart(int number) noexcept {
    if (at_ + 2 > bytes_.size() || count_ - made_up_ >= 8) return false;
    if (octet(at_) != 0xff || octet(at_ + 1) != 0xd0 + number) return false;
    at_ += 2;
    count_ = made_up_ = 0;
    return true;
  }
  /// Bytes that were not used; those that fill up the end are zeros or ones.
  std::size_t unused() const noexcept {
    return bytes_.size() - at_ + static_cast<std::size_t>(std::max(0, count_ - made_up_) / 8);
  }

 private:
  unsigned char octet(std::size_t at) const noexcept { return static_cast<unsigned char>(bytes_[at]); }
  std::uint32_t next_byte() noexcept {
    const bool is_end =
        at_ >= bytes_.size() || (octet(at_) == 0xff && (at_ + 1 >= bytes_.size() || octet(at_ + 1) != 0));
    if (is_end) {
      made_up_ += 8;
      return 0;
    }
    const std::uint32_t byte = octet(at_);
    at_ += byte == 0xff ? 2 : 1;
    return byte;
  }

  std::span<const char> bytes_;
  std::size_t at_ = 0;
  std::uint64_t window_ = 0;
  int count_ = 0;    ///< Bits in the window that were not taken.
  int made_up_ = 0;  ///< Of them, at its end, beyond the bytes.
};

std::optional<int> take_difference(CodedBits& bits, const HuffmanTable& codes) {
  const HuffmanCode code = codes[bits.peek()];
  if (code.length == 0) return std::nullopt;
  bits.skip(code.length);
  if (code.extra_bits == 0) return 0;
  if (code.extra_bits == kMostExtraBits) return 1 << 15;
  const int value = static_cast<int>(bits.take(code.extra_bits));
  return value < 1 << (code.extra_bits - 1) ? value - (1 << code.extra_bits) + 1 : value;
}

/// Predictions of table H.1: from left, above, and above left.
int predict(int predictor, int left, int above, int corner) {
  switch (predictor) {
    case 1:
      return left;
    case 2:
      return above;
    case 3:
      return corner;
    case 4:
      return left + above - corner;
    case 5:
      return left + ((above - corner) >> 1);
    case 6:
      return above + ((left - corner) >> 1);
    default:
      return (left + above) >> 1;
  }
}

void store(std::uint32_t number, int bytes_per_pixel, std::byte* to) {
  to[0] = static_cast<std::byte>(number & 0xff);
  if (bytes_per_pixel == 2) to[1] = static_cast<std::byte>(number >> 8 & 0xff);
}

}  // namespace

bool unpack_lossless_jpeg(std::span<const char> stream, int columns, int rows, int bytes_per_pixel,
                          std::span<std::byte> out) {
  const auto header = read_header(stream);
  if (!header || header->columns != columns || header->rows != rows || header->bits < 2 ||
      header->bits > 8 * bytes_per_pixel)
    return false;
  const auto width = static_cast<std::size_t>(columns);
  const std::size_t count = width * static_cast<std::size_t>(rows);
  // The standard has whole rows between restarts.
  if (out.size() != count * static_cast<std::size_t>(bytes_per_pixel) || header->restart_interval % width != 0)
    return false;
  CodedBits bits(header->coded);
  std::vector<int> above(width), row(width);
  bool is_first_row = true;  // of the image, or after a restart
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = n % width;
    if (i == 0 && n > 0) {
      std::swap(above, row);
      is_first_row = header->restart_interval != 0 && n % header->restart_interval == 0;
      const auto number = is_first_row ? static_cast<int>((n / header->restart_interval - 1) % 8) : 0;
      if (is_first_row && !bits.restart(number)) return false;
    }
    const auto difference = take_difference(bits, header->codes);
    if (!difference || bits.is_overrun()) return false;
    const int predicted = i == 0         ? (is_first_row ? 1 << (header->bits - header->point_transform - 1) : above[0])
                          : is_first_row ? row[i - 1]
                                         : predict(header->predictor, row[i - 1], above[i], above[i - 1]);
    row[i] = (predicted + *difference) & 0xffff;
    store(static_cast<std::uint32_t>(row[i]) << header->point_transform, bytes_per_pixel,
          out.data() + n * static_cast<std::size_t>(bytes_per_pixel));
  }
  constexpr std::size_t kMostLeft = 2;  // some writers fill up to whole words
  return bits.unused() <= kMostLeft;
}

}  // namespace trocar::io::detail
