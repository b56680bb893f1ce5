#include "io/image/detail/payload.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <vector>

#include "core/ascii.h"
#include "core/parse_number.h"
#include "io/image/detail/header_payload.h"
#include "io/image/detail/inflate_input.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSide = 65'535;                ///< Voxels along one axis.
constexpr std::uint64_t kMaxVoxels = 2'000'000'000;      ///< 4 GB of int16, far above any CT.
constexpr std::string_view kSegmentation = ".seg";       ///< 3D Slicer adds it before the ending.
constexpr std::size_t kMaxImageHeaderBytes = 16u << 20;  ///< .seg.nrrd files with many segments have long headers.

std::string trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

std::vector<std::int64_t> whole_numbers(const std::string& text) {
  std::vector<std::int64_t> numbers;
  for (std::string_view rest = text; !rest.empty();) {
    if (ascii::is_space(rest.front())) {
      rest.remove_prefix(1);
      continue;
    }
    const auto number = find_leading_number<std::int64_t>(rest);
    if (!number) return {};
    numbers.push_back(number->value);
    rest = number->rest;
  }
  return numbers;
}

/// Unpacks a gzip or zlib stream of `packed` bytes and discards the result: true if it is valid and has at least
/// `bytes` bytes.
bool is_valid_stream(std::ifstream& file, std::uint64_t packed, std::uint64_t bytes) {
  InflateInput input(file, packed);
  if (!input.is_ready()) return false;
  z_stream& stream = input.stream();
  std::vector<unsigned char> out(kChunkBytes);
  std::uint64_t unpacked = 0;
  bool at_end = false;
  while (true) {
    if (!input.refill()) return at_end && unpacked >= bytes;
    if (at_end) {
      // A further gzip member, or other data after the voxels.
      if (unpacked >= bytes) return true;
      if (inflateReset(&stream) != Z_OK) return false;
      at_end = false;
    }
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(out.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) return false;
    unpacked += out.size() - stream.avail_out;
    at_end = status == Z_STREAM_END;
  }
}

Status check_payload(const Payload& payload, const InputFile& input, Check check, const std::string& where) {
  const std::uint64_t available = input.size() > payload.offset ? input.size() - payload.offset : 0;
  if (payload.is_text && available >= payload.least_bytes) return {};
  if (payload.is_text) return fail("the image ends before its last voxel", where, kExportAgain);
  if (!payload.is_compressed) {
    if (available >= payload.bytes) return {};
    return fail(fmt::format("the image ends before its last voxel ({} of {} bytes)", available, payload.bytes), where,
                kExportAgain);
  }
  std::ifstream file(input.pinned_path(), std::ios::binary);
  file.seekg(static_cast<std::streamoff>(payload.offset));
  const std::uint64_t packed = payload.packed > 0 ? payload.packed : available;
  const bool could_be_enough = packed <= available && available > 0 && payload.bytes / kMaxDeflateRatio <= available;
  if (could_be_enough && (check == Check::kSize || is_valid_stream(file, packed, payload.bytes))) return {};
  return fail("the compressed voxels are damaged or end too early", where, kExportAgain);
}

// NRRD and MetaImage: text headers.

struct TextHeader {
  std::map<std::string, std::string> fields;  ///< Keys in lower case.
  std::uint64_t end = 0;                      ///< Offset of the first byte after the header.

  std::string get(const std::string& key, std::string fallback = {}) const {
    const auto found = fields.find(key);
    return found == fields.end() ? fallback : found->second;
  }
};

/// The libraries and this program must read the same lines: no control characters, and no line of blanks, which ends
/// the header for some readers only.
bool is_plain_line(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  const bool has_control =
      std::any_of(line.begin(), line.end(), [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
  return !has_control && (line.empty() || !trim(line).empty());
}

/// Reads "key<separator>value" lines up to an empty line or one that starts with `last_key`. Empty: no such line, or an
/// ambiguous one.
std::optional<TextHeader> read_text_header(const InputFile& input, char separator, std::string_view last_key) {
  std::ifstream file(input.pinned_path(), std::ios::binary);
  TextHeader header;
  std::string line;
  while (header.end < kMaxImageHeaderBytes && std::getline(file, line)) {
    header.end += line.size() + (file.eof() ? 0 : 1);
    if (!is_plain_line(line)) return std::nullopt;
    if (trim(line).empty()) return header;
    const auto at = line.find(separator);
    if (at == std::string::npos) continue;
    const std::string key = ascii::lower_case(trim(std::string_view(line).substr(0, at)));
    header.fields.emplace(key, trim(std::string_view(line).substr(at + 1)));
    // The library accepts this key in this spelling only, and would otherwise continue to read.
    if (key == ascii::lower_case(std::string(last_key)))
      return line.starts_with(last_key) ? std::optional(header) : std::nullopt;
  }
  return header.fields.empty() ? std::nullopt : std::optional(header);
}

std::optional<std::uint64_t> nrrd_type_bytes(const std::string& type) {
  if (type == "char" || type.find("char") != std::string::npos || type.find("int8") != std::string::npos) return 1;
  if (type.find("short") != std::string::npos || type.find("int16") != std::string::npos) return 2;
  if (type.find("long") != std::string::npos || type.find("int64") != std::string::npos || type == "double") return 8;
  if (type == "float" || type.find("int") != std::string::npos) return 4;
  return std::nullopt;
}

/// A list axis (overlapping layers of a .seg.nrrd) may come first; it counts as bytes of a voxel.
std::uint64_t take_list_axis(std::vector<std::int64_t>& sizes, const std::string& kinds) {
  const bool is_list = kinds.starts_with("list") || kinds.starts_with("vector");
  if (!is_list || sizes.size() != 4 || sizes[0] < 1 || sizes[0] > 255) return 1;
  const auto count = static_cast<std::uint64_t>(sizes[0]);
  sizes.erase(sizes.begin());
  return count;
}

/// Stores the data file named in the header.
Status take_data_file(const std::string& data_file, const std::string& where, Payload& payload) {
  if (data_file.empty()) return {};
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
    return fail("the voxels are in several files", where, "convert the image to one file (.nrrd or .mha)");
  payload.data_file = data_file;
  payload.offset = 0;
  return {};
}

Result<Payload> nrrd_payload(const InputFile& input) {
  const std::string where = input.path().string();
  std::ifstream file(input.pinned_path(), std::ios::binary);
  std::array<char, 4> magic{};
  file.read(magic.data(), magic.size());
  const auto header = read_text_header(input, ':', {});
  if (std::string_view(magic.data(), 4) != "NRRD" || !header) return fail("not a NRRD image", where, kExportAgain);

  const auto type_bytes = nrrd_type_bytes(ascii::lower_case(header->get("type")));
  if (!type_bytes) return fail("has no known voxel type", where, "convert it to 16-bit integers");
  std::vector<std::int64_t> sizes = whole_numbers(header->get("sizes"));
  const std::uint64_t layers = take_list_axis(sizes, ascii::lower_case(header->get("kinds")));
  TROCAR_TRY(const std::uint64_t bytes, volume_bytes(sizes, *type_bytes * layers, where));

  const std::string encoding = ascii::lower_case(header->get("encoding"));
  Payload payload{.offset = header->end, .bytes = bytes};
  payload.is_compressed = encoding == "gzip" || encoding == "gz";
  payload.is_text = encoding == "ascii" || encoding == "text" || encoding == "txt" || encoding == "hex";
  if (encoding != "raw" && !payload.is_compressed && !payload.is_text)
    return fail(fmt::format("the encoding \"{}\" is not supported", encoding), where, "save it with encoding gzip");
  payload.least_bytes = encoding == "hex" ? 2 * bytes : 2 * (bytes / *type_bytes) - 1;
  TROCAR_TRY_STATUS(take_data_file(header->get("data file", header->get("datafile")), where, payload));
  return payload;
}

std::optional<std::uint64_t> meta_type_bytes(const std::string& type) {
  if (type == "MET_CHAR" || type == "MET_UCHAR") return 1;
  if (type == "MET_SHORT" || type == "MET_USHORT") return 2;
  if (type == "MET_INT" || type == "MET_UINT" || type == "MET_FLOAT") return 4;
  if (type == "MET_LONG" || type == "MET_ULONG") return 4;
  if (type == "MET_LONG_LONG" || type == "MET_ULONG_LONG" || type == "MET_DOUBLE") return 8;
  return std::nullopt;
}

Result<Payload> meta_payload(const InputFile& input) {
  const std::string where = input.path().string();
  const auto header = read_text_header(input, '=', "ElementDataFile");
  if (!header || header->get("dimsize").empty() || header->get("elementdatafile").empty())
    return fail("not a MetaImage", where, kExportAgain);
  const auto type_bytes = meta_type_bytes(header->get("elementtype"));
  if (!type_bytes) return fail("has no known voxel type", where, "convert it to 16-bit integers");
  const std::vector<std::int64_t> channels = whole_numbers(header->get("elementnumberofchannels", "1"));
  if (channels != std::vector<std::int64_t>{1})
    return fail("has several values in each voxel", where, "give an image of one value a voxel");
  TROCAR_TRY(const std::uint64_t bytes, volume_bytes(whole_numbers(header->get("dimsize")), *type_bytes, where));

  Payload payload{.offset = header->end, .bytes = bytes};
  payload.is_compressed = ascii::lower_case(header->get("compresseddata")).starts_with('t');
  const std::vector<std::int64_t> packed = whole_numbers(header->get("compresseddatasize"));
  if (packed.size() == 1 && packed[0] > 0) payload.packed = static_cast<std::uint64_t>(packed[0]);
  payload.is_text = ascii::lower_case(header->get("binarydata", "true")).starts_with('f');
  payload.least_bytes = 2 * (bytes / *type_bytes) - 1;
  const std::string data_file = header->get("elementdatafile");
  if (ascii::lower_case(data_file) != "local") TROCAR_TRY_STATUS(take_data_file(data_file, where, payload));
  return payload;
}

/// nullptr: not an image file.
const ImageEnding* find_ending(const fs::path& path) {
  const std::string name = ascii::lower_case(path.filename().string());
  const auto* found = std::find_if(kImageEndings.begin(), kImageEndings.end(), [&](const ImageEnding& ending) {
    return name.size() > ending.text.size() && name.ends_with(ending.text);
  });
  return found != kImageEndings.end() ? found : nullptr;
}

Result<Payload> payload_of(const InputFile& file, ImageFormat format) {
  switch (format) {
    case ImageFormat::kNifti:
      return nifti_payload(file);
    case ImageFormat::kNrrd:
      return nrrd_payload(file);
    case ImageFormat::kMeta:
      return meta_payload(file);
  }
  return fail("not an image", file.path().string(), kExportAgain);
}

}  // namespace

Result<std::uint64_t> volume_bytes(const std::vector<std::int64_t>& sizes, std::uint64_t bytes_per_voxel,
                                   const std::string& where) {
  if (sizes.size() < 3) return fail("not a 3D image", where, "give a volume, not a picture");
  std::uint64_t voxels = 1;
  for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
    if (sizes[axis] < 1) return fail("the image is empty", where, kExportAgain);
    if (axis >= 3 && sizes[axis] > 1)
      return fail(fmt::format("is a 4D image with {} volumes", sizes[axis]), where, "extract one volume and give that");
    if (sizes[axis] > kMaxSide || (voxels *= static_cast<std::uint64_t>(sizes[axis])) > kMaxVoxels)
      return fail("the header claims an impossible size", where, kExportAgain);
  }
  if (sizes[0] < 2 || sizes[1] < 2 || sizes[2] < 2)
    return fail("is a single slice, not a volume", where, "give a volume of at least two slices");
  return voxels * bytes_per_voxel;
}

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

Result<CheckedImage> open_image_file(const fs::path& path, ImageFormat format, Check check, const fs::path& inside) {
  TROCAR_TRY(InputFile file, InputFile::open(path, FileKind::kVolume, inside));
  TROCAR_TRY(const Payload payload, payload_of(file, format));
  if (!payload.data_file.empty()) {
    if (!inside.empty()) return fail("the voxels are in another file", path.string(), "build the patient again");
    TROCAR_TRY(const InputFile data, open_data_file(path, payload.data_file, FileKind::kVolume));
    TROCAR_TRY_STATUS(check_payload(payload, data, check, path.string()));
    return CheckedImage{std::move(file), path};
  }
  TROCAR_TRY_STATUS(check_payload(payload, file, check, path.string()));
  // The NIfTI library selects the format by the file name's ending.
  fs::path library_path = format == ImageFormat::kNifti ? path : file.pinned_path();
  return CheckedImage{std::move(file), std::move(library_path)};
}

}  // namespace trocar::io::detail
