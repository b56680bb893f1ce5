#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/files/input_file.h"

namespace trocar::io::detail {

/// x -> matrix * x + offset, LPS mm, row by row. Plain data: see ItkImage.
struct AffineMap {
  std::array<std::array<double, 3>, 3> matrix{};
  std::array<double, 3> offset_mm{};
  std::size_t parameters = 0;        ///< Number of parameters of the transform's type in a file.
  std::size_t fixed_parameters = 0;  ///< Number of fixed parameters (the centre of rotation).
};

/// Reads the one linear transform of an ITK .tfm file; its centre of rotation is included in the offset. Never throws.
Result<AffineMap> read_transform_with_itk(const InputFile& file);

/// Writes the map as an ITK affine transform in text, the type that 3D Slicer writes.
Status write_transform_with_itk(const AffineMap& map, const std::filesystem::path& path);

/// A cubic B-spline as itk::BSplineTransform has it: nodes of the lattice with i fastest, displacements in mm.
struct SplineNumbers {
  std::array<double, 3> size{}, origin_mm{}, spacing_mm{};
  std::array<std::array<double, 3>, 3> direction{};  ///< direction[row][column].
  std::vector<std::array<double, 3>> coefficients_mm;
};
/// Writes a composite transform: first the spline, then the map.
Status write_composite_with_itk(const AffineMap& map, const SplineNumbers& spline, const std::filesystem::path& path);

/// Points mapped by all transforms of a file, in ITK's order. Never throws.
Result<std::vector<std::array<double, 3>>> map_points_with_itk(const std::filesystem::path& path,
                                                               std::span<const std::array<double, 3>> points);

}  // namespace trocar::io::detail
