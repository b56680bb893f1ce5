#pragma once

#include <cstddef>
#include <span>

namespace trocar::io::detail {

/// Unpacks a lossless JPEG of one component with Huffman codes (process 14, all predictors; ISO 10918-1, annex H) into
/// numbers of one or two bytes, little endian. False if the stream is not such a one, of another size, or damaged: no
/// pixel is made up. GDCM is not used: it ends the program on some damaged streams and fills up others.
bool unpack_lossless_jpeg(std::span<const char> stream, int columns, int rows, int bytes_per_pixel,
                          std::span<std::byte> out);

}  // namespace trocar::io::detail
