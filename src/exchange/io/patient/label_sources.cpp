#include "io/patient/label_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/parallel.h"
#include "core/parse_number.h"
#include "io/dicom/detail/find_series.h"
#include "io/image/detail/payload.h"
#include "io/image/detail/read_grid.h"
#include "io/patient/label_map.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxLabel = 255;
constexpr std::size_t kFilesAtOnce = 8;  ///< Masks unpacked at a time: limits the memory.

/// The values other than 0 in the image.
std::vector<int> values_in(const volume::LabelGrid& labels) {
  std::array<bool, 256> occurs{};
  for (const std::uint8_t value : labels.voxels) occurs[value] = true;
  std::vector<int> values;
  for (int value = 1; value <= kMaxLabel; ++value)
    if (occurs[static_cast<std::size_t>(value)]) values.push_back(value);
  return values;
}

enum class Place { kNamedByUser, kInFolder };

/// A file with one value is a mask named after its file. A single file can also be a segmentation with one structure:
/// this holds if only the label map knows a name.
bool is_mask(const std::vector<int>& values, const std::string& stem, const LabelMap& map, Place place) {
  if (values.size() != 1) return values.empty();
  return place == Place::kInFolder || map.structures().find(stem) != nullptr || !map.has_number(values.front());
}

/// Values without a name are reported by build_patient, which lists those of all files.
Result<anatomy::LabelSource> name_labels(volume::LabelGrid labels, const fs::path& path, const LabelMap& map,
                                         Place place) {
  anatomy::LabelSource source{path.string(), std::move(labels), {}};
  const std::vector<int> values = values_in(source.labels);
  const std::string stem = detail::image_stem(path);
  if (is_mask(values, stem, map, place)) {
    source.names = {{values.empty() ? 1 : values.front(), map.name_of(stem)}};
    return source;
  }
  if (map.is_empty())
    return fail(fmt::format("has {} label values but no names for them", values.size()), path.string(),
                "name them: --label-map totalsegmentator, or a TOML file with [labels] 1 = \"liver\" …");
  for (const int value : values)
    if (auto name = map.name_of(value)) source.names.emplace_back(value, std::move(*name));
  return source;
}

// .seg.nrrd files of 3D Slicer.

struct Segment3dSlicer {
  std::string name;
  int value = 1;
  int layer = 0;
};

/// Segments described in the header: Segment{N}_Name, _LabelValue, _Layer. Empty for an ordinary file.
std::vector<Segment3dSlicer> segments_in(const detail::RawVolume& raw) {
  const std::map<std::string, std::string> fields(raw.fields.begin(), raw.fields.end());
  const auto number = [&](const std::string& key, int fallback) {
    const auto found = fields.find(key);
    const auto value = found == fields.end() ? std::nullopt : find_leading_number<int>(found->second);
    return value ? value->value : fallback;
  };
  std::vector<Segment3dSlicer> segments;
  for (int n = 0;; ++n) {
    const std::string prefix = fmt::format("Segment{}_", n);
    const auto name = fields.find(prefix + "Name");
    if (name == fields.end()) return segments;
    segments.push_back({name->second, number(prefix + "LabelValue", n + 1), number(prefix + "Layer", 0)});
  }
}

/// One source per layer: overlapping segments are in different layers.
Result<std::vector<anatomy::LabelSource>> read_segments(const detail::RawVolume& raw,
                                                        const std::vector<Segment3dSlicer>& segments,
                                                        const LabelMap& map, const fs::path& path) {
  const auto count = static_cast<std::size_t>(raw.components);
  const std::size_t voxel_bytes = detail::bytes_per_voxel(raw.type);
  std::vector<anatomy::LabelSource> sources;
  for (std::size_t layer = 0; layer < count; ++layer) {
    detail::RawVolume single;
    single.geometry = raw.geometry;
    single.type = raw.type;
    single.bytes = std::make_unique_for_overwrite<std::byte[]>(single.byte_count());
    for (std::size_t n = 0; n < raw.geometry.voxel_count(); ++n)
      std::copy_n(raw.bytes.get() + (n * count + layer) * voxel_bytes, voxel_bytes,
                  single.bytes.get() + n * voxel_bytes);
    anatomy::LabelSource source{path.string(), {}, {}};
    TROCAR_TRY(source.labels, detail::to_grid<std::uint8_t>(single, path.string(), detail::convert_voxels));
    for (const Segment3dSlicer& segment : segments)
      if (segment.layer == static_cast<int>(layer)) source.names.emplace_back(segment.value, map.name_of(segment.name));
    for (const int value : values_in(source.labels))
      if (std::none_of(source.names.begin(), source.names.end(), [&](const auto& n) { return n.first == value; }))
        return fail(fmt::format("label value {} belongs to no segment", value), path.string(),
                    "save the segmentation again in 3D Slicer");
    if (!source.names.empty()) sources.push_back(std::move(source));
  }
  return sources;
}

Result<std::vector<anatomy::LabelSource>> read_label_file(const fs::path& path, const LabelMap& map, Place place) {
  TROCAR_TRY_STATUS(detail::check_image_path(path));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(path));
  if (const auto segments = segments_in(raw); !segments.empty()) return read_segments(raw, segments, map, path);
  TROCAR_TRY(volume::LabelGrid labels, detail::to_grid<std::uint8_t>(raw, path.string(), detail::convert_voxels));
  TROCAR_TRY(anatomy::LabelSource source, name_labels(std::move(labels), path, map, place));
  std::vector<anatomy::LabelSource> sources;
  sources.push_back(std::move(source));
  return sources;
}

// Folders of masks.

/// An empty mask needs no voxels: a coarse grid over the same box gives its position.
volume::LabelGrid empty_over(const volume::GridGeometry& g) {
  volume::GridGeometry coarse = g;
  coarse.size = {2, 2, 2};
  for (int axis = 0; axis < 3; ++axis)
    coarse.spacing_mm[axis] *= 0.5 * static_cast<double>(g.size[static_cast<std::size_t>(axis)]);
  const Vec3 corner_P = g.to_mm(Vec3::Constant(-0.5));
  coarse.origin_P = corner_P + g.R_PV * (0.5 * coarse.spacing_mm);
  return volume::LabelGrid(coarse);
}

/// Merges a mask into a source on the same grid if they do not overlap. A hundred such masks take the memory of one.
bool try_join(const anatomy::LabelSource& mask, anatomy::LabelSource& into) {
  const auto value = static_cast<std::uint8_t>(into.names.size() + 1);
  if (value == 0 || mask.names.size() != 1 || !mask.labels.geometry.matches(into.labels.geometry)) return false;
  const std::vector<std::uint8_t>& from = mask.labels.voxels;
  std::vector<std::uint8_t>& to = into.labels.voxels;
  for (std::size_t n = 0; n < from.size(); ++n)
    if (from[n] != 0 && to[n] != 0) return false;
  for (std::size_t n = 0; n < from.size(); ++n)
    if (from[n] != 0) to[n] = value;
  into.names.emplace_back(value, mask.names.front().second);
  into.file = fs::path(mask.file).parent_path().string();  // The folder of the masks.
  return true;
}

/// Collects the masks of a folder.
class MaskFolder {
 public:
  void add(anatomy::LabelSource source) {
    if (source.names.size() == 1 && source.names.front().second == anatomy::kIgnoredStructure) return;
    if (source.names.size() != 1) {
      others_.push_back(std::move(source));
      return;
    }
    if (values_in(source.labels).empty()) {
      source.labels = empty_over(source.labels.geometry);
      others_.push_back(std::move(source));
      return;
    }
    if (std::any_of(joined_.begin(), joined_.end(), [&](anatomy::LabelSource& into) { return try_join(source, into); }))
      return;
    for (std::uint8_t& voxel : source.labels.voxels) voxel = voxel != 0 ? 1 : 0;
    source.names.front().first = 1;
    joined_.push_back(std::move(source));
  }

  std::vector<anatomy::LabelSource> take() {
    std::move(others_.begin(), others_.end(), std::back_inserter(joined_));
    return std::move(joined_);
  }

 private:
  std::vector<anatomy::LabelSource> joined_;
  std::vector<anatomy::LabelSource> others_;  ///< Empty masks and files of several labels.
};

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

Result<std::vector<anatomy::LabelSource>> read_mask_files(const std::vector<fs::path>& files, const LabelMap& map) {
  MaskFolder folder;
  for (std::size_t begin = 0; begin < files.size(); begin += kFilesAtOnce) {
    const std::size_t count = std::min(kFilesAtOnce, files.size() - begin);
    std::vector<Result<std::vector<anatomy::LabelSource>>> read(count);
    parallel_for(count, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) read[n] = read_label_file(files[begin + n], map, Place::kInFolder);
    });
    for (auto& result : read) {
      TROCAR_TRY(std::vector<anatomy::LabelSource> sources, std::move(result));
      for (anatomy::LabelSource& source : sources) folder.add(std::move(source));
    }
  }
  return folder.take();
}

Result<anatomy::LabelSource> read_dicom_mask(const fs::path& folder, const LabelMap& map) {
  TROCAR_TRY(auto mask, detail::read_dicom_folder<std::uint8_t>(folder, detail::convert_mask));
  return anatomy::LabelSource{folder.string(), std::move(mask.grid), {{1, map.name_of(folder.filename().string())}}};
}

Result<std::vector<anatomy::LabelSource>> read_label_folder(const fs::path& folder, const LabelMap& map) {
  std::vector<fs::path> files = sorted_entries(folder, false);
  std::erase_if(files, [](const fs::path& file) { return !detail::find_image_format(file); });
  if (!files.empty()) return read_mask_files(files, map);

  MaskFolder masks;
  // A path with a trailing slash has no file name.
  const fs::path self = fs::absolute(folder / ".").lexically_normal().parent_path();
  if (detail::has_dicom_images(self)) {
    TROCAR_TRY(anatomy::LabelSource mask, read_dicom_mask(self, map));
    masks.add(std::move(mask));
    return masks.take();
  }
  bool any = false;
  for (const fs::path& series : sorted_entries(folder, true)) {
    if (!detail::has_dicom_images(series)) continue;
    TROCAR_TRY(anatomy::LabelSource mask, read_dicom_mask(series, map));
    masks.add(std::move(mask));
    any = true;
  }
  if (any) return masks.take();
  return fail("no mask in the folder", folder.string(),
              "give a folder of .nii.gz, .nrrd or .mha masks, or of DICOM mask series, one sub-folder a structure");
}

}  // namespace

Result<std::vector<anatomy::LabelSource>> read_label_sources(const std::vector<fs::path>& paths,
                                                             const std::string& label_map) {
  TROCAR_TRY(const LabelMap map, LabelMap::load(label_map));
  std::vector<anatomy::LabelSource> all;
  for (const fs::path& path : paths) {
    std::error_code error;
    TROCAR_TRY(std::vector<anatomy::LabelSource> sources, fs::is_directory(path, error)
                                                              ? read_label_folder(path, map)
                                                              : read_label_file(path, map, Place::kNamedByUser));
    std::move(sources.begin(), sources.end(), std::back_inserter(all));
  }
  if (all.empty() && !paths.empty())
    return fail("the label map leaves out every label", label_map, "name at least one structure in [labels]");
  return all;
}

}  // namespace trocar::io
