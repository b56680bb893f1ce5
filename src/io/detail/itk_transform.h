#pragma once

#include <array>
#include <filesystem>

#include "core/result.h"

namespace trocar::detail {

/// x -> matrix * x + offset, LPS mm, row by row. Plain data: see ItkImage.
struct AffineMap {
  std::array<std::array<double, 3>, 3> matrix{};
  std::array<double, 3> offset_mm{};
};

/// Reads the one linear transform of an ITK .tfm file; its centre of rotation is worked into the offset. Never throws.
Result<AffineMap> read_transform_with_itk(const std::filesystem::path& path);

/// The map as an ITK affine transform in text, the kind that 3D Slicer writes itself.
Status write_transform_with_itk(const AffineMap& map, const std::filesystem::path& path);

}  // namespace trocar::detail
