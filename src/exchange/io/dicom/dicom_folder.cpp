#include "io/dicom/dicom_folder.h"

#include "io/dicom/detail/find_series.h"

namespace trocar::io {
namespace fs = std::filesystem;

Result<std::vector<DicomSeriesInfo>> list_dicom_series(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return fail("no such folder", folder.string(), "name a folder of DICOM files");
  TROCAR_TRY(const auto found, detail::find_series(folder));
  std::vector<DicomSeriesInfo> series;
  for (const detail::SeriesImages& images : found) {
    const detail::DicomSlice& first = images.front();
    series.push_back({first.series_uid, first.series_description, first.modality, images.size(), first.columns,
                      first.rows, first.file.parent_path()});
  }
  return series;
}

}  // namespace trocar::io
