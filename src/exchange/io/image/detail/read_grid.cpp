#include "io/image/detail/read_grid.h"

#include <fmt/format.h>

#include "io/image/detail/payload.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;

Status check_image_path(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return {};
  TROCAR_TRY_STATUS(check_volume_path(path));
  const auto format = find_image_format(path);
  if (format) return {};
  // A file without a known ending can be one slice of a DICOM series.
  TROCAR_TRY(const std::vector<DicomSlice> slices, find_dicom_slices(path));
  if (slices.empty()) return tl::unexpected(format.error());
  if (slices.front().frames > 1 && !slices.front().is_placed)
    return fail(fmt::format("is a DICOM file with {} frames without a place", slices.front().frames), path.string(),
                "convert it to .nrrd or .nii.gz, for example with 3D Slicer");
  if (slices.size() > 1)
    return fail("is a DICOM file of many slices", path.string(), "put it into a folder of its own, and name that");
  return fail("is one DICOM image, not a volume", path.string(), "name the folder of its series instead");
}

}  // namespace trocar::io::detail
