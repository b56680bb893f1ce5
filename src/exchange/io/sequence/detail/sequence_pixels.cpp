#include "io/sequence/detail/sequence_pixels.h"

#include <fmt/format.h>
#include <itk_zlib.h>

#include <algorithm>
#include <fstream>

#include "io/image/detail/inflate_input.h"

namespace trocar::io::detail {
namespace {

constexpr int kSpeckleCompression = 1;                ///< Speckle hardly compresses: higher levels only take more time.
constexpr std::size_t kPiece = std::size_t{1} << 30;  ///< zlib counts in 32 bits.

/// Unpacks a gzip or zlib stream of at most `packed` bytes into all of `out`. Returns false if it is damaged or too
/// short.
bool unpack(std::ifstream& file, std::uint64_t packed, std::span<std::uint8_t> out) {
  InflateInput input(file, packed);
  if (!input.is_ready()) return false;
  z_stream& stream = input.stream();
  std::size_t done = 0;
  int status = Z_OK;
  while (done < out.size() && status == Z_OK) {
    if (!input.refill()) return false;
    const std::size_t room = std::min(out.size() - done, kPiece);
    stream.next_out = out.data() + done;
    stream.avail_out = static_cast<unsigned>(room);
    status = inflate(&stream, Z_NO_FLUSH);
    done += room - stream.avail_out;
  }
  return done == out.size() && (status == Z_OK || status == Z_STREAM_END);
}

}  // namespace

Result<std::vector<std::uint8_t>> read_pixels(const SequenceHeader& header, const InputFile& input,
                                              const std::string& where) {
  const std::uint64_t bytes = header.sequence.frame_pixels() * header.sequence.frames.size();
  const std::uint64_t size = input.size();
  const std::uint64_t available = size > header.pixel_offset ? size - header.pixel_offset : 0;
  if (!header.is_compressed && available < bytes)
    return fail(fmt::format("the pictures end before the last pixel ({} of {} bytes)", available, bytes), where,
                kExportAgain);
  const std::uint64_t packed = header.packed_bytes > 0 ? header.packed_bytes : available;
  if (header.is_compressed && (packed > available || bytes / kMaxDeflateRatio > packed))
    return fail("the compressed pixels end too early", where, kExportAgain);

  std::vector<std::uint8_t> pixels(bytes);
  std::ifstream file(input.pinned_path(), std::ios::binary);
  file.seekg(static_cast<std::streamoff>(header.pixel_offset));
  if (header.is_compressed) {
    if (unpack(file, packed, pixels)) return pixels;
    return fail("the compressed pixels are damaged or end too early", where, kExportAgain);
  }
  if (file.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(bytes))) return pixels;
  return fail("the pixels cannot be read", where, kExportAgain);
}

Result<std::string> pack(std::span<const std::uint8_t> bytes) {
  uLongf packed_bytes = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(packed_bytes, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_bytes, bytes.data(),
                               static_cast<uLong>(bytes.size()), kSpeckleCompression);
  if (status != Z_OK) return fail("not enough memory to pack the pixels", {}, "close other programs");
  packed.resize(packed_bytes);
  return packed;
}

}  // namespace trocar::io::detail
