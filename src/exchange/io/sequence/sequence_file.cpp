#include "io/sequence/sequence_file.h"

#include <fmt/format.h>
#include <itk_zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "core/files/output_file.h"
#include "core/result.h"
#include "core/text.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/inflate_input.h"
#include "io/image/detail/text_header.h"
#include "io/sequence/detail/sequence_header.h"

namespace trocar::io::detail {

/// Reads the pixels of all frames in the order of the file; errors name the file `where`. No memory is allocated for
/// more pixels than the file can contain.
Result<std::vector<std::uint8_t>> read_pixels(const SequenceHeader& header, const InputFile& file,
                                              const std::string& where);

/// Compresses the bytes to a zlib stream.
Result<std::string> pack(std::span<const std::uint8_t> bytes);

}  // namespace trocar::io::detail

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

/// Converts all frames to columns towards the marked side and rows away from the face.
void turn_pictures(const detail::SequenceHeader& header, ultrasound::TrackedSequence& sequence) {
  const auto columns = static_cast<std::ptrdiff_t>(sequence.columns);
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    const auto first = sequence.pixels.begin() + static_cast<std::ptrdiff_t>(frame * sequence.frame_pixels());
    for (int row = 0; row < sequence.rows && header.is_column_flipped; ++row)
      std::reverse(first + row * columns, first + (row + 1) * columns);
    for (int row = 0; row < sequence.rows / 2 && header.is_row_flipped; ++row)
      std::swap_ranges(first + row * columns, first + (row + 1) * columns, first + (sequence.rows - 1 - row) * columns);
  }
}

bool is_transform_name(const std::string& name) {
  const auto is_word = [](char c) { return ascii::is_letter_or_digit(c) || c == '_'; };
  return name.find("To", 1) != std::string::npos && std::all_of(name.begin(), name.end(), is_word);
}

Status check(const ultrasound::TrackedSequence& sequence) {
  const bool is_whole = sequence.pixels.size() == sequence.frame_pixels() * sequence.frames.size();
  if (sequence.pixels.empty() || !is_whole)
    return fail("there is no sequence to write", "sequence", "record at least one frame");
  for (const auto& frame : sequence.frames) {
    if (!std::isfinite(frame.time_s))
      return fail("a time of the sequence is not a number", "sequence", "give a finite time for every frame");
    for (const auto& [name, matrix] : frame.transforms) {
      if (!is_transform_name(name))
        return fail("is not a transform name, such as ProbeToTracker", name, "name it as FromToTo");
      if (!matrix.allFinite() || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        return fail("is not an affine transform of finite numbers", name,
                    "give a finite matrix with the last row 0 0 0 1");
    }
  }
  return {};
}

}  // namespace

Result<bool> is_sequence(const fs::path& path) {
  const std::string extension = ascii::lower_case(path.extension().string());
  if (extension != ".mha" && extension != ".mhd") return false;
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileKind::kSequence));
  TROCAR_TRY(const detail::TextHeader header, detail::read_text_header(file, detail::TextHeaderKind::kMeta));
  return detail::has_frame_transforms(header);
}

Result<ultrasound::TrackedSequence> read_sequence(const fs::path& path) {
  TROCAR_TRY(InputFile file, InputFile::open(path, FileKind::kSequence));
  TROCAR_TRY(detail::SequenceHeader header, detail::read_sequence_header(file));
  if (!header.data_file.empty()) {
    TROCAR_TRY(file, detail::open_data_file(path, header.data_file, FileKind::kSequence));
  }
  TROCAR_TRY(header.sequence.pixels, detail::read_pixels(header, file, path.string()));
  turn_pictures(header, header.sequence);
  return std::move(header.sequence);
}

Status write_sequence(const ultrasound::TrackedSequence& sequence, const fs::path& path) {
  if (path.extension() != ".mha")
    return fail_usage("a sequence is written as .igs.mha", path.string(), "let the name end in .igs.mha");
  TROCAR_TRY_STATUS(check(sequence));
  TROCAR_TRY(const std::string packed, detail::pack(sequence.pixels));
  return write_file_atomically(path, detail::sequence_header_text(sequence, packed.size()) + packed);
}

}  // namespace trocar::io

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
