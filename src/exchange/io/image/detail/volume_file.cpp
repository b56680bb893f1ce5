#include "io/image/detail/volume_file.h"

#include <fmt/format.h>

#include "io/image/detail/image_header.h"
#include "io/image/detail/nifti.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

volume::GridGeometry geometry_of(const ItkImage& image) {
  volume::GridGeometry geometry;
  geometry.size = image.size;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    geometry.spacing_mm[axis] = image.spacing_mm[n];
    geometry.origin_P[axis] = image.origin_P[n];
    geometry.R_PV.col(axis) = Vec3(image.axes_P[n][0], image.axes_P[n][1], image.axes_P[n][2]);
  }
  return geometry;
}

/// The library and this program must have read the same header.
Status compare(const ImageHeader& header, const ItkImage& image, const std::string& where) {
  constexpr const char* kAdvice = "open it in 3D Slicer and save it as .nrrd";
  const volume::GridGeometry by_library = geometry_of(image);
  if (by_library.size != header.geometry.size)
    return fail("the header's size is understood differently by different programs", where, kAdvice);
  if (!header.is_place_compared) return {};
  constexpr double kRounding_mm = 1e-3;
  const double distance_mm = largest_distance_mm(header.geometry, by_library);
  if (distance_mm <= kRounding_mm) return {};
  return fail(
      fmt::format("the place of the image is understood differently by different programs, by {:.3g} mm", distance_mm),
      where, kAdvice);
}

Status read_with_library(InputFile file, ImageFormat format, Check check, const fs::path& inside,
                         const ImageHeader& header, RawVolume& volume) {
  const std::string where = file.path().string();
  TROCAR_TRY(const CheckedImage checked, check_image_file(std::move(file), header, check, inside));
  TROCAR_TRY(ItkImage image, read_with_itk(checked, format));
  TROCAR_TRY_STATUS(compare(header, image, where));
  volume.type = image.type;
  volume.components = image.components;
  volume.bytes = std::move(image.bytes);
  volume.fields = std::move(image.fields);
  return {};
}

}  // namespace

Status check_volume_path(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return fail("no such file or folder", path.string(), "check the path");
  if (!fs::is_regular_file(path, error))
    return fail("not a regular file", path.string(), "name a file, not a pipe, socket or device");
  if (fs::file_size(path, error) == 0) return fail("the file is empty", path.string(), "copy or export it again");
  return {};
}

Result<RawVolume> read_volume_file(const fs::path& path, Check check, const fs::path& inside) {
  TROCAR_TRY(const ImageFormat format, find_image_format(path));
  TROCAR_TRY(InputFile file, InputFile::open(path, FileKind::kVolume, inside));
  TROCAR_TRY(ImageHeader header, read_image_header(file, format));
  RawVolume volume;
  if (format == ImageFormat::kNifti) {
    volume.type = header.type;
    TROCAR_TRY(volume.bytes, read_nifti_voxels(file, header));
  } else {
    TROCAR_TRY_STATUS(read_with_library(std::move(file), format, check, inside, header, volume));
  }
  volume.geometry = header.geometry;
  volume.slope = header.slope;
  volume.intercept = header.intercept;
  volume.label_table = std::move(header.label_table);
  for (const std::string& warning : header.warnings)
    volume.warnings.push_back(fmt::format("{}: {}", path.filename().string(), warning));
  return volume;
}

}  // namespace trocar::io::detail
