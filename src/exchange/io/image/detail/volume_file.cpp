#include "io/image/detail/volume_file.h"

#include "io/image/detail/payload.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;

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
  TROCAR_TRY(const CheckedImage checked, open_image_file(path, format, check, inside));
  TROCAR_TRY(ItkImage image, read_with_itk(checked, format));
  RawVolume volume;
  volume.geometry.size = image.size;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    volume.geometry.spacing_mm[axis] = image.spacing_mm[n];
    volume.geometry.origin_P[axis] = image.origin_P[n];
    volume.geometry.R_PV.col(axis) = Vec3(image.axes_P[n][0], image.axes_P[n][1], image.axes_P[n][2]);
  }
  volume.type = image.type;
  volume.components = image.components;
  volume.bytes = std::move(image.bytes);
  volume.fields = std::move(image.fields);
  return volume;
}

}  // namespace trocar::io::detail
