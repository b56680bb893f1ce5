#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "io/image/detail/payload.h"
#include "volume/grid.h"

namespace trocar::io::detail {

/// Stored numbers of a file, in this machine's byte order.
struct RawVoxels {
  VoxelType type = VoxelType::kUInt8;
  std::span<const std::byte> bytes;
  double slope = 1.0;  ///< Value = stored number * slope + intercept.
  double intercept = 0.0;
};

/// A volume as stored in its file.
struct RawVolume {
  volume::GridGeometry geometry;  ///< R_PV may be mirrored or not exactly orthonormal: see tidy_geometry().
  VoxelType type = VoxelType::kUInt8;
  int components = 1;  ///< Numbers per voxel, running fastest.
  std::unique_ptr<std::byte[]> bytes;
  double slope = 1.0;  ///< Value = stored number * slope + intercept.
  double intercept = 0.0;
  std::vector<std::pair<std::string, std::string>> fields;  ///< Key and value texts of the header (NRRD).
  std::string label_table;                                  ///< XML of the header that names label numbers (NIfTI).
  std::vector<std::string> warnings;                        ///< They name the file.

  RawVoxels voxels() const noexcept { return {type, {bytes.get(), byte_count()}, slope, intercept}; }
  std::size_t byte_count() const noexcept {
    return geometry.voxel_count() * static_cast<std::size_t>(components) * bytes_per_voxel(type);
  }
};

/// Largest deviation of R^T R from identity that is accepted as rounding in a file: 1e-3, 0.06 degrees.
inline constexpr double kMaxShear = 1e-3;

/// Checks a geometry as read and makes its direction exactly orthonormal. Errors (without a place): a spacing that is
/// zero or not a number, a sheared direction. A mirrored direction is kept.
Status tidy_geometry(volume::GridGeometry& geometry);
/// Rounds the spacing to 15 significant digits, and axes parallel to those of P to exactly these. NRRD stores spacing
/// times direction, and its reader divides them again: a geometry that was rounded before writing is read back
/// bit-identically.
void round_geometry(volume::GridGeometry& geometry);

/// True if a number is not whole, apart from the rounding of a float scaling.
bool has_fractions(const RawVoxels& in);

/// One of the functions below: turns stored numbers into voxels.
template <class T>
using Converter = Status (*)(const RawVoxels&, std::span<T>);

/// The volume as a grid that keeps GridGeometry's invariant. Errors, at `where`: those of tidy_geometry() and of the
/// converter, more than one number per voxel.
template <class T>
Result<volume::Grid<T>> to_grid(const RawVolume& raw, const std::string& where, Converter<T> convert);

/// Re-orders a mirrored grid (determinant < 0) by reversing its k axis, so that R_PV is a rotation. The voxel positions
/// in P do not change.
template <class T>
void make_right_handed(volume::Grid<T>& grid);

/// Converts numbers of a file; `out` has one element for each stored number. The error names the defect of the values,
/// without a place.
/// CT: rounded to int16; below -32768 is padding and becomes -32768; NaN, infinity and values above 32767 are errors.
Status convert_voxels(const RawVoxels& in, std::span<std::int16_t> out);
/// Labels: whole numbers 0..255, anything else is an error.
Status convert_voxels(const RawVoxels& in, std::span<std::uint8_t> out);
/// Gray levels: rounded; below 0, above 255 and a volume of fractions from 0 to 1 are errors.
Status convert_gray(const RawVoxels& in, std::span<std::uint8_t> out);
/// Floats: NaN and infinity are errors.
Status convert_voxels(const RawVoxels& in, std::span<float> out);
/// A mask: 1 if the value is above zero. NaN is an error.
Status convert_mask(const RawVoxels& in, std::span<std::uint8_t> out);

}  // namespace trocar::io::detail
