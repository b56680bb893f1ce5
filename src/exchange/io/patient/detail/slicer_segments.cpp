// .seg.nrrd files of 3D Slicer.
#include "io/patient/detail/slicer_segments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "core/text.h"
#include "io/patient/detail/mask_folder.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

struct Segment3dSlicer {
  DescribedSegment description;
  int value = 1;
  int layer = 0;
};

/// Splits "a~b~c" at `separator`.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// One of its codes: SCHEME^CODE^MEANING, with the side that its modifier gives.
struct SlicerCode {
  std::string code;
  std::string meaning;
};

std::optional<SlicerCode> slicer_code(const std::vector<std::string_view>& parts, std::size_t at) {
  const auto words = at < parts.size() ? split(parts[at], '^') : std::vector<std::string_view>();
  if (words.size() != 3 || words[1].empty()) return std::nullopt;
  const auto modifier = at + 1 < parts.size() ? split(parts[at + 1], '^') : std::vector<std::string_view>();
  std::string side;
  if (modifier.size() == 3) {
    if (modifier[1] == "7771000" || modifier[1] == "G-A101" || modifier[2] == "Left") side = " left";
    if (modifier[1] == "24028007" || modifier[1] == "G-A100" || modifier[2] == "Right") side = " right";
  }
  return SlicerCode{fmt::format("{}:{}{}", words[0], words[1], side), fmt::format("{}{}", words[2], side)};
}

/// Its tags contain "TerminologyEntry:CONTEXT~CATEGORY~TYPE~MODIFIER~CONTEXT~REGION~MODIFIER".
DescribedSegment describe(const std::string& name, int value, std::string_view tags) {
  DescribedSegment segment{name, value, {}, {}, {}};
  constexpr std::string_view kEntry = "TerminologyEntry:";
  const std::size_t at = tags.find(kEntry);
  if (at == std::string_view::npos) return segment;
  const auto parts = split(tags.substr(at + kEntry.size(), tags.find('|', at) - at - kEntry.size()), '~');
  const auto category = slicer_code(parts, 1), type = slicer_code(parts, 2), region = slicer_code(parts, 5);
  // A lesion in an organ is no part of the organ (as in DICOM SEG).
  const bool is_altered =
      category && (category->code.starts_with("SCT:49755003") || category->code.starts_with("SRT:M-01000"));
  if (type && region) segment.type_in_region = region->meaning + " " + type->meaning;
  for (const auto& code : {type, is_altered ? std::nullopt : region}) {
    if (!code) continue;
    segment.codes.push_back(code->code);
    segment.meanings.push_back(code->meaning);
  }
  return segment;
}

/// The numbers N of the fields Segment{N}_…, in order; none for an ordinary file.
std::set<int> segment_numbers(const std::map<std::string, std::string>& fields) {
  constexpr std::string_view kPrefix = "Segment";
  std::set<int> numbers;
  for (auto field = fields.lower_bound(std::string(kPrefix)); field != fields.end(); ++field) {
    const std::string_view key = field->first;
    if (!key.starts_with(kPrefix)) break;
    const auto number = find_leading_number<int>(key.substr(kPrefix.size()));
    if (number && number->rest.starts_with('_')) numbers.insert(number->value);
  }
  return numbers;
}

/// "segment0_Name", "Segment0_labelValue": a field of a segment in a spelling that no program reads.
std::optional<std::string> misspelt_field(const std::map<std::string, std::string>& fields) {
  constexpr std::string_view kPrefix = "segment";
  constexpr std::array<std::string_view, 3> kNames{"_Name", "_LabelValue", "_Layer"};
  for (const auto& [key, value] : fields) {
    const std::string lower = ascii::lower_case(key);
    if (!lower.starts_with(kPrefix)) continue;
    const auto number = find_leading_number<int>(std::string_view(key).substr(kPrefix.size()));
    if (!number) continue;
    for (const std::string_view name : kNames)
      if (ascii::lower_case(std::string(number->rest)) == ascii::lower_case(std::string(name)) &&
          (number->rest != name || !key.starts_with("Segment")))
        return key;
  }
  return std::nullopt;
}

/// Segments described in the header: Segment{N}_Name, _LabelValue, _Layer. Empty for an ordinary file. Errors: a
/// segment without a name, without a value, in a layer that the image does not have, or with another one's value in its
/// layer: nothing may be guessed that decides which organ a voxel belongs to.
Result<std::vector<Segment3dSlicer>> segments_in(const RawVolume& raw, const fs::path& path) {
  const std::map<std::string, std::string> fields(raw.fields.begin(), raw.fields.end());
  const auto refused = [&](const std::string& what) {
    return fail(what, path.string(), "save the segmentation again in 3D Slicer");
  };
  if (const auto key = misspelt_field(fields)) return refused(fmt::format("the header misspells a field: {}", *key));
  std::vector<Segment3dSlicer> segments;
  for (const int n : segment_numbers(fields)) {
    const std::string prefix = fmt::format("Segment{}_", n);
    const auto name = fields.find(prefix + "Name"), value_text = fields.find(prefix + "LabelValue");
    const auto layer_text = fields.find(prefix + "Layer"), tags = fields.find(prefix + "Tags");
    if (name == fields.end()) return refused(fmt::format("the header has no {}Name", prefix));
    if (value_text == fields.end())
      return refused(fmt::format("the segment \"{}\" has no label value ({}LabelValue)", name->second, prefix));
    const auto value = parse_number<int>(value_text->second);
    if (!value || *value < 1 || *value > kMaxLabel)
      return refused(
          fmt::format("{}LabelValue is \"{}\", not a number from 1 to {}", prefix, value_text->second, kMaxLabel));
    // A file of one layer may leave it out.
    const std::string layer_number = layer_text != fields.end() ? layer_text->second : raw.components > 1 ? "" : "0";
    const int layer = parse_number<int>(layer_number).value_or(-1);
    if (layer < 0 || layer >= raw.components)
      return refused(
          fmt::format("the segment \"{}\" has no layer of the image, which has {}", name->second, raw.components));
    for (const Segment3dSlicer& other : segments)
      if (other.value == *value && other.layer == layer)
        return refused(fmt::format("the segments \"{}\" and \"{}\" have the same label value {}",
                                   other.description.name, name->second, *value));
    segments.push_back(
        {describe(name->second, *value, tags == fields.end() ? std::string() : tags->second), *value, layer});
  }
  return segments;
}

/// One source per layer: overlapping segments are in different layers.
Result<std::vector<patient_builder::LabelSource>> read_segments(const RawVolume& raw,
                                                                const std::vector<Segment3dSlicer>& segments,
                                                                const LabelMap& map, const fs::path& path,
                                                                std::vector<std::string>& warnings) {
  for (const Segment3dSlicer& segment : segments)
    if (const std::string contradiction = map.contradiction_in(segment.description); !contradiction.empty())
      warnings.push_back(path.filename().string() + ": " + contradiction);
  const auto count = static_cast<std::size_t>(raw.components);
  const std::size_t voxel_bytes = bytes_per_voxel(raw.type);
  std::vector<patient_builder::LabelSource> sources;
  for (std::size_t layer = 0; layer < count; ++layer) {
    RawVolume single;
    single.geometry = raw.geometry;
    single.type = raw.type;
    single.slope = raw.slope;
    single.intercept = raw.intercept;
    single.bytes = std::make_unique_for_overwrite<std::byte[]>(single.byte_count());
    for (std::size_t n = 0; n < raw.geometry.voxel_count(); ++n)
      std::copy_n(raw.bytes.get() + (n * count + layer) * voxel_bytes, voxel_bytes,
                  single.bytes.get() + n * voxel_bytes);
    patient_builder::LabelSource source{path.string(), {}, {}, true, {}};
    TROCAR_TRY(source.labels, to_grid<std::uint8_t>(single, path.string(), convert_voxels));
    for (const Segment3dSlicer& segment : segments)
      if (segment.layer == static_cast<int>(layer))
        source.names.emplace_back(segment.value, map.name_of(segment.description));
    for (const int value : values_in(source.labels))
      if (std::none_of(source.names.begin(), source.names.end(), [&](const auto& n) { return n.first == value; }))
        return fail(fmt::format("label value {} belongs to no segment", value), path.string(),
                    "save the segmentation again in 3D Slicer");
    if (!source.names.empty()) sources.push_back(std::move(source));
  }
  return sources;
}

}  // namespace

Result<std::vector<patient_builder::LabelSource>> read_slicer_segments(const RawVolume& raw, const LabelMap& map,
                                                                       const fs::path& path,
                                                                       std::vector<std::string>& warnings) {
  TROCAR_TRY(const std::vector<Segment3dSlicer> segments, segments_in(raw, path));
  if (segments.empty()) return std::vector<patient_builder::LabelSource>{};
  return read_segments(raw, segments, map, path, warnings);
}

}  // namespace trocar::io::detail
