#include "io/dicom/detail/tidy_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace trocar::io::detail {
namespace {

constexpr std::size_t kFewImages = 3;       ///< So many images of another direction are overviews ...
constexpr std::size_t kManyMoreSlices = 4;  ///< ... beside at least this multiple of slices.
constexpr std::size_t kMostNamed = 3;

std::string names_of(const SeriesImages& images) {
  std::vector<std::string> names;
  for (const DicomSlice& image : images)
    if (names.size() < kMostNamed) names.push_back(image.file.filename().string());
  const std::size_t more = images.size() - names.size();
  return more == 0 ? fmt::format("{}", fmt::join(names, ", "))
                   : fmt::format("{} and {} more", fmt::join(names, ", "), more);
}

/// Moves the images for which is_other(image) holds out of `images`.
template <class IsOther>
SeriesImages take_out(SeriesImages& images, const IsOther& is_other) {
  SeriesImages others;
  const auto end = std::stable_partition(images.begin(), images.end(), [&](const auto& i) { return !is_other(i); });
  std::move(end, images.end(), std::back_inserter(others));
  images.erase(end, images.end());
  return others;
}

void leave_out_overviews(SeriesImages& images, std::vector<std::string>& warnings) {
  SeriesImages rest = images;
  const SeriesImages overviews = take_out(rest, [](const DicomSlice& image) { return image.is_localizer; });
  if (overviews.empty() || rest.size() < 2) return;
  warnings.push_back(fmt::format("left out {} of the CT: {}",
                                 overviews.size() == 1 ? "an overview image" : "overview images", names_of(overviews)));
  images = std::move(rest);
}

/// Converted series consist of nothing else.
void leave_out_captures(SeriesImages& images, std::vector<std::string>& warnings) {
  SeriesImages rest = images;
  const SeriesImages captures = take_out(rest, [](const DicomSlice& image) { return image.is_capture; });
  if (captures.empty() || rest.size() < 2) return;
  warnings.push_back(fmt::format("left out {} among the slices: {}",
                                 captures.size() == 1 ? "a secondary capture" : "secondary captures",
                                 names_of(captures)));
  images = std::move(rest);
}

bool are_parallel(const DicomSlice& a, const DicomSlice& b) {
  constexpr double kMaxAngle_rad = 0.02;
  const Vec3 a_P = (*a.directions_P)[0].cross((*a.directions_P)[1]);
  const Vec3 b_P = (*b.directions_P)[0].cross((*b.directions_P)[1]);
  return a_P.cross(b_P).norm() <= kMaxAngle_rad;
}

/// A scout that is not marked as one, or a reformatted slice, in the series of the slices.
void leave_out_odd(SeriesImages& images, std::vector<std::string>& warnings) {
  if (!std::all_of(images.begin(), images.end(), has_place)) return;
  const DicomSlice* most_common = nullptr;
  std::size_t most = 0;
  // One of the first few images is a slice: not more than kFewImages are others.
  for (std::size_t n = 0; n < std::min(images.size(), kFewImages + 1); ++n) {
    const auto count = static_cast<std::size_t>(
        std::count_if(images.begin(), images.end(), [&](const DicomSlice& i) { return are_parallel(images[n], i); }));
    if (count > most) most_common = &images[n];
    most = std::max(most, count);
  }
  const std::size_t odd_count = images.size() - most;
  if (odd_count == 0 || odd_count > kFewImages || most < kManyMoreSlices * odd_count) return;
  const DicomSlice reference = *most_common;
  const SeriesImages odd = take_out(images, [&](const DicomSlice& image) { return !are_parallel(reference, image); });
  warnings.push_back(
      fmt::format("left out {} of another direction: {}", odd.size() == 1 ? "an image" : "images", names_of(odd)));
}

/// Files of many frames that were read already.
using OpenedFiles = std::map<std::filesystem::path, DicomPixels>;

Status decode_opened(const DicomSlice& slice, OpenedFiles& opened, const PixelUse& use) {
  if (slice.frames == 1) return decode_slice(slice, use);
  auto file = opened.find(slice.file);
  if (file == opened.end()) {
    TROCAR_TRY(DicomPixels pixels, DicomPixels::open(slice.file));
    file = opened.emplace(slice.file, std::move(pixels)).first;
  }
  return file->second.decode(slice, use);
}

bool have_same_pixels(const DicomSlice& a, const DicomSlice& b, OpenedFiles& opened) {
  std::vector<std::byte> first;
  const Status read = decode_opened(a, opened, [&](const RawVoxels& voxels) -> Status {
    first.assign(voxels.bytes.begin(), voxels.bytes.end());
    return {};
  });
  bool is_same = false;
  const Status compared = decode_opened(b, opened, [&](const RawVoxels& voxels) -> Status {
    is_same = std::equal(first.begin(), first.end(), voxels.bytes.begin(), voxels.bytes.end());
    return {};
  });
  return read && compared && is_same && a.slope == b.slope && a.intercept == b.intercept;
}

/// Images at one place are neighbours in the order along the normal.
Status leave_out_copies(SeriesImages& images, std::vector<std::string>& warnings) {
  if (images.empty() || !std::all_of(images.begin(), images.end(), has_place)) return {};
  const auto [row_P, column_P] = *images.front().directions_P;
  const Vec3 normal_P = row_P.cross(column_P).normalized();
  std::vector<const DicomSlice*> ordered;
  for (const DicomSlice& image : images) ordered.push_back(&image);
  const auto along_mm = [&](const DicomSlice* image) { return normal_P.dot(*image->position_P); };
  std::stable_sort(ordered.begin(), ordered.end(),
                   [&](const auto* a, const auto* b) { return along_mm(a) < along_mm(b); });
  std::vector<bool> is_copy(images.size(), false);
  const DicomSlice* kept = ordered.front();
  OpenedFiles opened;
  for (std::size_t n = 1; n < ordered.size(); ++n) {
    const DicomSlice* image = ordered[n];
    const bool is_same_instance = !image->instance_uid.empty() && image->instance_uid == kept->instance_uid;
    const bool is_same_place = along_mm(image) - along_mm(kept) < kSamePlace_mm && is_alike(*kept, *image);
    const bool is_same = is_same_place && have_same_pixels(*kept, *image, opened);
    if (is_same_place && is_same_instance && !is_same)
      return fail(fmt::format("{} and {} have one SOPInstanceUID, but different pixels: nothing tells which is right",
                              kept->file.filename().string(), image->file.filename().string()),
                  image->file.string(), "remove the wrong one, or export the series again");
    if (is_same)
      is_copy[static_cast<std::size_t>(image - images.data())] = true;
    else
      kept = image;
  }
  SeriesImages slices;
  SeriesImages left_out;
  for (std::size_t n = 0; n < images.size(); ++n) (is_copy[n] ? left_out : slices).push_back(std::move(images[n]));
  images = std::move(slices);
  if (!left_out.empty())
    warnings.push_back(fmt::format("left out {}: {}", left_out.size() == 1 ? "a copy of a slice" : "copies of slices",
                                   names_of(left_out)));
  return {};
}

}  // namespace

bool has_place(const DicomSlice& slice) {
  return slice.position_P && slice.directions_P && slice.spacing_mm;
}

bool is_alike(const DicomSlice& a, const DicomSlice& b) {
  if (a.rows != b.rows || a.columns != b.columns) return false;
  for (int n : {0, 1}) {
    const auto at = static_cast<std::size_t>(n);
    if (((*a.directions_P)[at] - (*b.directions_P)[at]).norm() > kMaxShear) return false;
    if (std::abs((*a.spacing_mm)[at] - (*b.spacing_mm)[at]) > 1e-3 * (*a.spacing_mm)[at]) return false;
  }
  return true;
}

Result<SeriesImages> leave_out_others(SeriesImages images, std::vector<std::string>& warnings) {
  leave_out_overviews(images, warnings);
  leave_out_captures(images, warnings);
  leave_out_odd(images, warnings);
  TROCAR_TRY_STATUS(leave_out_copies(images, warnings));
  return images;
}

}  // namespace trocar::io::detail
