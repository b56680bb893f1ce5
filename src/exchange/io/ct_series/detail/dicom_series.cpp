#include "io/ct_series/detail/dicom_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

#include "core/available_memory.h"
#include "core/parallel.h"
#include "io/ct_series/detail/tidy_series.h"
#include "io/ct_series/dicom_folder.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

/// Widest gap in an uneven stack that is filled by interpolation: assumed, the thickest slices in use.
constexpr double kWidestGap_mm = 10.0;
constexpr double kWidestGap = 3.05;          ///< Of the usual distance: two slices are missing.
constexpr std::int16_t kOutside_hu = -1024;  ///< Beyond the slices of a tilted stack.
constexpr const char* kNameOneSeries = "name the folder that holds the slices of one series";

/// For messages.
std::string name_of(const DicomSlice& slice) {
  const std::string file = slice.file.filename().string();
  return slice.frames > 1 ? fmt::format("frame {} of {}", slice.frame + 1, file) : file;
}

/// A slice without a scaling among others is not in HU: with the usual intercept, 1024 HU too high.
Status check_same_scaling(const DicomSlice& first, const DicomSlice& slice) {
  const auto check = [&](const char* name, bool has_first, bool has_this) -> Status {
    if (has_first == has_this) return {};
    return fail(fmt::format("{} is missing in some slices of the series: it is in {}, not in {}", name,
                            name_of(has_first ? first : slice), name_of(has_first ? slice : first)),
                slice.file.string(), "export the series again");
  };
  TROCAR_TRY_STATUS(check("RescaleIntercept", first.intercept.has_value(), slice.intercept.has_value()));
  return check("RescaleSlope", first.slope.has_value(), slice.slope.has_value());
}

/// Checks the slices one by one.
Status check_slices(const std::vector<DicomSlice>& slices, const fs::path& folder) {
  if (slices.empty()) return fail("no DICOM image", folder.string(), kNameOneSeries);
  for (const DicomSlice& slice : slices) {
    const std::string where = slice.file.string();
    if (slice.frames > 1 && !slice.is_placed)
      return fail(fmt::format("is a DICOM file with {} frames without a place", slice.frames), where,
                  "convert it to .nrrd or .nii.gz, for example with 3D Slicer");
    if (!slice.unreadable.empty())
      return fail(slice.unreadable + ", not the numbers that DICOM has there (with decimal points)", where,
                  "export the series again, or correct the header");
    if (slice.is_cut) return fail("the DICOM image ends before its last pixel", where, "copy or export it again");
    if (slice.slope == 0.0)
      return fail("RescaleSlope is 0: every pixel would have one value", where, "export the series again");
    TROCAR_TRY_STATUS(check_same_scaling(slices.front(), slice));
    if (slice.patient_id != slices.front().patient_id)
      return fail("the slices are of two patients (PatientID differs)", where, kNameOneSeries);
    if (slice.frame_of_reference != slices.front().frame_of_reference)
      return fail("the slices have two frames of reference (FrameOfReferenceUID differs)", where, kNameOneSeries);
    if (slice.modality != slices.front().modality)
      return fail(fmt::format("the slices are of two modalities: {} and {}", slices.front().modality, slice.modality),
                  where, kNameOneSeries);
    if (slice.samples_per_pixel != 1) return fail("is a colour image", where, "give a CT series or a mask series");
    if (!has_place(slice))
      return fail("no position in the header (position, orientation or pixel spacing is missing)", where,
                  "export the series with its geometry");
    if (!is_alike(slices.front(), slice))
      return fail("the slices differ in size, spacing or direction", where, kNameOneSeries);
  }
  if (slices.size() < 2) return fail("is a single slice, not a volume", folder.string(), "give the whole series");
  return {};
}

Status check_places(const DicomSeries& series, const fs::path& folder) {
  const auto name = [&](std::size_t n) { return name_of(series.slices[n]); };
  for (std::size_t n = 1; n < series.slices.size(); ++n)
    if (series.stack.along_mm(n) - series.stack.along_mm(n - 1) < kSamePlace_mm)
      return fail(fmt::format("two slices have the same position: {} and {}", name(n - 1), name(n)), folder.string(),
                  "give one time point of one series");
  return {};
}

/// The grid of the slices, whose places have passed check_places.
Result<dicom::StackPlan> plan_of(const DicomSeries& series, const fs::path& folder) {
  const dicom::StackGap gap = dicom::widest_gap(series.stack);
  const bool is_too_wide = gap.gap_mm > kWidestGap_mm || gap.gap_mm > kWidestGap * gap.median_mm;
  if (dicom::is_uneven(series.stack) && is_too_wide)
    return fail(
        fmt::format("slices are missing: {:.3g} mm between {} and {}, {:.3g} mm between most others", gap.gap_mm,
                    name_of(series.slices[gap.below]), name_of(series.slices[gap.below + 1]), gap.median_mm),
        folder.string(), "export the whole series again");
  auto plan = dicom::plan_stack(series.stack);
  if (!plan)
    return fail(fmt::format("the slices are shifted sideways by {:.0f} degrees, more than a gantry tilts",
                            dicom::tilt_deg(series.stack)),
                folder.string(), "export the whole series again");
  return *std::move(plan);
}

/// HU exist only in CTs. Other modalities of volumes in HU: cone-beam CT of a C-arm (XA), converted files (OT).
Status check_modality(const DicomSlice& slice, const fs::path& folder) {
  for (const char* modality : {"", "CT", "XA", "OT"})
    if (slice.modality == modality) return {};
  return fail(fmt::format("Modality is {}, not CT", slice.modality), folder.string(), "give the series of a CT");
}

dicom::SliceStack stack_of(const std::vector<DicomSlice>& slices) {
  const DicomSlice& first = slices.front();
  dicom::SliceStack stack;
  stack.row_P = (*first.directions_P)[0];
  stack.column_P = (*first.directions_P)[1];
  stack.column_step_mm = (*first.spacing_mm)[0];
  stack.row_step_mm = (*first.spacing_mm)[1];
  stack.columns = first.columns;
  stack.rows = first.rows;
  for (const DicomSlice& slice : slices) stack.origins_P.push_back(*slice.position_P);
  return stack;
}

/// What was interpolated, in words.
void warn_of_plan(const DicomSeries& series, std::vector<std::string>& warnings) {
  const dicom::StackPlan& plan = series.plan;
  if (plan.shift_mm > 0.0)
    warnings.push_back(fmt::format(
        "gantry tilt: the slices lean by {:.1f} degrees ({:.0f} mm sideways); resampled onto a straight grid",
        plan.tilt_deg, plan.shift_mm));
  if (!plan.is_uneven) return;
  const dicom::StackGap gap = dicom::widest_gap(series.stack);
  warnings.push_back(
      fmt::format("uneven slice distances: {:.3g} mm between {} and {}, {:.3g} mm between most others; interpolated to "
                  "{} slices of {:.3g} mm",
                  gap.gap_mm, name_of(series.slices[gap.below]), name_of(series.slices[gap.below + 1]), gap.median_mm,
                  plan.geometry.size[2], plan.geometry.spacing_mm.z()));
}

/// Files of many frames are read once, others slice by slice.
Result<std::map<fs::path, DicomPixels>> open_files_of_frames(const DicomSeries& series) {
  std::map<fs::path, DicomPixels> opened;
  for (const DicomSlice& slice : series.slices) {
    if (slice.frames == 1 || opened.contains(slice.file)) continue;
    TROCAR_TRY(DicomPixels pixels, DicomPixels::open(slice.file));
    opened.emplace(slice.file, std::move(pixels));
  }
  return opened;
}

/// The voxels of one slice; padding of a CT becomes air.
template <class T>
Status convert_slice(const DicomSlice& slice, const RawVoxels& voxels, Converter<T> convert, std::span<T> out,
                     PaddingCount& padding) {
  if (!std::is_same_v<T, std::int16_t> || !padding_hu(slice)) return convert(voxels, out);
  std::vector<std::byte> pixels(voxels.bytes.begin(), voxels.bytes.end());
  padding = fill_padding(voxels, slice, pixels);
  return convert({voxels.type, pixels, voxels.slope, voxels.intercept}, out);
}

void warn_of_padding(const DicomSeries& series, const std::vector<PaddingCount>& found,
                     std::vector<std::string>& warnings) {
  PaddingCount all;
  std::optional<double> hu;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k].filled + found[k].kept > 0 && !hu) hu = padding_hu(series.slices[k]);
    all.filled += found[k].filled;
    all.kept += found[k].kept;
  }
  if (!hu) return;
  const double share =
      100.0 / (static_cast<double>(found.size()) * static_cast<double>(series.stack.columns * series.stack.rows));
  const std::string kept =
      all.kept == 0 ? std::string()
                    : fmt::format("; {} pixels of it within the image are taken as tissue of {:.0f} HU", all.kept, *hu);
  warnings.push_back(
      fmt::format("padding of the CT (PixelPaddingValue, {:.0f} HU) is taken as air: {:.2g} % of the pixels{}", *hu,
                  share * static_cast<double>(all.filled), kept));
}

/// Reads the pixels of all slices, one after the other.
template <class T>
Result<std::vector<T>> read_pixels(const DicomSeries& series, Converter<T> convert,
                                   std::vector<std::string>& warnings) {
  const auto pixels = static_cast<std::size_t>(series.stack.columns * series.stack.rows);
  std::vector<T> all(pixels * series.slices.size());
  std::vector<Status> statuses(series.slices.size());
  std::vector<PaddingCount> padding(series.slices.size());
  TROCAR_TRY(const auto opened, open_files_of_frames(series));
  parallel_for(series.slices.size(), 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const DicomSlice& slice = series.slices[k];
      const auto use = [&](const RawVoxels& voxels) {
        return convert_slice(slice, voxels, convert, std::span(all).subspan(k * pixels, pixels), padding[k]);
      };
      const auto file = opened.find(slice.file);
      statuses[k] = file != opened.end() ? file->second.decode(slice, use) : decode_slice(slice, use);
    }
  });
  for (const Status& status : statuses)
    if (!status) return tl::unexpected(status.error());
  warn_of_padding(series, padding, warnings);
  return all;
}

}  // namespace

Result<DicomSeries> order_slices(std::vector<DicomSlice> slices, const fs::path& folder) {
  TROCAR_TRY_STATUS(check_slices(slices, folder));
  const auto [row_P, column_P] = *slices.front().directions_P;
  const Vec3 normal_P = row_P.cross(column_P).normalized();
  std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return normal_P.dot(*a.position_P) < normal_P.dot(*b.position_P);
  });
  DicomSeries series;
  series.slices = std::move(slices);
  series.stack = stack_of(series.slices);
  if (!dicom::is_sane(series.stack))
    return fail("the position or the pixel spacing is not that of a scan", folder.string(),
                "export the series with its geometry");
  // Directions that are none have no normal, and no order along it.
  dicom::SliceStack first = series.stack;
  first.origins_P.resize(1);
  volume::GridGeometry directions = dicom::plan_stack(first)->geometry;
  if (auto status = tidy_geometry(directions); !status)
    return fail(status.error().what, folder.string(), status.error().advice);
  TROCAR_TRY_STATUS(check_places(series, folder));
  TROCAR_TRY(series.plan, plan_of(series, folder));
  if (auto status = tidy_geometry(series.plan.geometry); !status)
    return fail(status.error().what, folder.string(), status.error().advice);
  return series;
}

template <class T>
Result<DicomVolume<T>> read_dicom_folder(const fs::path& folder, Converter<T> convert, const std::string& wanted,
                                         const std::vector<std::string>& preferred, PixelNumbers numbers) {
  TROCAR_TRY(std::vector<SeriesImages> found, find_series(folder));
  TROCAR_TRY(SeriesImages images, choose_series(std::move(found), folder, wanted, preferred));
  DicomVolume<T> result;
  TROCAR_TRY(images, leave_out_others(std::move(images), result.warnings));
  TROCAR_TRY(DicomSeries series, order_slices(std::move(images), folder));
  TROCAR_TRY_STATUS(check_acquisitions(series.slices, folder));
  if (numbers == PixelNumbers::kStored)
    for (DicomSlice& slice : series.slices) slice.slope = slice.intercept = std::nullopt;
  if constexpr (std::is_same_v<T, std::int16_t>) TROCAR_TRY_STATUS(check_modality(series.slices.front(), folder));
  warn_of_plan(series, result.warnings);
  const std::uint64_t bytes = series.plan.geometry.voxel_count() * sizeof(T);
  TROCAR_TRY_STATUS(check_memory_for_image(bytes, available_memory_bytes(), folder.string()));
  TROCAR_TRY(std::vector<T> pixels, read_pixels<T>(series, convert, result.warnings));
  if constexpr (std::is_same_v<T, std::int16_t>)
    TROCAR_TRY_STATUS(
        check_alternation(pixels, static_cast<std::size_t>(series.stack.columns * series.stack.rows), folder));
  constexpr T kOutside = std::is_same_v<T, std::uint8_t> ? T{0} : static_cast<T>(kOutside_hu);
  result.grid = dicom::fill_from_stack<T>(series.plan, series.stack, std::move(pixels), kOutside);
  result.series_uid = series.slices.front().series_uid;
  result.frame_of_reference = series.slices.front().frame_of_reference;
  result.patient_id = series.slices.front().patient_id;
  result.slices_P = series.stack.origins_P;
  return result;
}

template Result<DicomVolume<std::int16_t>> read_dicom_folder(const fs::path&, Converter<std::int16_t>,
                                                             const std::string&, const std::vector<std::string>&,
                                                             PixelNumbers);
template Result<DicomVolume<std::uint8_t>> read_dicom_folder(const fs::path&, Converter<std::uint8_t>,
                                                             const std::string&, const std::vector<std::string>&,
                                                             PixelNumbers);
template Result<DicomVolume<float>> read_dicom_folder(const fs::path&, Converter<float>, const std::string&,
                                                      const std::vector<std::string>&, PixelNumbers);

}  // namespace trocar::io::detail
