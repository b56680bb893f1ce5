// The header of a NRRD file (format definition: teem.sourceforge.net/nrrd/format.html).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

#include "core/text.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/text_header.h"

namespace trocar::io::detail {
namespace {

constexpr std::array kKnownFields{"dimension",
                                  "type",
                                  "sizes",
                                  "encoding",
                                  "endian",
                                  "content",
                                  "space",
                                  "kinds",
                                  "space dimension",
                                  "space origin",
                                  "space directions",
                                  "labels",
                                  "units",
                                  "space units",
                                  "spacings",
                                  "measurement frame",
                                  "thicknesses",
                                  "axis mins",
                                  "axis maxs",
                                  "axismins",
                                  "axismaxs",
                                  "centers",
                                  "centerings",
                                  "min",
                                  "max",
                                  "old min",
                                  "old max",
                                  "oldmin",
                                  "oldmax",
                                  "block size",
                                  "blocksize",
                                  "line skip",
                                  "lineskip",
                                  "byte skip",
                                  "byteskip",
                                  "number",
                                  "data file",
                                  "datafile",
                                  "sample units",
                                  "sampleunits"};

/// A space whose axes are named by the body: signs of its axes in LPS.
struct Space {
  std::string_view name, short_name;
  Vec3 signs;
  bool is_read_by_itk;  ///< ITK 5.2 turns a left-anterior-superior image about its long axis.
};
const std::array kSpaces{Space{"left-posterior-superior", "lps", {1.0, 1.0, 1.0}, true},
                         Space{"right-anterior-superior", "ras", {-1.0, -1.0, 1.0}, true},
                         Space{"left-anterior-superior", "las", {1.0, -1.0, 1.0}, false}};

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

/// "(1,0,0.5)" at the start of `text`, which is shortened by it.
std::optional<Vec3> take_vector(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos || text[begin] != '(') return std::nullopt;
  const std::size_t end = text.find(')', begin);
  if (end == std::string_view::npos) return std::nullopt;
  std::string inside(text.substr(begin + 1, end - begin - 1));
  if (std::count(inside.begin(), inside.end(), ',') != 2) return std::nullopt;
  std::replace(inside.begin(), inside.end(), ',', ' ');
  const std::vector<double> numbers = real_numbers(inside);
  if (numbers.size() != 3) return std::nullopt;
  text.remove_prefix(end + 1);
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

/// Steps along the three axes of the image; "none" stands for the axis of layers, which comes first.
std::optional<Mat3> directions_in(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin != std::string_view::npos && text.substr(begin).starts_with("none")) text.remove_prefix(begin + 4);
  Mat3 axes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto step = take_vector(text);
    if (!step) return std::nullopt;
    axes.col(axis) = *step;
  }
  if (!trim(text).empty()) return std::nullopt;
  return axes;
}

Result<Space> space_of(const TextHeader& header, const std::string& where) {
  const std::string name = ascii::lower_case(header.get("space"));
  if (name.empty())
    return fail("the header does not say in which space the image lies (no field \"space\")", where, kSaveIn3dSlicer);
  for (const Space& space : kSpaces)
    if (name == space.name || name == space.short_name) return space;
  return fail(fmt::format("the header's space \"{}\" does not say where the patient's left, back and head are",
                          header.get("space")),
              where, kSaveIn3dSlicer);
}

/// Units are quoted texts: "mm" "mm" "mm". Empty ones say nothing.
Status check_units(const TextHeader& header, const std::string& where) {
  const std::string units = header.get("space units");
  for (std::size_t at = units.find('"'); at != std::string::npos;) {
    const std::size_t end = units.find('"', at + 1);
    if (end == std::string::npos) break;
    const std::string unit = ascii::lower_case(trim(units.substr(at + 1, end - at - 1)));
    if (!unit.empty() && unit != "mm" && unit != "millimeter" && unit != "millimetre")
      return fail(fmt::format("the header's \"space units\" are {}, not mm", units), where, "export it again in mm");
    at = units.find('"', end + 1);
  }
  return {};
}

Status read_place(const TextHeader& header, const std::string& where, ImageHeader& image) {
  TROCAR_TRY(const Space space, space_of(header, where));
  TROCAR_TRY_STATUS(check_units(header, where));
  std::string_view origin_text, directions_text;
  const std::string origin = header.get("space origin"), directions = header.get("space directions");
  origin_text = origin;
  directions_text = directions;
  const auto axes = directions_in(directions_text);
  const auto start = take_vector(origin_text);
  if (!axes || !start || !trim(origin_text).empty())
    return fail("the header has no three \"space directions\" and one \"space origin\" that are finite numbers", where,
                kSaveIn3dSlicer);
  if (header.has("spacings") || header.has("axis mins") || header.has("axismins"))
    return fail("the header gives the place of the voxels twice: by \"space directions\" and for each axis", where,
                kSaveIn3dSlicer);
  image.is_place_compared = space.is_read_by_itk;
  const Mat3 to_lps = space.signs.asDiagonal();
  return set_place(to_lps * *axes, to_lps * *start, "space directions", where, image.geometry);
}

/// Stores the data file named in the header, or how far the voxels are from its end.
Status read_data_place(const TextHeader& header, const InputFile& input, Payload& payload) {
  const std::string where = input.path().string();
  const std::string skipped = header.get("byte skip", header.get("byteskip", "0"));
  const std::string lines = header.get("line skip", header.get("lineskip", "0"));
  if (skipped != "0" || lines != "0")
    return fail("the header skips bytes or lines before the voxels", where, kSaveIn3dSlicer);
  const std::string data_file = header.get("data file", header.get("datafile"));
  if (data_file.empty()) return {};
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
    return fail("the voxels are in several files", where, "convert the image to one file (.nrrd or .mha)");
  payload.data_file = data_file;
  payload.offset = 0;
  return {};
}

Status check_fields(const TextHeader& header, const std::string& where) {
  for (const auto& [key, value] : header.fields)
    if (std::find(kKnownFields.begin(), kKnownFields.end(), key) == kKnownFields.end())
      return fail(fmt::format("the header has the field \"{}\", which NRRD does not know", key), where,
                  "save it again in 3D Slicer, or write the line as \"key:=value\"");
  return {};
}

}  // namespace

Result<ImageHeader> read_nrrd_header(const InputFile& input) {
  const std::string where = input.path().string();
  std::ifstream file(input.pinned_path(), std::ios::binary);
  std::array<char, 4> magic{};
  file.read(magic.data(), magic.size());
  if (std::string_view(magic.data(), 4) != "NRRD") return fail("not a NRRD image", where, kExportAgain);
  TROCAR_TRY(const TextHeader header, read_text_header(input, TextHeaderKind::kNrrd));
  TROCAR_TRY_STATUS(check_fields(header, where));

  const std::string endian = ascii::lower_case(header.get("endian", "little"));
  if (endian != "little" && endian != "big")
    return fail("the header's \"endian\" is neither little nor big", where, kExportAgain);
  const auto voxel_bytes = nrrd_type_bytes(ascii::lower_case(header.get("type")));
  if (!voxel_bytes) return fail("has no known voxel type", where, "convert it to 16-bit integers");
  std::vector<std::int64_t> sizes = whole_numbers(header.get("sizes"));
  if (parse_number<std::size_t>(header.get("dimension")) != sizes.size())
    return fail("the header's \"dimension\" is not the number of its \"sizes\"", where, kExportAgain);
  const std::uint64_t layers = take_list_axis(sizes, ascii::lower_case(header.get("kinds")));
  TROCAR_TRY(const std::uint64_t bytes, volume_bytes(sizes, *voxel_bytes * layers, where));

  const std::string encoding = ascii::lower_case(header.get("encoding"));
  ImageHeader image;
  Payload& payload = image.payload;
  payload.offset = header.end;
  payload.bytes = bytes;
  payload.is_compressed = encoding == "gzip" || encoding == "gz";
  payload.is_text = encoding == "ascii" || encoding == "text" || encoding == "txt" || encoding == "hex";
  if (encoding != "raw" && !payload.is_compressed && !payload.is_text)
    return fail(fmt::format("the encoding \"{}\" is not supported", encoding), where, "save it with encoding gzip");
  payload.is_hex = encoding == "hex";
  payload.least_bytes = encoding == "hex" ? 2 * bytes : 2 * (bytes / *voxel_bytes) - 1;
  TROCAR_TRY_STATUS(read_data_place(header, input, payload));
  image.geometry.size = sides(sizes);
  TROCAR_TRY_STATUS(read_place(header, where, image));
  return image;
}

}  // namespace trocar::io::detail
