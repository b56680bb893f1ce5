#pragma once

#include <itk_zlib.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

#include "io/image/detail/image_header.h"

namespace trocar::io::detail {

inline constexpr std::uint64_t kMaxDeflateRatio = 1'032;  ///< Upper limit of the compression ratio of deflate.

/// True if this many packed bytes can be unpacked to so many.
inline bool could_unpack_to(std::uint64_t bytes, std::uint64_t packed) noexcept {
  return packed > 0 && bytes / kMaxDeflateRatio <= packed;
}

/// A gzip or zlib stream that starts at the file's position and has at most `packed` bytes.
class InflateInput {
 public:
  InflateInput(std::ifstream& file, std::uint64_t packed) : file_(file), packed_(packed), bytes_(kChunkBytes) {
    is_ready_ = inflateInit2(&stream_, MAX_WBITS + 32) == Z_OK;  // +32: gzip or zlib, detected automatically
  }
  ~InflateInput() {
    if (is_ready_) inflateEnd(&stream_);
  }
  InflateInput(const InflateInput&) = delete;
  InflateInput& operator=(const InflateInput&) = delete;

  /// False if zlib has no memory.
  bool is_ready() const noexcept { return is_ready_; }
  z_stream& stream() noexcept { return stream_; }

  /// Reads more bytes if the stream has consumed its input; false at the end of the bytes.
  bool refill() {
    if (stream_.avail_in > 0) return true;
    file_.read(reinterpret_cast<char*>(bytes_.data()),
               static_cast<std::streamsize>(std::min<std::uint64_t>(bytes_.size(), packed_)));
    stream_.next_in = bytes_.data();
    stream_.avail_in = static_cast<unsigned>(file_.gcount());
    packed_ -= stream_.avail_in;
    return stream_.avail_in > 0;
  }

 private:
  std::ifstream& file_;
  std::uint64_t packed_;
  std::vector<unsigned char> bytes_;
  z_stream stream_{};
  bool is_ready_ = false;
};

}  // namespace trocar::io::detail
