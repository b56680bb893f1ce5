#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::dicom::detail {

inline constexpr std::size_t kMostValues = 255;  ///< Of a label volume, besides 0.

/// Collects masks of one size in as few label volumes as possible: each volume takes the masks that do not overlap.
class LabelLayers {
 public:
  struct Layer {
    std::vector<std::uint8_t> voxels;
    std::vector<std::size_t> segments;  ///< Of the values 1, 2 …
  };

  /// `where` is the file, for messages.
  LabelLayers(std::array<std::int64_t, 3> size, std::string where) : size_(size), where_(std::move(where)) {}

  /// Adds a structure. `mask` (0 or not 0) has the planes from `first_plane` on; an empty structure is left out. Error:
  /// not enough memory for a further volume.
  Status add(std::size_t segment, std::int64_t first_plane, std::span<const std::uint8_t> mask);
  std::vector<Layer> take() { return std::move(layers_); }

 private:
  Result<Layer*> layer_for(std::size_t first, std::span<const std::uint8_t> mask);
  std::array<std::int64_t, 3> size_;
  std::string where_;
  std::vector<Layer> layers_;
};

}  // namespace trocar::dicom::detail
