#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/sequence/detail/sequence_header.h"

namespace trocar::io::detail {

/// The pixels of all frames as the file that has them stores them; errors name the file `where`. Nothing is allocated
/// for pixels that the file cannot hold.
Result<std::vector<std::uint8_t>> read_pixels(const SequenceHeader& header, const InputFile& file,
                                              const std::string& where);

/// A zlib stream of the bytes.
Result<std::string> pack(std::span<const std::uint8_t> bytes);

}  // namespace trocar::io::detail
