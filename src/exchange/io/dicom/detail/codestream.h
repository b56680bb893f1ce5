#pragma once

#include <optional>
#include <span>

namespace trocar::io::detail {

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
