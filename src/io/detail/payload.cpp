#include "io/detail/payload.h"

#include <fmt/format.h>
#include <itk_zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "io/detail/header_payload.h"

namespace trocar::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSide = 65'535;            ///< Voxels along one axis.
constexpr std::uint64_t kMaxVoxels = 2'000'000'000;  ///< 4 GB of int16, far above any CT.
constexpr std::size_t kMaxHeaderBytes = 16u << 20;   ///< .seg.nrrd headers of many segments are long.
constexpr std::uint64_t kMaxDeflateRatio = 1'032;    ///< Deflate cannot pack tighter.

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

std::vector<std::int64_t> whole_numbers(const std::string& text) {
  std::vector<std::int64_t> numbers;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at < end) {
    if (std::isspace(static_cast<unsigned char>(*at))) {
      ++at;
      continue;
    }
    std::int64_t number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{}) return {};
    numbers.push_back(number);
    at = next;
  }
  return numbers;
}

/// Unpacks a gzip or zlib stream of `packed` bytes and throws the result away: true when it is sound and has at least
/// `bytes` of them.
bool is_sound_stream(std::ifstream& file, std::uint64_t packed, std::uint64_t bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, MAX_WBITS + 32) != Z_OK) return false;  // +32: gzip or zlib, whichever it is.
  const std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, inflateEnd);
  std::vector<unsigned char> in(kChunkBytes), out(kChunkBytes);
  std::uint64_t unpacked = 0;
  bool at_end = false;
  while (true) {
    if (stream.avail_in == 0) {
      file.read(reinterpret_cast<char*>(in.data()),
                static_cast<std::streamsize>(std::min<std::uint64_t>(in.size(), packed)));
      stream.next_in = in.data();
      stream.avail_in = static_cast<unsigned>(file.gcount());
      packed -= stream.avail_in;
      if (stream.avail_in == 0) return at_end && unpacked >= bytes;
    }
    if (at_end) {
      // A further gzip member, or whatever else stands behind the voxels.
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

Status check_payload(const Payload& payload, Check check, const std::string& where) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(payload.file, error);
  if (error)
    return fail("the file with the voxels is missing: " + payload.file.filename().string(), where,
                "keep header and data together");
  const std::uint64_t available = size > payload.offset ? size - payload.offset : 0;
  if (payload.is_text) return {};
  if (!payload.is_compressed) {
    if (available >= payload.bytes) return {};
    return fail(fmt::format("the image ends before its last voxel ({} of {} bytes)", available, payload.bytes), where,
                kExportAgain);
  }
  std::ifstream file(payload.file, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(payload.offset));
  const std::uint64_t packed = payload.packed > 0 ? payload.packed : available;
  const bool could_be_enough = packed <= available && available > 0 && payload.bytes / kMaxDeflateRatio <= available;
  if (could_be_enough && (check == Check::kSize || is_sound_stream(file, packed, payload.bytes))) return {};
  return fail("the compressed voxels are damaged or end too early", where, kExportAgain);
}

// --- NRRD and MetaImage: text headers -------------------------------------------------------------------------------

struct TextHeader {
  std::map<std::string, std::string> fields;  ///< Keys in lower case.
  std::uint64_t end = 0;                      ///< Where the line after the header starts.

  std::string get(const std::string& key, std::string fallback = {}) const {
    const auto found = fields.find(key);
    return found == fields.end() ? fallback : found->second;
  }
};

/// Reads "key<separator>value" lines up to an empty line or one that begins with `last_key`.
std::optional<TextHeader> read_text_header(const fs::path& path, char separator, std::string_view last_key) {
  std::ifstream file(path, std::ios::binary);
  TextHeader header;
  std::string line;
  while (header.end < kMaxHeaderBytes && std::getline(file, line)) {
    header.end += line.size() + (file.eof() ? 0 : 1);
    if (trim(line).empty()) return header;
    const auto at = line.find(separator);
    if (at == std::string::npos) continue;
    const std::string key = lower(trim(std::string_view(line).substr(0, at)));
    header.fields.emplace(key, trim(std::string_view(line).substr(at + 1)));
    if (key == last_key) return header;
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

Result<Payload> nrrd_payload(const fs::path& path) {
  const std::string where = path.string();
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> magic{};
  file.read(magic.data(), magic.size());
  const auto header = read_text_header(path, ':', {});
  if (std::string_view(magic.data(), 4) != "NRRD" || !header) return fail("is no NRRD image", where, kExportAgain);

  const auto type_bytes = nrrd_type_bytes(lower(header->get("type")));
  if (!type_bytes) return fail("has no known voxel type", where, "convert it to 16-bit integers");
  std::vector<std::int64_t> sizes = whole_numbers(header->get("sizes"));
  const std::uint64_t layers = take_list_axis(sizes, lower(header->get("kinds")));
  TROCAR_TRY(const std::uint64_t bytes, volume_bytes(sizes, *type_bytes * layers, where));

  const std::string encoding = lower(header->get("encoding"));
  Payload payload{path, header->end, bytes, 0, encoding == "gzip" || encoding == "gz", false};
  payload.is_text = encoding != "raw" && !payload.is_compressed;
  const std::string data_file = header->get("data file", header->get("datafile"));
  if (!data_file.empty()) {
    if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
      return fail("is spread over several files", where, "convert it to one .nrrd file");
    payload.file = path.parent_path() / data_file;
    payload.offset = 0;
  }
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

Result<Payload> meta_payload(const fs::path& path) {
  const std::string where = path.string();
  const auto header = read_text_header(path, '=', "elementdatafile");
  if (!header || header->get("dimsize").empty() || header->get("elementdatafile").empty())
    return fail("is no MetaImage", where, kExportAgain);
  const auto type_bytes = meta_type_bytes(header->get("elementtype"));
  if (!type_bytes) return fail("has no known voxel type", where, "convert it to 16-bit integers");
  const std::vector<std::int64_t> channels = whole_numbers(header->get("elementnumberofchannels", "1"));
  if (channels != std::vector<std::int64_t>{1})
    return fail("has several values in each voxel", where, "give an image of one value a voxel");
  TROCAR_TRY(const std::uint64_t bytes, volume_bytes(whole_numbers(header->get("dimsize")), *type_bytes, where));

  Payload payload{path, header->end, bytes, 0, lower(header->get("compresseddata")).starts_with('t'), false};
  const std::vector<std::int64_t> packed = whole_numbers(header->get("compresseddatasize"));
  if (packed.size() == 1 && packed[0] > 0) payload.packed = static_cast<std::uint64_t>(packed[0]);
  payload.is_text = lower(header->get("binarydata", "true")).starts_with('f');
  const std::string data_file = header->get("elementdatafile");
  if (lower(data_file) == "local") return payload;
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
    return fail("is spread over several files", where, "convert it to one .mha file");
  payload.file = path.parent_path() / data_file;
  payload.offset = 0;
  return payload;
}

}  // namespace

Result<std::uint64_t> volume_bytes(const std::vector<std::int64_t>& sizes, std::uint64_t bytes_per_voxel,
                                   const std::string& where) {
  if (sizes.size() < 3) return fail("is no 3D image", where, "give a volume, not a picture");
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
  const std::string name = lower(path.filename().string());
  if (name.ends_with(".nii") || name.ends_with(".nii.gz")) return ImageFormat::kNifti;
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr")) return ImageFormat::kNrrd;
  if (name.ends_with(".mha") || name.ends_with(".mhd")) return ImageFormat::kMeta;
  return fail("is no image file of a known kind", path.string(),
              "give a .nii, .nii.gz, .nrrd, .seg.nrrd, .mha or .mhd file, or the folder of a DICOM series");
}

Status check_image_file(const fs::path& path, ImageFormat format, Check check) {
  const auto payload = format == ImageFormat::kNifti  ? nifti_payload(path)
                       : format == ImageFormat::kNrrd ? nrrd_payload(path)
                                                      : meta_payload(path);
  if (!payload) return tl::unexpected(payload.error());
  return check_payload(*payload, check, path.string());
}

}  // namespace trocar::detail
