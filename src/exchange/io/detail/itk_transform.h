#pragma once

#include <array>
#include <cstddef>
#include <filesystem>

#include "core/files/input_file.h"

namespace trocar::io::detail {

/// x -> matrix * x + offset, LPS mm, row by row. Plain data: see ItkImage.
struct AffineMap {
  std::array<std::array<double, 3>, 3> matrix{};
  std::array<double, 3> offset_mm{};
  std::size_t parameters = 0;        ///< How many numbers the transform's type has in a file,
  std::size_t fixed_parameters = 0;  ///< and how many fixed ones (the centre of rotation).
};

/// Reads the one linear transform of an ITK .tfm file; its centre of rotation is worked into the offset. Never throws.
Result<AffineMap> read_transform_with_itk(const InputFile& file);

/// The map as an ITK affine transform in text, the kind that 3D Slicer writes itself.
Status write_transform_with_itk(const AffineMap& map, const std::filesystem::path& path);

}  // namespace trocar::io::detail
