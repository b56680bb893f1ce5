#include "io/patient/detail/label_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "volume/resample.h"

namespace trocar::io::detail {
namespace {

constexpr double kMostLost_ml = 1.0;   ///< Of a structure without a warning.
constexpr double kMostChanged = 0.05;  ///< Of a volume by other voxels, without a warning.
constexpr double kHalfVoxel = 0.5 + 1e-6;

using Counts = std::array<std::size_t, 256>;

Counts count_voxels(const volume::LabelGrid& labels) {
  Counts counts{};
  for (const std::uint8_t value : labels.voxels) ++counts[value];
  return counts;
}

bool is_within(const volume::GridGeometry& grid, const Vec3& p_P) {
  const Vec3 index = grid.to_index(p_P);
  for (int axis = 0; axis < 3; ++axis)
    if (index[axis] < -kHalfVoxel ||
        index[axis] > static_cast<double>(grid.size[static_cast<std::size_t>(axis)]) - 1.0 + kHalfVoxel)
      return false;
  return true;
}

bool are_corners_within(const volume::GridGeometry& grid, const volume::GridGeometry& ct) {
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] =
          (corner >> axis & 1) != 0 ? static_cast<double>(grid.size[static_cast<std::size_t>(axis)] - 1) : 0.0;
    if (!is_within(ct, grid.to_mm(index))) return false;
  }
  return true;
}

/// Voxels of each value whose centres lie beyond the CT.
Counts count_beyond(const volume::LabelGrid& labels, const volume::GridGeometry& ct) {
  Counts counts{};
  if (are_corners_within(labels.geometry, ct)) return counts;
  for (std::size_t n = 0; n < labels.voxels.size(); ++n)
    if (const std::uint8_t value = labels.voxels[n];
        value != 0 && !is_within(ct, labels.geometry.centre_mm(labels.geometry.index_of(n))))
      ++counts[value];
  return counts;
}

/// The voxels of one source in its file, beyond the CT and on the CT.
struct SourceCounts {
  Counts in_file{};
  Counts beyond{};
  Counts on_ct{};
  double voxel_ml = 0.0;
  double ct_voxel_ml = 0.0;
};

SourceCounts count_source(const patient_builder::LabelSource& source, const volume::GridGeometry& ct) {
  SourceCounts counts;
  counts.in_file = count_voxels(source.labels);
  counts.on_ct = counts.in_file;
  counts.voxel_ml = counts.ct_voxel_ml = source.labels.geometry.voxel_volume_mm3() / 1000.0;
  const bool is_blank = counts.in_file[0] == source.labels.voxels.size();
  if (ct.voxel_count() == 0 || is_blank || source.labels.geometry.matches(ct)) return counts;
  counts.beyond = count_beyond(source.labels, ct);
  counts.on_ct = count_voxels(volume::resample_nearest(source.labels, ct, 0));
  counts.ct_voxel_ml = ct.voxel_volume_mm3() / 1000.0;
  return counts;
}

/// What a structure that has voxels in its file loses.
void warn_of_loss(const std::string& name, const SourceCounts& counts, std::size_t value, const std::string& file,
                  std::vector<std::string>& warnings) {
  const double ml = static_cast<double>(counts.in_file[value]) * counts.voxel_ml;
  const double beyond_ml = static_cast<double>(counts.beyond[value]) * counts.voxel_ml;
  const double ct_ml = static_cast<double>(counts.on_ct[value]) * counts.ct_voxel_ml;
  const double inside_ml = ml - beyond_ml;
  if (counts.on_ct[value] == 0)
    warnings.push_back(
        fmt::format("{}: the structure \"{}\" ({:.2g} ml) has no voxel on the CT: it is too small for its "
                    "voxels or lies beyond it",
                    file, name, ml));
  else if (beyond_ml > kMostLost_ml)
    warnings.push_back(
        fmt::format("{}: {:.1f} of {:.1f} ml of \"{}\" lie beyond the CT and are left out", file, beyond_ml, ml, name));
  else if (std::abs(ct_ml - inside_ml) > std::max(kMostLost_ml, kMostChanged * inside_ml))
    warnings.push_back(
        fmt::format("{}: the {:.1f} ml of \"{}\" are {:.1f} ml on the voxels of the CT", file, inside_ml, name, ct_ml));
}

bool is_structure(const std::string& name, const LabelMap& map) {
  return name != patient_builder::kIgnoredStructure && !map.structures().is_background(name) &&
         !map.structures().is_region(name);
}

/// Structures with voxels, of all sources.
struct Found {
  std::size_t structures = 0;
  std::size_t in_file = 0;
  std::size_t on_ct = 0;
  std::vector<std::string> empty_masks;
};

void check_source(patient_builder::LabelSource& source, const LabelMap& map, const volume::GridGeometry& ct,
                  Found& found, std::vector<std::string>& warnings) {
  const SourceCounts counts = count_source(source, ct);
  const std::string file = std::filesystem::path(source.file).filename().string();
  const bool is_mask = !source.is_described && source.names.size() == 1;
  std::erase_if(source.names, [&](const auto& entry) {
    const auto& [number, name] = entry;
    if (number < 1 || number >= static_cast<int>(counts.in_file.size()) || !is_structure(name, map)) return false;
    const auto value = static_cast<std::size_t>(number);
    ++found.structures;
    found.in_file += counts.in_file[value] > 0;
    found.on_ct += counts.on_ct[value] > 0;
    if (counts.in_file[value] > 0) {
      warn_of_loss(name, counts, value, file, warnings);
      return false;
    }
    if (source.is_described)
      warnings.push_back(fmt::format("{}: the structure \"{}\" is empty", file, name));
    else if (is_mask)
      found.empty_masks.push_back(name);
    return source.is_described || is_mask;  // a label map can name more structures than a file has
  });
}

}  // namespace

void leave_out_unused(std::vector<patient_builder::LabelSource>& sources, const LabelMap& map,
                      std::vector<std::string>& warnings) {
  std::set<std::string> left_out;
  for (patient_builder::LabelSource& source : sources)
    for (auto& [value, name] : source.names)
      if (map.is_unused(name)) {
        left_out.insert(name);
        name = patient_builder::kIgnoredStructure;
      }
  if (!left_out.empty())
    warnings.push_back(fmt::format("structures that no task needs were left out: {}", fmt::join(left_out, ", ")));
}

Status check_voxels(std::vector<patient_builder::LabelSource>& sources, const LabelMap& map,
                    const volume::GridGeometry& ct, const std::string& where, std::vector<std::string>& warnings) {
  Found found;
  std::vector<std::string> told;
  for (patient_builder::LabelSource& source : sources) check_source(source, map, ct, found, told);
  if (found.structures > 0 && found.in_file == 0)
    return fail(fmt::format("the labels are all empty: none of {} structures has a voxel", found.structures), where,
                "check that the segmentation is not blank");
  if (found.structures > 0 && found.on_ct == 0)
    return fail(fmt::format("the labels are all empty on the CT: none of {} structures has a voxel within it",
                            found.structures),
                where, "give the segmentation that was made from this CT");
  warnings.insert(warnings.end(), told.begin(), told.end());
  if (!found.empty_masks.empty())
    warnings.push_back(fmt::format("{} of {} structures are empty masks and were left out: {}",
                                   found.empty_masks.size(), found.structures, fmt::join(found.empty_masks, ", ")));
  std::erase_if(sources, [](const patient_builder::LabelSource& source) {
    return source.names.empty() && std::all_of(source.labels.voxels.begin(), source.labels.voxels.end(),
                                               [](std::uint8_t voxel) { return voxel == 0; });
  });
  return {};
}

}  // namespace trocar::io::detail
