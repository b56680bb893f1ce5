#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/sequence/detail/sequence_header.h"

namespace trocar::io::detail {

/// Reads the pixels of all frames in the order of the file; errors name the file `where`. No memory is allocated for
/// more pixels than the file can contain.
Result<std::vector<std::uint8_t>> read_pixels(const SequenceHeader& header, const InputFile& file,
                                              const std::string& where);

/// Compresses the bytes to a zlib stream.
Result<std::string> pack(std::span<const std::uint8_t> bytes);

}  // namespace trocar::io::detail
