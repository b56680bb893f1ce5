#include "io/image/detail/payload.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <vector>

#include "core/text.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/inflate_input.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kSegmentation = ".seg";  ///< 3D Slicer adds it before the ending.

/// Unpacks a gzip or zlib stream of `packed` bytes and discards the result. Returns the number of unpacked bytes (a
/// second gzip member behind `bytes` bytes is not unpacked), none if the stream is damaged or has fewer than `bytes`.
std::optional<std::uint64_t> unpacked_bytes(std::ifstream& file, std::uint64_t packed, std::uint64_t bytes) {
  InflateInput input(file, packed);
  if (!input.is_ready()) return std::nullopt;
  z_stream& stream = input.stream();
  std::vector<unsigned char> out(kChunkBytes);
  std::uint64_t unpacked = 0;
  bool at_end = false;
  while (true) {
    if (!input.refill()) return at_end && unpacked >= bytes ? std::optional(unpacked) : std::nullopt;
    if (at_end) {
      // A further gzip member, or other data after the voxels.
      if (unpacked >= bytes) return unpacked;
      if (inflateReset(&stream) != Z_OK) return std::nullopt;
      at_end = false;
    }
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(out.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) return std::nullopt;
    unpacked += out.size() - stream.avail_out;
    at_end = status == Z_STREAM_END;
  }
}

/// The libraries copy each number of a text into an array on the stack.
bool has_short_numbers(std::ifstream& file) {
  constexpr std::size_t kLongest = 60;
  std::vector<char> chunk(kChunkBytes);
  for (std::size_t length = 0;
       file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || file.gcount() > 0;)
    for (std::streamsize n = 0; n < file.gcount(); ++n) {
      length = ascii::is_space(chunk[static_cast<std::size_t>(n)]) ? 0 : length + 1;
      if (length > kLongest) return false;
    }
  return true;
}

Status check_payload(const Payload& payload, const InputFile& input, Check check, const std::string& where) {
  const std::uint64_t available = input.size() > payload.offset ? input.size() - payload.offset : 0;
  if (payload.is_text && available < payload.least_bytes)
    return fail("the image ends before its last voxel", where, kExportAgain);
  std::ifstream file(input.pinned_path(), std::ios::binary);
  file.seekg(static_cast<std::streamoff>(payload.offset));
  if (payload.is_text && !payload.is_hex && !has_short_numbers(file))
    return fail("the voxels contain a number of more than 60 letters", where, kExportAgain);
  if (payload.is_text) return {};
  const auto holds_more = [&](std::uint64_t bytes) {
    return fail(fmt::format(kHoldsMore, payload.bytes, bytes), where, kExportAgain);
  };
  if (!payload.is_compressed) {
    if (is_far_more(available, payload.bytes)) return holds_more(available);
    if (available >= payload.bytes) return {};
    return fail(fmt::format("the image ends before its last voxel ({} of {} bytes)", available, payload.bytes), where,
                kExportAgain);
  }
  const std::uint64_t packed = payload.packed > 0 ? payload.packed : available;
  const bool could_be_enough = packed <= available && could_unpack_to(payload.bytes, available);
  if (could_be_enough && check == Check::kSize) return {};
  if (const auto bytes = could_be_enough ? unpacked_bytes(file, packed, payload.bytes) : std::nullopt) {
    if (is_far_more(*bytes, payload.bytes)) return holds_more(*bytes);
    return {};
  }
  return fail("the compressed voxels are damaged or end too early", where, kExportAgain);
}

/// nullptr: not an image file.
const ImageEnding* find_ending(const fs::path& path) {
  const std::string name = ascii::lower_case(path.filename().string());
  const auto* found = std::find_if(kImageEndings.begin(), kImageEndings.end(), [&](const ImageEnding& ending) {
    return name.size() > ending.text.size() && name.ends_with(ending.text);
  });
  return found != kImageEndings.end() ? found : nullptr;
}

}  // namespace

Result<ImageFormat> find_image_format(const fs::path& path) {
  if (const ImageEnding* ending = find_ending(path)) return ending->format;
  std::vector<std::string_view> endings;
  for (const ImageEnding& known : kImageEndings) endings.push_back(known.text);
  return fail("not an image file of a known kind", path.string(),
              fmt::format("give a file that ends in {}, or the folder of a DICOM series", fmt::join(endings, ", ")));
}

std::string image_stem(const fs::path& path) {
  std::string name = path.filename().string();
  if (const ImageEnding* ending = find_ending(path)) name.erase(name.size() - ending->text.size());
  if (ascii::lower_case(name).ends_with(kSegmentation) && name.size() > kSegmentation.size())
    name.erase(name.size() - kSegmentation.size());
  return name;
}

Result<InputFile> open_data_file(const fs::path& header, const fs::path& data_file, FileKind kind) {
  const std::string where = header.string();
  if (data_file.is_absolute() || std::find(data_file.begin(), data_file.end(), "..") != data_file.end())
    return fail(fmt::format("the header names a data file outside of its folder: {}", data_file.string()), where,
                "keep header and data together, and name the data file without a folder");
  const fs::path folder = header.has_parent_path() ? header.parent_path() : fs::path(".");
  auto file = InputFile::open(folder / data_file, kind, folder);
  if (file) return file;
  return fail(fmt::format("the data file \"{}\" of the header: {}", data_file.string(), file.error().what), where,
              "keep header and data together");
}

Result<CheckedImage> check_image_file(InputFile file, const ImageHeader& header, Check check, const fs::path& inside) {
  const fs::path path = file.path();
  const Payload& payload = header.payload;
  if (!payload.data_file.empty()) {
    if (!inside.empty()) return fail("the voxels are in another file", path.string(), "build the patient again");
    TROCAR_TRY(const InputFile data, open_data_file(path, payload.data_file, FileKind::kVolume));
    TROCAR_TRY_STATUS(check_payload(payload, data, check, path.string()));
    return CheckedImage{std::move(file), path};
  }
  TROCAR_TRY_STATUS(check_payload(payload, file, check, path.string()));
  fs::path library_path = file.pinned_path();
  return CheckedImage{std::move(file), std::move(library_path)};
}

Result<CheckedImage> open_image_file(const fs::path& path, ImageFormat format, Check check) {
  TROCAR_TRY(InputFile file, InputFile::open(path, FileKind::kVolume));
  TROCAR_TRY(const ImageHeader header, read_image_header(file, format));
  return check_image_file(std::move(file), header, check);
}

}  // namespace trocar::io::detail
