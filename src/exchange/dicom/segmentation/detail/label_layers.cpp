#include "dicom/segmentation/detail/label_layers.h"

#include <algorithm>

#include "core/available_memory.h"
#include "core/check.h"

namespace trocar::dicom::detail {
namespace {

bool overlap(std::span<const std::uint8_t> mask, std::span<const std::uint8_t> voxels) {
  for (std::size_t n = 0; n < mask.size(); ++n)
    if (mask[n] != 0 && voxels[n] != 0) return true;
  return false;
}

}  // namespace

Result<LabelLayers::Layer*> LabelLayers::layer_for(std::size_t first, std::span<const std::uint8_t> mask) {
  for (Layer& layer : layers_)
    if (layer.segments.size() < kMostValues && !overlap(mask, std::span(layer.voxels).subspan(first, mask.size())))
      return &layer;
  const auto count = static_cast<std::uint64_t>(size_[0] * size_[1] * size_[2]);
  TROCAR_TRY_STATUS(check_memory_for_image(count, available_memory_bytes(), where_));
  layers_.push_back({std::vector<std::uint8_t>(count, 0), {}});
  return &layers_.back();
}

Status LabelLayers::add(std::size_t segment, std::int64_t first_plane, std::span<const std::uint8_t> mask) {
  if (std::all_of(mask.begin(), mask.end(), [](std::uint8_t value) { return value == 0; })) return {};
  const auto first = static_cast<std::size_t>(first_plane * size_[0] * size_[1]);
  TROCAR_CHECK(first + mask.size() <= static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
  TROCAR_TRY(Layer* const layer, layer_for(first, mask));
  layer->segments.push_back(segment);
  const auto value = static_cast<std::uint8_t>(layer->segments.size());
  for (std::size_t n = 0; n < mask.size(); ++n)
    if (mask[n] != 0) layer->voxels[first + n] = value;
  return {};
}

}  // namespace trocar::dicom::detail
