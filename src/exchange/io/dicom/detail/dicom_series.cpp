#include "io/dicom/detail/dicom_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "core/available_memory.h"
#include "core/parallel.h"
#include "io/dicom/detail/find_series.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr double kMaxTilt_deg = 0.3;
/// Stored positions may be rounded (0.625 mm steps as 0.6, 1.3, 1.9): maximum deviation of a slice from an even step.
constexpr double kMaxStepDeviation = 0.05;     ///< Fraction of the step.
constexpr double kMaxStepDeviation_mm = 0.06;  ///< At least this much for small steps.
constexpr double kSamePlace_mm = 1e-3;
constexpr const char* kNameOneSeries = "name the folder that holds the slices of one series";

bool is_alike(const DicomSlice& a, const DicomSlice& b) {
  if (a.rows != b.rows || a.columns != b.columns) return false;
  for (int n : {0, 1}) {
    const auto at = static_cast<std::size_t>(n);
    if (((*a.directions_P)[at] - (*b.directions_P)[at]).norm() > kMaxShear) return false;
    if (std::abs((*a.spacing_mm)[at] - (*b.spacing_mm)[at]) > 1e-3 * (*a.spacing_mm)[at]) return false;
  }
  return true;
}

/// Checks the slices one by one.
Status check_slices(const std::vector<DicomSlice>& slices, const fs::path& folder) {
  if (slices.empty()) return fail("no DICOM image", folder.string(), kNameOneSeries);
  for (const DicomSlice& slice : slices) {
    const std::string where = slice.file.string();
    if (slice.frames > 1)
      return fail(fmt::format("is a DICOM file with {} frames", slice.frames), where,
                  "convert it to .nrrd or .nii.gz, for example with 3D Slicer");
    if (slice.is_cut) return fail("the DICOM image ends before its last pixel", where, "copy or export it again");
    if (slice.slope == 0.0)
      return fail("RescaleSlope is 0: every pixel would have one value", where, "export the series again");
    if (slice.patient_id != slices.front().patient_id)
      return fail("the slices are of two patients (PatientID differs)", where, kNameOneSeries);
    if (slice.frame_of_reference != slices.front().frame_of_reference)
      return fail("the slices have two frames of reference (FrameOfReferenceUID differs)", where, kNameOneSeries);
    if (slice.modality != slices.front().modality)
      return fail(fmt::format("the slices are of two modalities: {} and {}", slices.front().modality, slice.modality),
                  where, kNameOneSeries);
    if (slice.samples_per_pixel != 1) return fail("is a colour image", where, "give a CT series or a mask series");
    if (!slice.position_P || !slice.directions_P || !slice.spacing_mm)
      return fail("no position in the header (position, orientation or pixel spacing is missing)", where,
                  "export the series with its geometry");
    if (!is_alike(slices.front(), slice))
      return fail("the slices differ in size, spacing or direction", where, kNameOneSeries);
  }
  if (slices.size() < 2) return fail("is a single slice, not a volume", folder.string(), "give the whole series");
  return {};
}

/// Steps between slices ordered along the normal.
Status check_steps(const std::vector<DicomSlice>& slices, const Vec3& normal_P, const fs::path& folder) {
  const auto along_mm = [&](std::size_t n) { return normal_P.dot(*slices[n].position_P); };
  const auto name = [&](std::size_t n) { return slices[n].file.filename().string(); };
  const double mean_mm = (along_mm(slices.size() - 1) - along_mm(0)) / static_cast<double>(slices.size() - 1);
  for (std::size_t n = 1; n < slices.size(); ++n)
    if (along_mm(n) - along_mm(n - 1) < kSamePlace_mm)
      return fail(fmt::format("two slices have the same position: {} and {}", name(n - 1), name(n)), folder.string(),
                  "give one time point of one series");
  const double allowed_mm = std::max(kMaxStepDeviation * mean_mm, kMaxStepDeviation_mm);
  for (std::size_t n = 1; n < slices.size(); ++n) {
    const double even_mm = along_mm(0) + static_cast<double>(n) * mean_mm;
    if (std::abs(along_mm(n) - even_mm) <= allowed_mm) continue;
    std::size_t worst = 1;
    for (std::size_t m = 1; m < slices.size(); ++m)
      if (along_mm(m) - along_mm(m - 1) > along_mm(worst) - along_mm(worst - 1)) worst = m;
    return fail(
        fmt::format("uneven slice steps, a slice seems to be missing: {:.3g} mm between {} and {}, {:.3g} mm on "
                    "average",
                    along_mm(worst) - along_mm(worst - 1), name(worst - 1), name(worst), mean_mm),
        folder.string(), "export the whole series again");
  }
  return {};
}

Status check_tilt(const Vec3& stack_P, const Vec3& normal_P, const fs::path& folder) {
  const double tilt_deg = std::atan2(stack_P.cross(normal_P).norm(), stack_P.dot(normal_P)) * 180.0 / std::numbers::pi;
  if (tilt_deg <= kMaxTilt_deg) return {};
  return fail(fmt::format("gantry tilt: the slices are tilted by {:.1f} degrees", tilt_deg), folder.string(),
              "resample it onto a straight grid, for example with 3D Slicer");
}

/// HU exist only in CTs. Other modalities of volumes in HU: cone-beam CT of a C-arm (XA), converted files (OT).
Status check_modality(const DicomSlice& slice, const fs::path& folder) {
  for (const char* modality : {"", "CT", "XA", "OT"})
    if (slice.modality == modality) return {};
  return fail(fmt::format("Modality is {}, not CT", slice.modality), folder.string(), "give the series of a CT");
}

}  // namespace

Result<DicomSeries> order_slices(std::vector<DicomSlice> slices, const fs::path& folder) {
  TROCAR_TRY_STATUS(check_slices(slices, folder));
  const auto [row_P, column_P] = *slices.front().directions_P;
  const Vec3 normal_P = row_P.cross(column_P).normalized();
  std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return normal_P.dot(*a.position_P) < normal_P.dot(*b.position_P);
  });
  TROCAR_TRY_STATUS(check_steps(slices, normal_P, folder));
  const Vec3 stack_P = *slices.back().position_P - *slices.front().position_P;
  TROCAR_TRY_STATUS(check_tilt(stack_P, normal_P, folder));

  DicomSeries series;
  volume::GridGeometry& g = series.geometry;
  g.size = {slices.front().columns, slices.front().rows, static_cast<std::int64_t>(slices.size())};
  g.spacing_mm = {(*slices.front().spacing_mm)[0], (*slices.front().spacing_mm)[1],
                  stack_P.dot(normal_P) / static_cast<double>(slices.size() - 1)};
  g.origin_P = *slices.front().position_P;
  g.R_PV << row_P, column_P, normal_P;
  if (auto status = tidy_geometry(g); !status) return fail(status.error().what, folder.string(), status.error().advice);
  series.slices = std::move(slices);
  return series;
}

template <class T>
Result<volume::Grid<T>> read_dicom_folder(const fs::path& folder, Converter<T> convert, const std::string& wanted) {
  TROCAR_TRY(std::vector<SeriesImages> found, find_series(folder));
  TROCAR_TRY(SeriesImages slices, choose_series(std::move(found), folder, wanted));
  TROCAR_TRY(const DicomSeries series, order_slices(std::move(slices), folder));
  if constexpr (std::is_same_v<T, std::int16_t>) TROCAR_TRY_STATUS(check_modality(series.slices.front(), folder));
  const std::uint64_t bytes = series.geometry.voxel_count() * sizeof(T);
  TROCAR_TRY_STATUS(check_memory_for_image(bytes, available_memory_bytes(), folder.string()));
  volume::Grid<T> grid(series.geometry);
  const auto pixels = static_cast<std::size_t>(series.geometry.size[0] * series.geometry.size[1]);
  std::vector<Status> statuses(series.slices.size());
  parallel_for(series.slices.size(), 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      statuses[k] = decode_slice(series.slices[k], [&](const RawVoxels& voxels) {
        return convert(voxels, std::span(grid.voxels).subspan(k * pixels, pixels));
      });
  });
  for (const Status& status : statuses)
    if (!status) return tl::unexpected(status.error());
  return grid;
}

template Result<volume::Grid<std::int16_t>> read_dicom_folder(const fs::path&, Converter<std::int16_t>,
                                                              const std::string&);
template Result<volume::Grid<std::uint8_t>> read_dicom_folder(const fs::path&, Converter<std::uint8_t>,
                                                              const std::string&);
template Result<volume::Grid<float>> read_dicom_folder(const fs::path&, Converter<float>, const std::string&);

}  // namespace trocar::io::detail
