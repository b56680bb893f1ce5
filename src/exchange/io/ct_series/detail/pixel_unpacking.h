#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/image/detail/payload.h"

namespace trocar::io::detail {

/// Pixel encoding (PS3.3, C.7.6.3).
struct PixelLayout {
  int bits_allocated = 16;
  int bits_stored = 16;
  int high_bit = 15;
  bool is_signed = false;
  std::size_t count = 0;

  std::size_t bytes() const { return count * static_cast<std::size_t>(bits_allocated / 8); }
  VoxelType type() const {
    if (bits_allocated == 8) return is_signed ? VoxelType::kInt8 : VoxelType::kUInt8;
    return is_signed ? VoxelType::kInt16 : VoxelType::kUInt16;
  }
};

/// Compressed pixels of one image, and the image that they should be.
struct CompressedImage {
  std::vector<std::span<const char>> pieces;
  std::string transfer_syntax;
  int columns = 0;
  int rows = 0;
};

// All functions give numbers of layout.type() in this machine's byte order: shifted down, without the bits that are not
// stored (old overlays, junk), and with the sign of the stored ones, whatever the transfer syntax.

/// Uncompressed pixels; at least layout.bytes() of them, as `out` has.
void unpack_plain(std::span<const char> pixels, bool is_big_endian, const PixelLayout& layout,
                  std::span<std::byte> out);
/// RLE, JPEG, JPEG-LS, JPEG 2000. May throw exceptions of GDCM. Errors (without a place): a damaged stream or one of
/// another size; signed numbers in a stream whose header says that they are unsigned.
Status unpack_compressed(const CompressedImage& packed, const PixelLayout& layout, std::span<std::byte> out);

}  // namespace trocar::io::detail
