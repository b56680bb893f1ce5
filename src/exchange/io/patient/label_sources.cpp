#include "io/patient/label_sources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/parallel.h"
#include "core/parse_number.h"
#include "io/dicom/detail/find_series.h"
#include "io/image/detail/payload.h"
#include "io/image/detail/read_grid.h"
#include "io/patient/detail/dicom_labels.h"
#include "io/patient/detail/label_checks.h"
#include "io/patient/detail/mask_folder.h"
#include "io/patient/label_map.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

/// Fewer numbers than a whole body has can as well be another program's: 1 = liver, 2 = tumour.
constexpr std::size_t kFewNumbers = 10;
constexpr std::size_t kFilesAtOnce = 8;  ///< Masks unpacked at a time: limits the memory.

enum class Place { kNamedByUser, kInFolder };

/// A file with one value is a mask named after its file. A single file can also be a segmentation with one structure:
/// this holds if only the label map knows a name.
bool is_mask(const std::vector<int>& values, const std::string& stem, const LabelMap& map, Place place) {
  if (values.size() != 1) return values.empty();
  return place == Place::kInFolder || map.structures().find(stem) != nullptr || !map.has_number(values.front());
}

/// "1 = spleen, 5 = liver"
std::string readings_text(const std::vector<std::pair<int, std::string>>& names) {
  std::vector<std::string> texts;
  for (const auto& [number, name] : names) texts.push_back(fmt::format("{} = {}", number, name));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Values without a name are reported by build_patient, which lists those of all files.
Result<anatomy::LabelSource> name_labels(volume::LabelGrid labels, const fs::path& path, const LabelMap& map,
                                         Place place, std::vector<std::string>& warnings) {
  anatomy::LabelSource source{path.string(), std::move(labels), {}, false, {}};
  const std::vector<int> values = detail::values_in(source.labels);
  const std::string stem = detail::image_stem(path);
  if (is_mask(values, stem, map, place)) {
    source.names = {{values.empty() ? 1 : values.front(), map.name_of(stem)}};
    return source;
  }
  if (values.size() == 1 && place == Place::kNamedByUser)
    warnings.push_back(
        fmt::format("the only label of {}, {}, is \"{}\" by the label map: if this is wrong, name the file "
                    "after its structure",
                    path.filename().string(), values.front(), map.name_of(values.front()).value_or("")));
  if (map.is_empty())
    return fail(fmt::format("has {} label values but no names for them", values.size()), path.string(),
                "name them: --label-map totalsegmentator, or a TOML file with [labels] 1 = \"liver\" …");
  for (const int value : values)
    if (auto name = map.name_of(value)) source.names.emplace_back(value, std::move(*name));
  if (values.size() > 1 && values.size() < kFewNumbers && map.is_totalsegmentator())
    warnings.push_back(
        fmt::format("the numbers of {} are read as TotalSegmentator's: {}; if this is wrong, name them by "
                    "--label-map",
                    path.filename().string(), readings_text(source.names)));
  if (auto other = map.likely_mistake()) source.other_readings.push_back(*std::move(other));
  return source;
}

// .seg.nrrd files of 3D Slicer.

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

/// Segments described in the header: Segment{N}_Name, _LabelValue, _Layer. Empty for an ordinary file. Errors: a
/// segment without a name, without a value, in a layer that the image does not have, or with another one's value in its
/// layer: nothing may be guessed that decides which organ a voxel belongs to.
Result<std::vector<Segment3dSlicer>> segments_in(const detail::RawVolume& raw, const fs::path& path) {
  const std::map<std::string, std::string> fields(raw.fields.begin(), raw.fields.end());
  const auto refused = [&](const std::string& what) {
    return fail(what, path.string(), "save the segmentation again in 3D Slicer");
  };
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
Result<std::vector<anatomy::LabelSource>> read_segments(const detail::RawVolume& raw,
                                                        const std::vector<Segment3dSlicer>& segments,
                                                        const LabelMap& map, const fs::path& path,
                                                        std::vector<std::string>& warnings) {
  for (const Segment3dSlicer& segment : segments)
    if (const std::string doubt = map.contradiction_in(segment.description); !doubt.empty())
      warnings.push_back(path.filename().string() + ": " + doubt);
  const auto count = static_cast<std::size_t>(raw.components);
  const std::size_t voxel_bytes = detail::bytes_per_voxel(raw.type);
  std::vector<anatomy::LabelSource> sources;
  for (std::size_t layer = 0; layer < count; ++layer) {
    detail::RawVolume single;
    single.geometry = raw.geometry;
    single.type = raw.type;
    single.slope = raw.slope;
    single.intercept = raw.intercept;
    single.bytes = std::make_unique_for_overwrite<std::byte[]>(single.byte_count());
    for (std::size_t n = 0; n < raw.geometry.voxel_count(); ++n)
      std::copy_n(raw.bytes.get() + (n * count + layer) * voxel_bytes, voxel_bytes,
                  single.bytes.get() + n * voxel_bytes);
    anatomy::LabelSource source{path.string(), {}, {}, true, {}};
    TROCAR_TRY(source.labels, detail::to_grid<std::uint8_t>(single, path.string(), detail::convert_voxels));
    for (const Segment3dSlicer& segment : segments)
      if (segment.layer == static_cast<int>(layer))
        source.names.emplace_back(segment.value, map.name_of(segment.description));
    for (const int value : detail::values_in(source.labels))
      if (std::none_of(source.names.begin(), source.names.end(), [&](const auto& n) { return n.first == value; }))
        return fail(fmt::format("label value {} belongs to no segment", value), path.string(),
                    "save the segmentation again in 3D Slicer");
    if (!source.names.empty()) sources.push_back(std::move(source));
  }
  return sources;
}

Result<std::vector<anatomy::LabelSource>> read_label_file(const fs::path& path, const LabelMap& map, Place place,
                                                          std::vector<std::string>& warnings) {
  TROCAR_TRY_STATUS(detail::check_image_path(path));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(path));
  warnings.insert(warnings.end(), raw.warnings.begin(), raw.warnings.end());
  TROCAR_TRY(const std::vector<Segment3dSlicer> segments, segments_in(raw, path));
  if (!segments.empty()) return read_segments(raw, segments, map, path, warnings);
  TROCAR_TRY(volume::LabelGrid labels, detail::to_grid<std::uint8_t>(raw, path.string(), detail::convert_voxels));
  TROCAR_TRY(anatomy::LabelSource source, name_labels(std::move(labels), path, map, place, warnings));
  std::vector<anatomy::LabelSource> sources;
  sources.push_back(std::move(source));
  return sources;
}

// Folders of masks.

std::vector<fs::path> sorted_entries(const fs::path& folder, bool want_folders) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const bool is_hidden = entry->path().filename().string().starts_with('.');
    const bool is_wanted = want_folders ? entry->is_directory(error) : entry->is_regular_file(error);
    if (is_wanted && !is_hidden) paths.push_back(entry->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<std::vector<anatomy::LabelSource>> read_mask_files(const std::vector<fs::path>& files, const LabelMap& map,
                                                          std::vector<std::string>& warnings) {
  detail::MaskFolder folder;
  for (std::size_t begin = 0; begin < files.size(); begin += kFilesAtOnce) {
    const std::size_t count = std::min(kFilesAtOnce, files.size() - begin);
    std::vector<Result<std::vector<anatomy::LabelSource>>> read(count);
    std::vector<std::vector<std::string>> told(count);
    parallel_for(count, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n)
        read[n] = read_label_file(files[begin + n], map, Place::kInFolder, told[n]);
    });
    for (const auto& of_file : told) warnings.insert(warnings.end(), of_file.begin(), of_file.end());
    for (auto& result : read) {
      TROCAR_TRY(std::vector<anatomy::LabelSource> sources, std::move(result));
      for (anatomy::LabelSource& source : sources) folder.add(std::move(source));
    }
  }
  return folder.take();
}

/// A mask of another patient, or in another frame of reference, lies anywhere in this CT.
Status check_mask_origin(const detail::DicomVolume<std::uint8_t>& mask, const dicom::CtReference& ct,
                         const fs::path& folder) {
  const auto differ = [](const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; };
  if (differ(mask.patient_id, ct.patient_id))
    return fail("the mask is of another patient than the CT (PatientID differs)", folder.string(),
                "give the masks of this patient");
  if (!differ(mask.frame_of_reference, ct.frame_of_reference)) return {};
  return fail(fmt::format("the mask has another frame of reference ({}) than the CT ({})", mask.frame_of_reference,
                          ct.frame_of_reference),
              folder.string(), "give the masks that were drawn on this CT");
}

/// The stored numbers count: some masks have the header of their CT, with its intercept of -1024. If all of them are
/// above zero, they are numbers with an offset.
Result<detail::DicomVolume<std::uint8_t>> read_mask_volume(const fs::path& folder) {
  using detail::PixelNumbers;
  const auto read = [&](PixelNumbers numbers) {
    return detail::read_dicom_folder<std::uint8_t>(folder, detail::convert_mask, {}, {}, numbers);
  };
  auto mask = read(PixelNumbers::kStored);
  if (!mask || std::ranges::count(mask->grid.voxels, std::uint8_t{0}) > 0) return mask;
  return read(PixelNumbers::kRescaled);
}

Result<anatomy::LabelSource> read_dicom_mask(const fs::path& folder, const LabelMap& map,
                                             const dicom::CtReference& ct) {
  TROCAR_TRY(auto mask, read_mask_volume(folder));
  TROCAR_TRY_STATUS(check_mask_origin(mask, ct, folder));
  return anatomy::LabelSource{
      folder.string(), std::move(mask.grid), {{1, map.name_of(folder.filename().string())}}, false, {}};
}

Result<std::vector<anatomy::LabelSource>> read_label_folder(const fs::path& folder, const LabelMap& map,
                                                            const dicom::CtReference& ct,
                                                            std::vector<std::string>& warnings) {
  std::vector<fs::path> files = sorted_entries(folder, false);
  std::erase_if(files, [](const fs::path& file) { return !detail::find_image_format(file); });
  if (!files.empty()) return read_mask_files(files, map, warnings);

  detail::MaskFolder masks;
  // A path with a trailing slash has no file name.
  const fs::path self = fs::absolute(folder / ".").lexically_normal().parent_path();
  if (detail::has_dicom_images(self)) {
    TROCAR_TRY(anatomy::LabelSource mask, read_dicom_mask(self, map, ct));
    masks.add(std::move(mask));
    return masks.take();
  }
  bool any = false;
  for (const fs::path& series : sorted_entries(folder, true)) {
    if (!detail::has_dicom_images(series)) continue;
    TROCAR_TRY(anatomy::LabelSource mask, read_dicom_mask(series, map, ct));
    masks.add(std::move(mask));
    any = true;
  }
  if (any) return masks.take();
  return fail("no mask in the folder", folder.string(),
              "give a folder of .nii.gz, .nrrd or .mha masks, of DICOM mask series (one sub-folder a structure), or of "
              "DICOM SEG or RTSTRUCT files");
}

Result<std::vector<anatomy::LabelSource>> read_path(const fs::path& path, const LabelMap& map,
                                                    const dicom::CtReference& ct, std::vector<std::string>& warnings) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  TROCAR_TRY(const std::vector<fs::path> objects, detail::find_dicom_labels(path));
  if (objects.empty())
    return is_folder ? read_label_folder(path, map, ct, warnings)
                     : read_label_file(path, map, Place::kNamedByUser, warnings);
  std::vector<anatomy::LabelSource> all;
  for (const fs::path& object : objects) {
    TROCAR_TRY(std::vector<anatomy::LabelSource> sources, detail::read_dicom_labels(object, map, ct, warnings));
    std::move(sources.begin(), sources.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace

Result<std::vector<anatomy::LabelSource>> read_label_sources(const std::vector<fs::path>& paths,
                                                             const std::string& label_map, const dicom::CtReference& ct,
                                                             std::vector<std::string>& warnings) {
  TROCAR_TRY(const LabelMap map, LabelMap::load(label_map));
  std::vector<anatomy::LabelSource> all;
  for (const fs::path& path : paths) {
    TROCAR_TRY(std::vector<anatomy::LabelSource> sources, read_path(path, map, ct, warnings));
    std::move(sources.begin(), sources.end(), std::back_inserter(all));
  }
  if (all.empty() && !paths.empty())
    return fail("the label map leaves out every label", label_map, "name at least one structure in [labels]");
  detail::leave_out_unused(all, map, warnings);
  const std::string where = paths.size() == 1 ? paths.front().string() : fmt::format("{} files", paths.size());
  TROCAR_TRY_STATUS(detail::check_voxels(all, map, ct.grid, where, warnings));
  return all;
}

Result<std::vector<anatomy::LabelSource>> read_label_sources(const std::vector<fs::path>& paths,
                                                             const std::string& label_map) {
  std::vector<std::string> warnings;
  return read_label_sources(paths, label_map, {}, warnings);
}

std::vector<std::string> series_of_labels(const std::vector<fs::path>& paths) {
  std::vector<std::string> all;
  for (const fs::path& path : paths) {
    const auto files = detail::find_dicom_labels(path);
    if (!files) continue;
    for (const fs::path& file : *files) {
      const auto series = dicom::referenced_series(file);
      if (series) all.insert(all.end(), series->begin(), series->end());
    }
  }
  return all;
}

}  // namespace trocar::io
