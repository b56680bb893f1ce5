#include "io/patient/detail/mask_folder.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/parallel.h"
#include "io/ct_series/detail/dicom_slice.h"
#include "io/ct_series/dicom_folder.h"
#include "io/image/detail/payload.h"
#include "io/patient/label_map.h"

namespace trocar::io::detail {
namespace {

/// Merges a mask into a source on the same grid if they do not overlap. A hundred such masks take the memory of one.
bool try_join(const patient_builder::LabelSource& mask, patient_builder::LabelSource& into) {
  const auto value = static_cast<std::uint8_t>(into.names.size() + 1);
  if (value == 0 || mask.names.size() != 1 || !mask.labels.geometry.matches(into.labels.geometry)) return false;
  const std::vector<std::uint8_t>& from = mask.labels.voxels;
  std::vector<std::uint8_t>& to = into.labels.voxels;
  for (std::size_t n = 0; n < from.size(); ++n)
    if (from[n] != 0 && to[n] != 0) return false;
  for (std::size_t n = 0; n < from.size(); ++n)
    if (from[n] != 0) to[n] = value;
  into.names.emplace_back(value, mask.names.front().second);
  into.file = std::filesystem::path(mask.file).parent_path().string();  // The folder of the masks.
  return true;
}

}  // namespace

std::vector<int> values_in(const volume::LabelGrid& labels) {
  std::array<bool, 256> occurs{};
  for (const std::uint8_t value : labels.voxels) occurs[value] = true;
  std::vector<int> values;
  for (int value = 1; value <= kMaxLabel; ++value)
    if (occurs[static_cast<std::size_t>(value)]) values.push_back(value);
  return values;
}

volume::LabelGrid empty_over(const volume::GridGeometry& g) {
  volume::GridGeometry coarse = g;
  coarse.size = {2, 2, 2};
  for (int axis = 0; axis < 3; ++axis)
    coarse.spacing_mm[axis] *= 0.5 * static_cast<double>(g.size[static_cast<std::size_t>(axis)]);
  const Vec3 corner_P = g.to_mm(Vec3::Constant(-0.5));
  coarse.origin_P = corner_P + g.R_PV * (0.5 * coarse.spacing_mm);
  return volume::LabelGrid(coarse);
}

void MaskFolder::add(patient_builder::LabelSource source) {
  if (source.names.size() == 1 && source.names.front().second == patient_builder::kIgnoredStructure) return;
  if (source.names.size() != 1) {
    others_.push_back(std::move(source));
    return;
  }
  if (values_in(source.labels).empty()) {
    source.labels = empty_over(source.labels.geometry);
    others_.push_back(std::move(source));
    return;
  }
  if (std::any_of(joined_.begin(), joined_.end(),
                  [&](patient_builder::LabelSource& into) { return try_join(source, into); }))
    return;
  for (std::uint8_t& voxel : source.labels.voxels) voxel = voxel != 0 ? 1 : 0;
  source.names.front().first = 1;
  joined_.push_back(std::move(source));
}

std::vector<patient_builder::LabelSource> MaskFolder::take() {
  std::move(others_.begin(), others_.end(), std::back_inserter(joined_));
  return std::move(joined_);
}

namespace fs = std::filesystem;
namespace {

DescribedSegment description_of(const dicom::Segment& segment) {
  return {segment.name, segment.number, segment.type_in_region, segment.codes, segment.meanings};
}

/// Name of a structure. `stem` is that of the file if it holds only this structure.
std::string name_of(const dicom::Segment& segment, const LabelMap& map, const std::string& stem) {
  const std::string name = map.name_of(description_of(segment));
  if (name == patient_builder::kIgnoredStructure || map.is_known(name) || !map.is_known(stem)) return name;
  return map.name_of(stem);
}

}  // namespace

Result<std::vector<fs::path>> find_dicom_labels(const fs::path& path) {
  std::error_code error;
  std::vector<fs::path> files;
  if (fs::is_directory(path, error)) {
    TROCAR_TRY(files, files_below(path));
  } else if (fs::is_regular_file(path, error) && !find_image_format(path)) {
    files = {path};
  }
  std::vector<Result<dicom::ObjectKind>> kinds(files.size());
  parallel_for(files.size(), 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) kinds[n] = dicom::find_object_kind(files[n]);
  });
  std::vector<fs::path> found;
  for (std::size_t n = 0; n < files.size(); ++n) {
    TROCAR_TRY(const dicom::ObjectKind kind, std::move(kinds[n]));
    if (kind != dicom::ObjectKind::kOther) found.push_back(std::move(files[n]));
  }
  return found;
}

Result<std::vector<patient_builder::LabelSource>> read_dicom_labels(const fs::path& path, const LabelMap& map,
                                                                    const dicom::CtReference& ct,
                                                                    std::vector<std::string>& warnings) {
  const auto is_wanted = [&](const dicom::Segment& segment) {
    return name_of(segment, map, {}) != patient_builder::kIgnoredStructure;
  };
  TROCAR_TRY(dicom::Segmentation read, dicom::read_segmentation(path, ct, is_wanted, decode_frame));
  for (const std::string& warning : read.warnings) warnings.push_back(path.filename().string() + ": " + warning);
  for (const dicom::Segment& segment : read.segments)
    if (const std::string contradiction = map.contradiction_in(description_of(segment)); !contradiction.empty())
      warnings.push_back(path.filename().string() + ": " + contradiction);

  const std::string stem = read.segments.size() == 1 ? path.stem().string() : std::string();
  std::vector<patient_builder::LabelSource> sources;
  std::vector<bool> has_voxels(read.segments.size(), false);
  for (dicom::SegmentVolume& volume : read.volumes) {
    patient_builder::LabelSource source{path.string(), std::move(volume.labels), {}, true, {}};
    for (std::size_t n = 0; n < volume.segments.size(); ++n) {
      has_voxels[volume.segments[n]] = true;
      source.names.emplace_back(static_cast<int>(n + 1), name_of(read.segments[volume.segments[n]], map, stem));
    }
    sources.push_back(std::move(source));
  }
  for (std::size_t n = 0; n < read.segments.size(); ++n)
    if (!has_voxels[n])
      sources.push_back({path.string(), empty_over(ct.grid), {{1, name_of(read.segments[n], map, stem)}}, true, {}});
  return sources;
}

}  // namespace trocar::io::detail
