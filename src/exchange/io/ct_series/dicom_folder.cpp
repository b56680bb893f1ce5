#include "io/ct_series/dicom_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "core/files/folders.h"
#include "core/parallel.h"
#include "core/text.h"

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

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxListed = 12;

/// "1: 'Abdomen 3.0' CT, 119 images of 512x512, UID 1.2.3; 2: 'Topogram' CT, 1 image of 512x600, UID 1.2.4".
std::string list_of(const std::vector<SeriesImages>& series) {
  std::string list;
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (n == kMaxListed) return list + fmt::format("; and {} more", series.size() - n);
    const DicomSlice& first = series[n].front();
    list += fmt::format("{}{}: '{}' {}, {} {} of {}x{}, UID {}", n == 0 ? "" : "; ", n + 1, first.series_description,
                        first.modality, series[n].size(), series[n].size() == 1 ? "image" : "images", first.columns,
                        first.rows, first.series_uid);
  }
  return list;
}

/// Overview images, and dose reports without a place, are no volume.
bool is_ct_volume(const SeriesImages& images) {
  const auto slices = std::count_if(images.begin(), images.end(), [](const DicomSlice& image) {
    return image.modality == "CT" && !image.is_localizer && image.position_P && image.directions_P;
  });
  return slices > 1;
}

/// Index of the series given by `wanted`: a number from 1, or a UID.
std::optional<std::size_t> find_wanted(const std::vector<SeriesImages>& series, const std::string& wanted) {
  const auto number = parse_number<std::size_t>(wanted);
  if (number && *number >= 1 && *number <= series.size()) return *number - 1;
  const auto found = std::find_if(series.begin(), series.end(), [&](const SeriesImages& images) {
    return !wanted.empty() && images.front().series_uid == wanted;
  });
  if (found == series.end()) return std::nullopt;
  return static_cast<std::size_t>(found - series.begin());
}

/// Index of the only CT volume among the series with these UIDs.
std::optional<std::size_t> find_preferred(const std::vector<SeriesImages>& series,
                                          const std::vector<std::string>& preferred) {
  std::optional<std::size_t> found;
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (!is_ct_volume(series[n]) || !std::ranges::count(preferred, series[n].front().series_uid)) continue;
    if (found) return std::nullopt;
    found = n;
  }
  return found;
}

bool is_empty_or_zeros(const fs::path& file) {
  std::array<char, 4096> start{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  return std::all_of(start.begin(), start.end(), [](char byte) { return byte == 0; });
}

/// True if a file that is no DICOM image has the name of one: what is left of a slice after a failed copy. Hidden files
/// ("._slice.dcm") belong to the system.
bool is_lost_slice(const fs::path& file, bool has_slices_beside) {
  const std::string name = file.filename().string();
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), ascii::to_lower);
  if (name.starts_with('.')) return false;
  const bool is_named_dicom = ending == ".dcm" || ending == ".dicom" || ending == ".ima";
  if (is_named_dicom) {
    const auto header = DicomHeader::read(file);
    return header && !*header;
  }
  return has_slices_beside && name.find_first_of("0123456789") != std::string::npos && is_empty_or_zeros(file);
}

/// Slices at the ends of a series would be missing without a word.
Status check_lost_slices(const std::vector<fs::path>& files,
                         const std::vector<Result<std::vector<DicomSlice>>>& found) {
  std::set<fs::path> folders;
  for (std::size_t n = 0; n < files.size(); ++n)
    if (found[n] && !found[n]->empty()) folders.insert(files[n].parent_path());
  if (folders.empty()) return {};
  for (std::size_t n = 0; n < files.size(); ++n)
    if (found[n] && found[n]->empty() && is_lost_slice(files[n], folders.contains(files[n].parent_path())))
      return fail("is empty or no DICOM file, but has the name of one: a slice may be missing", files[n].string(),
                  "copy or export it again, or remove it if it is no slice");
  return {};
}

}  // namespace

Result<std::vector<fs::path>> files_below(const fs::path& folder, int most_depth) {
  auto files = list_tree(folder, {.most_depth = most_depth, .skips_unreadable = true});
  if (files)
    std::erase_if(*files, [](const fs::path& file) {
      std::error_code gone;
      return !fs::is_regular_file(file, gone);
    });
  return files;
}

bool has_dicom_images(const fs::path& folder) {
  const auto files = files_below(folder, 0);
  return files && std::ranges::any_of(*files, [](const fs::path& file) {
           const auto slices = find_dicom_slices(file);
           return !slices || !slices->empty();
         });
}

Result<std::vector<SeriesImages>> find_series(const fs::path& folder) {
  TROCAR_TRY(const std::vector<fs::path> files, files_below(folder));
  std::vector<Result<std::vector<DicomSlice>>> found(files.size());
  parallel_for(files.size(), 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) found[n] = find_dicom_slices(files[n]);
  });
  TROCAR_TRY_STATUS(check_lost_slices(files, found));
  std::vector<SeriesImages> series;
  std::map<std::string, std::size_t> index_of_uid;
  for (auto& result : found) {
    TROCAR_TRY(std::vector<DicomSlice> slices, std::move(result));
    if (slices.empty()) continue;
    const auto [entry, is_new] = index_of_uid.emplace(slices.front().series_uid, series.size());
    if (is_new) series.emplace_back();
    std::move(slices.begin(), slices.end(), std::back_inserter(series[entry->second]));
  }
  if (series.empty())
    return fail("no DICOM image in the folder or its sub-folders", folder.string(),
                "name the folder that holds the slices of the series");
  return series;
}

Result<SeriesImages> choose_series(std::vector<SeriesImages> series, const fs::path& folder, const std::string& wanted,
                                   const std::vector<std::string>& preferred) {
  if (!wanted.empty()) {
    if (const auto index = find_wanted(series, wanted)) return std::move(series[*index]);
    return fail_usage(fmt::format("there is no DICOM series \"{}\"; found are {}", wanted, list_of(series)),
                      folder.string(), "choose one by its number or UID");
  }
  if (series.size() == 1) return std::move(series.front());
  if (const auto index = find_preferred(series, preferred)) return std::move(series[*index]);
  if (std::count_if(series.begin(), series.end(), is_ct_volume) == 1)
    return std::move(*std::find_if(series.begin(), series.end(), is_ct_volume));
  return fail_usage(fmt::format("the folder holds {} DICOM series: {}", series.size(), list_of(series)),
                    folder.string(), "name the folder of one series, or choose it with --series NUMBER or UID");
}

}  // namespace trocar::io::detail
