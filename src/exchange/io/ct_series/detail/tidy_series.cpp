#include "io/ct_series/detail/tidy_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

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

namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFewSlices = 6;
constexpr const char* kGiveOnePhase = "give the slices of one acquisition or phase alone, in a folder of their own";

/// Sum of the differences of two slices, over some of their pixels.
double difference(std::span<const std::int16_t> a, std::span<const std::int16_t> b) {
  constexpr std::size_t kStride = 7;
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); n += kStride) sum += std::abs(static_cast<int>(a[n]) - static_cast<int>(b[n]));
  return sum;
}

}  // namespace

Status check_acquisitions(const std::vector<DicomSlice>& slices, const fs::path& folder) {
  std::map<std::string, std::size_t> count_of;
  std::size_t changes = 0;
  for (std::size_t n = 0; n < slices.size(); ++n) {
    ++count_of[slices[n].acquisition];
    changes += n > 0 && slices[n].acquisition != slices[n - 1].acquisition ? 1 : 0;
  }
  constexpr std::size_t kMostReturns = 1;
  if (changes <= count_of.size() - 1 + kMostReturns) return {};
  return fail(fmt::format("the slices of {} acquisitions or phases alternate {} times (AcquisitionNumber, "
                          "TemporalPositionIdentifier): they are mixed in one series",
                          count_of.size(), changes),
              folder.string(), kGiveOnePhase);
}

Status check_alternation(std::span<const std::int16_t> hu, std::size_t pixels, const fs::path& folder) {
  const std::size_t count = pixels == 0 ? 0 : hu.size() / pixels;
  if (count < kFewSlices) return {};
  const auto slice = [&](std::size_t k) { return hu.subspan(k * pixels, pixels); };
  double to_next = 0.0, to_next_but_one = 0.0;
  std::size_t closer = 0;
  for (std::size_t k = 0; k + 2 < count; ++k) {
    const double next = difference(slice(k), slice(k + 1)), next_but_one = difference(slice(k), slice(k + 2));
    to_next += next;
    to_next_but_one += next_but_one;
    closer += next_but_one < next ? 1 : 0;
  }
  // Slices of one scan differ the more, the farther they lie apart; with nothing but noise both are alike.
  constexpr double kClearly = 0.9, kMost = 0.8;
  if (to_next_but_one >= kClearly * to_next || static_cast<double>(closer) < kMost * static_cast<double>(count - 2))
    return {};
  return fail(fmt::format("every slice resembles the next but one more than the next (mean difference {:.0f} %): the "
                          "slices of two acquisitions or phases are mixed in one series",
                          100.0 * to_next_but_one / to_next),
              folder.string(), kGiveOnePhase);
}

namespace {

constexpr double kHighestTissue_hu = 3071.0;  ///< Of a 12-bit CT: metal, enamel.

/// Marks the padding that reaches the edge through padding.
std::vector<bool> from_edge(const std::vector<bool>& is_padding, std::size_t columns, std::size_t rows) {
  std::vector<bool> reached(is_padding.size(), false);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t at) {
    if (!is_padding[at] || reached[at]) return;
    reached[at] = true;
    open.push_back(at);
  };
  for (std::size_t i = 0; i < columns; ++i) {
    reach(i);
    reach((rows - 1) * columns + i);
  }
  for (std::size_t j = 0; j < rows; ++j) {
    reach(j * columns);
    reach(j * columns + columns - 1);
  }
  while (!open.empty()) {
    const std::size_t at = open.back(), i = at % columns, j = at / columns;
    open.pop_back();
    if (i > 0) reach(at - 1);
    if (i + 1 < columns) reach(at + 1);
    if (j > 0) reach(at - columns);
    if (j + 1 < rows) reach(at + columns);
  }
  return reached;
}

template <class Stored>
PaddingCount fill_padding_of(const DicomSlice& slice, std::span<std::byte> pixels) {
  const std::size_t count = pixels.size() / sizeof(Stored);
  std::vector<Stored> numbers(count);
  std::memcpy(numbers.data(), pixels.data(), count * sizeof(Stored));
  std::vector<bool> is_padding(count);
  const auto [low, high] = *slice.padding;
  std::size_t found = 0;
  for (std::size_t n = 0; n < count; ++n) {
    is_padding[n] = numbers[n] >= low && numbers[n] <= high;
    found += is_padding[n] ? 1 : 0;
  }
  if (found == 0) return {};
  if (*padding_hu(slice) <= kHighestTissue_hu)
    is_padding = from_edge(is_padding, static_cast<std::size_t>(slice.columns), static_cast<std::size_t>(slice.rows));
  const double air = (kPaddingAir_hu - slice.intercept.value_or(0.0)) / slice.slope.value_or(1.0);
  const auto stored_air =
      static_cast<Stored>(std::clamp(std::round(air), static_cast<double>(std::numeric_limits<Stored>::min()),
                                     static_cast<double>(std::numeric_limits<Stored>::max())));
  PaddingCount result;
  for (std::size_t n = 0; n < count; ++n) {
    if (!is_padding[n]) continue;
    numbers[n] = stored_air;
    ++result.filled;
  }
  result.kept = found - result.filled;
  std::memcpy(pixels.data(), numbers.data(), count * sizeof(Stored));
  return result;
}

}  // namespace

std::optional<double> padding_hu(const DicomSlice& slice) {
  if (!slice.padding) return std::nullopt;
  const double slope = slice.slope.value_or(1.0), intercept = slice.intercept.value_or(0.0);
  const double hu = std::max((*slice.padding)[0] * slope, (*slice.padding)[1] * slope) + intercept;
  return hu > kPaddingAir_hu ? std::optional(hu) : std::nullopt;
}

PaddingCount fill_padding(const RawVoxels& voxels, const DicomSlice& slice, std::span<std::byte> pixels) {
  if (!padding_hu(slice) || slice.slope == 0.0) return {};
  switch (voxels.type) {
    case VoxelType::kInt8:
      return fill_padding_of<std::int8_t>(slice, pixels);
    case VoxelType::kUInt8:
      return fill_padding_of<std::uint8_t>(slice, pixels);
    case VoxelType::kInt16:
      return fill_padding_of<std::int16_t>(slice, pixels);
    default:
      return fill_padding_of<std::uint16_t>(slice, pixels);
  }
}

}  // namespace trocar::io::detail
