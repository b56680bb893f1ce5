#include "io/image/detail/image_header.h"

#include <fmt/format.h>

#include <algorithm>

namespace trocar::io::detail {
namespace {

constexpr double kSmallestVoxel_mm = 0.001, kLargestVoxel_mm = 100.0;
constexpr std::int64_t kMaxSide = 65'535;            ///< Voxels along one axis.
constexpr std::uint64_t kMaxVoxels = 2'000'000'000;  ///< 4 GB of int16, far above any CT.

}  // namespace

Result<std::uint64_t> volume_bytes(const std::vector<std::int64_t>& sizes, std::uint64_t bytes_per_voxel,
                                   const std::string& where) {
  if (sizes.size() < 3) return fail("not a 3D image", where, "give a volume, not a picture");
  std::uint64_t voxels = 1;
  for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
    if (sizes[axis] < 1) return fail("the image is empty", where, kExportAgain);
    if (axis >= 3 && sizes[axis] > 1)
      return fail(fmt::format("is a 4D image with {} volumes", sizes[axis]), where, "extract one volume and give that");
    if (sizes[axis] > kMaxSide || (voxels *= static_cast<std::uint64_t>(sizes[axis])) > kMaxVoxels)
      return fail("the header claims an impossible size", where, kExportAgain);
  }
  if (sizes[0] < 2 || sizes[1] < 2 || sizes[2] < 2)
    return fail("is a single slice, not a volume", where, "give a volume of at least two slices");
  return voxels * bytes_per_voxel;
}

volume::Index3 sides(const std::vector<std::int64_t>& sizes) {
  return {sizes[0], sizes[1], sizes[2]};
}

Status set_place(const Mat3& axes_P, const Vec3& origin_P, const std::string& name, const std::string& where,
                 volume::GridGeometry& geometry) {
  const Vec3 lengths = axes_P.colwise().norm().transpose();
  if (!axes_P.allFinite() || !lengths.allFinite() || !origin_P.allFinite())
    return fail(fmt::format("the header's {} contains a number that is not finite", name), where, kExportAgain);
  if ((lengths.array() <= 0.0).any())
    return fail(fmt::format("the header's {} gives voxels without extent", name), where, kExportAgain);
  if (lengths.maxCoeff() > kLargestVoxel_mm || lengths.minCoeff() < kSmallestVoxel_mm)
    return fail(fmt::format("the header's {} gives voxels of {:.3g} x {:.3g} x {:.3g} mm, which no scan has", name,
                            lengths[0], lengths[1], lengths[2]),
                where, "export it again in mm");
  geometry.spacing_mm = lengths;
  geometry.origin_P = origin_P;
  geometry.R_PV = axes_P * lengths.cwiseInverse().asDiagonal();
  return {};
}

double largest_distance_mm(const volume::GridGeometry& a, const volume::GridGeometry& b) {
  double largest_mm = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> axis & 1) != 0 ? static_cast<double>(a.size[static_cast<std::size_t>(axis)] - 1) : 0.0;
    largest_mm = std::max(largest_mm, (a.to_mm(index) - b.to_mm(index)).norm());
  }
  return largest_mm;
}

Result<ImageHeader> read_image_header(const InputFile& file, ImageFormat format) {
  switch (format) {
    case ImageFormat::kNifti:
      return read_nifti_header(file);
    case ImageFormat::kNrrd:
      return read_nrrd_header(file);
    case ImageFormat::kMeta:
      return read_meta_header(file);
  }
  return fail("not an image", file.path().string(), kExportAgain);
}

}  // namespace trocar::io::detail
