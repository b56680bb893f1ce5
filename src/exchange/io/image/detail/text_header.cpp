#include "io/image/detail/text_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "core/text.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {
namespace {

constexpr std::size_t kMostLines = 10'000;  ///< A segmentation of 255 structures has about 3,000.
constexpr std::uint64_t kMostHeaderBytes = std::uint64_t{4} << 20;        ///< The libraries hold it several times.
constexpr std::size_t kLongestNrrdField = 500, kLongestPair = 64 * 1024;  // nine numbers of 24 letters fit
constexpr std::size_t kLongestMetaField = 250;                            ///< MetaIO keeps texts in arrays of 255.
constexpr std::size_t kLongestKey = 250;
constexpr std::string_view kLastMetaKey = "ElementDataFile";

/// The libraries and this program must read the same lines: no control characters, and no line of blanks, which ends
/// the header for some readers only.
bool is_plain_line(std::string_view line) {
  const bool has_control =
      std::any_of(line.begin(), line.end(), [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
  return !has_control && (line.empty() || !trim(line).empty());
}

/// One line without its end; false at the end of the file. Reads at most the longest line that is accepted, and one
/// character more.
bool read_line(std::ifstream& file, std::string& line, std::uint64_t& position) {
  line.clear();
  for (char c = 0; line.size() <= kLongestPair && file.get(c);) {
    ++position;
    if (c == '\n') {
      if (line.ends_with('\r')) line.pop_back();
      return true;
    }
    line.push_back(c);
  }
  return !line.empty();
}

struct Field {
  std::string key, value;
};

/// A NRRD line is a field ("space: …"), a pair ("key:=value"), a comment or the magic; only a field is returned.
std::optional<Field> nrrd_field(std::string_view line) {
  const std::size_t field = line.find(": "), pair = line.find(":=");
  if (line.starts_with('#') || field == std::string_view::npos || pair < field) {
    // "field:" without a value or a space.
    const bool is_bare = !line.starts_with('#') && pair == std::string_view::npos;
    const std::size_t colon = is_bare ? line.find(':') : std::string_view::npos;
    if (colon == std::string_view::npos) return std::nullopt;
    return Field{ascii::lower_case(trim(line.substr(0, colon))), trim(line.substr(colon + 1))};
  }
  return Field{ascii::lower_case(trim(line.substr(0, field))), trim(line.substr(field + 2))};
}

std::optional<Field> meta_field(std::string_view line) {
  const std::size_t at = line.find('=');
  if (at == std::string_view::npos) return std::nullopt;
  return Field{ascii::lower_case(trim(line.substr(0, at))), trim(line.substr(at + 1))};
}

class TextHeaderReader {
 public:
  TextHeaderReader(const InputFile& input, TextHeaderKind kind)
      : where_(input.path().string()), kind_(kind), file_(input.pinned_path(), std::ios::binary) {}

  Result<TextHeader> read() {
    std::string line;
    for (std::size_t number = 1; read_line(file_, line, header_.end); ++number) {
      TROCAR_TRY(const bool is_last, take(line, number));
      if (is_last) return std::move(header_);
    }
    if (kind_ == TextHeaderKind::kMeta) return damaged("the header has no line ElementDataFile");
    if (header_.fields.empty()) return damaged("the header has no field");
    return std::move(header_);
  }

 private:
  tl::unexpected<Error> damaged(const std::string& what) const { return fail(what, where_, kExportAgain); }

  /// True: the header ends with this line.
  Result<bool> take(const std::string& line, std::size_t number) {
    if (header_.end > kMostHeaderBytes)
      return damaged(fmt::format("the header has more than {} MiB", kMostHeaderBytes >> 20));
    if (number > kMostLines) return damaged(fmt::format("the header has more than {} lines", kMostLines));
    if (line.size() > kLongestPair)
      return damaged(fmt::format("line {} of the header is longer than {} characters", number, kLongestPair));
    if (!is_plain_line(line))
      return damaged(fmt::format("line {} of the header contains control characters or only blanks", number));
    if (line.empty()) return true;
    const bool is_nrrd = kind_ == TextHeaderKind::kNrrd;
    const auto field = is_nrrd ? nrrd_field(line) : meta_field(line);
    if (!field) {
      // A pair, a comment, or the magic; the library repeats any other line in its message.
      const bool is_other = is_nrrd && (number == 1 || line.starts_with('#') || line.find(":=") <= kLongestKey);
      if (!is_other) return damaged(fmt::format("line {} of the header is no field", number));
      const std::size_t pair = is_nrrd && !line.starts_with('#') ? line.find(":=") : std::string::npos;
      if (pair != std::string::npos && !pairs_.insert(trim(std::string_view(line).substr(0, pair))).second)
        return damaged(fmt::format("the header has the key \"{}\" twice", trim(line.substr(0, pair))));
      return false;
    }
    const std::size_t most = is_nrrd ? kLongestNrrdField : kLongestMetaField;
    if (line.size() > most || field->key.size() > kLongestKey)
      return damaged(fmt::format("line {} of the header is too long: a field of {} characters", number, line.size()));
    if (!header_.fields.emplace(field->key, field->value).second)
      return damaged(fmt::format("the header has the field \"{}\" twice", field->key));
    if (is_nrrd || field->key != ascii::lower_case(std::string(kLastMetaKey))) return false;
    // The library accepts this key in this spelling only, and would otherwise continue to read.
    if (!line.starts_with(kLastMetaKey)) return damaged("the header spells ElementDataFile in another way");
    return true;
  }

  std::string where_;
  TextHeaderKind kind_;
  std::ifstream file_;
  std::set<std::string> pairs_;  ///< Keys of NRRD's "key:=value".
  TextHeader header_;
};

template <class Number>
std::vector<Number> numbers_in(std::string_view text) {
  std::vector<Number> numbers;
  for (std::string_view rest = text; !rest.empty();) {
    if (ascii::is_space(rest.front())) {
      rest.remove_prefix(1);
      continue;
    }
    const auto number = find_leading_number<Number>(rest);
    if (!number || (!number->rest.empty() && !ascii::is_space(number->rest.front()))) return {};
    numbers.push_back(number->value);
    rest = number->rest;
  }
  return numbers;
}

}  // namespace

std::string TextHeader::get(const std::string& key, std::string fallback) const {
  const auto found = fields.find(key);
  return found == fields.end() ? fallback : found->second;
}

bool has_frame_transforms(const TextHeader& header) {
  return std::any_of(header.fields.begin(), header.fields.end(), [](const auto& field) {
    return field.first.starts_with("seq_frame") && field.first.ends_with("transform");
  });
}

Result<TextHeader> read_text_header(const InputFile& input, TextHeaderKind kind) {
  return TextHeaderReader(input, kind).read();
}

std::string trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

std::vector<std::int64_t> whole_numbers(std::string_view text) {
  return numbers_in<std::int64_t>(text);
}

std::vector<double> real_numbers(std::string_view text) {
  return numbers_in<double>(text);
}

}  // namespace trocar::io::detail

// The header of a MetaImage file (format definition: itk.org/Wiki/ITK/MetaIO/Documentation).

namespace trocar::io::detail {
namespace {

std::optional<std::uint64_t> meta_type_bytes(const std::string& type) {
  if (type == "MET_CHAR" || type == "MET_UCHAR") return 1;
  if (type == "MET_SHORT" || type == "MET_USHORT") return 2;
  if (type == "MET_INT" || type == "MET_UINT" || type == "MET_FLOAT") return 4;
  if (type == "MET_LONG" || type == "MET_ULONG") return 4;
  if (type == "MET_LONG_LONG" || type == "MET_ULONG_LONG" || type == "MET_DOUBLE") return 8;
  return std::nullopt;
}

/// Numbers of the one field among these names that the header has. Errors: two of them, another count.
Result<std::vector<double>> numbers_of(const TextHeader& header, std::initializer_list<const char*> names,
                                       std::size_t count, const std::string& where) {
  std::vector<double> numbers;
  const char* found = nullptr;
  for (const char* name : names) {
    if (!header.has(ascii::lower_case(name))) continue;
    if (found != nullptr)
      return fail(fmt::format("the header has both {} and {}", found, name), where, kSaveIn3dSlicer);
    found = name;
    numbers = real_numbers(header.get(ascii::lower_case(name)));
  }
  if (found == nullptr)
    return fail(fmt::format("the header has no {}, so the place of the image is unknown", *names.begin()), where,
                kSaveIn3dSlicer);
  if (numbers.size() != count)
    return fail(fmt::format("the header's {} is not {} finite numbers", found, count), where, kSaveIn3dSlicer);
  return numbers;
}

/// The letters say from where each axis comes: RAI runs from right to left, anterior to posterior, inferior to
/// superior, as LPS does.
std::optional<Vec3> direction_from(char letter) {
  switch (letter) {
    case 'R':
      return Vec3::UnitX();
    case 'L':
      return -Vec3::UnitX();
    case 'A':
      return Vec3::UnitY();
    case 'P':
      return -Vec3::UnitY();
    case 'I':
      return Vec3::UnitZ();
    case 'S':
      return -Vec3::UnitZ();
    default:
      return std::nullopt;
  }
}

/// AnatomicalOrientation repeats the directions in words. "???" and the like say nothing.
Status check_orientation(const TextHeader& header, const volume::GridGeometry& geometry, const std::string& where) {
  const std::string letters = header.get("anatomicalorientation");
  if (letters.size() != 3) return {};
  constexpr double kAtMost60Degrees = 0.5;
  for (int axis = 0; axis < 3; ++axis) {
    const auto direction = direction_from(letters[static_cast<std::size_t>(axis)]);
    if (!direction || geometry.R_PV.col(axis).normalized().dot(*direction) >= kAtMost60Degrees) continue;
    return fail(fmt::format("the header's AnatomicalOrientation {} contradicts its TransformMatrix", letters), where,
                kSaveIn3dSlicer);
  }
  return {};
}

Status read_place(const TextHeader& header, const std::string& where, std::size_t dimensions, ImageHeader& image) {
  const std::string units = ascii::lower_case(header.get("distanceunits", "mm"));
  if (units != "mm" && units != "?" && units != "unknown")
    return fail(fmt::format("the header's DistanceUnits are {}, not mm", header.get("distanceunits")), where,
                "export it again in mm");
  TROCAR_TRY(const auto matrix,
             numbers_of(header, {"TransformMatrix", "Rotation", "Orientation"}, dimensions * dimensions, where));
  TROCAR_TRY(const auto offset, numbers_of(header, {"Offset", "Origin", "Position"}, dimensions, where));
  TROCAR_TRY(const auto spacing, numbers_of(header, {"ElementSpacing"}, dimensions, where));
  Mat3 axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vec3 direction(matrix[dimensions * axis], matrix[dimensions * axis + 1], matrix[dimensions * axis + 2]);
    if (!(spacing[axis] > 0.0))
      return fail(fmt::format("the header's ElementSpacing {} is not above zero", spacing[axis]), where,
                  "export the image with its spacing");
    if (std::abs(direction.norm() - 1.0) > kMaxShear)
      return fail("the header's TransformMatrix scales the image", where, "resample it onto a straight grid");
    axes.col(static_cast<int>(axis)) = direction * spacing[axis];
  }
  TROCAR_TRY_STATUS(set_place(axes, Vec3(offset[0], offset[1], offset[2]), "TransformMatrix", where, image.geometry));
  return check_orientation(header, image.geometry, where);
}

/// Intensity = stored number * slope + offset; ITK does not apply them.
Status read_intensity(const TextHeader& header, const std::string& where, ImageHeader& image) {
  const auto read = [&](const std::string& name, double& value) -> Status {
    const std::string key = ascii::lower_case(name);
    if (!header.has(key)) return {};
    const std::vector<double> numbers = real_numbers(header.get(key));
    if (numbers.size() != 1)
      return fail(fmt::format("the header's {} is not a finite number", name), where, kExportAgain);
    value = numbers[0];
    return {};
  };
  TROCAR_TRY_STATUS(read("ElementToIntensityFunctionSlope", image.slope));
  TROCAR_TRY_STATUS(read("ElementToIntensityFunctionOffset", image.intercept));
  if (image.slope == 0.0)
    return fail("the header's ElementToIntensityFunctionSlope is 0", where, "export the image with its scaling");
  return {};
}

Status read_payload(const TextHeader& header, const InputFile& input, std::uint64_t voxel_bytes, Payload& payload) {
  const std::string where = input.path().string();
  payload.is_compressed = ascii::lower_case(header.get("compresseddata")).starts_with('t');
  const std::vector<std::int64_t> packed = whole_numbers(header.get("compresseddatasize"));
  if (packed.size() == 1 && packed[0] > 0) payload.packed = static_cast<std::uint64_t>(packed[0]);
  if (payload.is_compressed && payload.packed == 0)
    return fail("the voxels are compressed, but the header has no CompressedDataSize", where, kSaveIn3dSlicer);
  if (header.get("headersize", "0") != "0")
    return fail("the header skips bytes before the voxels (HeaderSize)", where, kSaveIn3dSlicer);
  payload.is_text = ascii::lower_case(header.get("binarydata", "true")).starts_with('f');
  payload.least_bytes = 2 * (payload.bytes / voxel_bytes) - 1;
  const std::string data_file = header.get("elementdatafile");
  if (ascii::lower_case(data_file) == "local") return {};
  if (data_file.empty()) return fail("the header names no data", where, kExportAgain);
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
    return fail("the voxels are in several files", where, "convert the image to one file (.nrrd or .mha)");
  payload.data_file = data_file;
  payload.offset = 0;
  return {};
}

}  // namespace

Result<ImageHeader> read_meta_header(const InputFile& input) {
  const std::string where = input.path().string();
  TROCAR_TRY(const TextHeader header, read_text_header(input, TextHeaderKind::kMeta));
  if (!header.has("dimsize")) return fail("not a MetaImage (no DimSize)", where, kExportAgain);
  if (has_frame_transforms(header))
    return fail("a tracked sequence of images, not a volume", where,
                "make a volume of it first: trocar ultrasound reconstruct");
  const std::vector<std::int64_t> sizes = whole_numbers(header.get("dimsize"));
  const std::vector<std::int64_t> dimensions = whole_numbers(header.get("ndims"));
  if (dimensions.size() != 1 || dimensions[0] != static_cast<std::int64_t>(sizes.size()))
    return fail(fmt::format("the header's NDims {} is not the number of sides in DimSize", header.get("ndims")), where,
                kExportAgain);
  const auto voxel_bytes = meta_type_bytes(header.get("elementtype"));
  if (!voxel_bytes) return fail("has no known voxel type", where, "convert it to 16-bit integers");
  const std::vector<std::int64_t> channels = whole_numbers(header.get("elementnumberofchannels", "1"));
  if (channels != std::vector<std::int64_t>{1})
    return fail("has several values in each voxel", where, "give an image of one value a voxel");

  ImageHeader image;
  image.payload.offset = header.end;
  TROCAR_TRY(image.payload.bytes, volume_bytes(sizes, *voxel_bytes, where));
  TROCAR_TRY_STATUS(read_payload(header, input, *voxel_bytes, image.payload));
  image.geometry.size = sides(sizes);
  TROCAR_TRY_STATUS(read_place(header, where, sizes.size(), image));
  TROCAR_TRY_STATUS(read_intensity(header, where, image));
  return image;
}

}  // namespace trocar::io::detail
