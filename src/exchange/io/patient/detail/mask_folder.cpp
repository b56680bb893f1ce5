#include "io/patient/detail/mask_folder.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "io/patient/label_map.h"

namespace trocar::io::detail {
namespace {

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

void MaskFolder::add(anatomy::LabelSource source) {
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

std::vector<anatomy::LabelSource> MaskFolder::take() {
  std::move(others_.begin(), others_.end(), std::back_inserter(joined_));
  return std::move(joined_);
}

}  // namespace trocar::io::detail
