#include "io/patient/label_sources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/files/folders.h"
#include "core/parallel.h"
#include "core/text.h"
#include "io/ct_series/dicom_folder.h"
#include "io/image/detail/payload.h"
#include "io/image/detail/read_grid.h"
#include "io/patient/detail/label_checks.h"
#include "io/patient/detail/mask_folder.h"
#include "io/patient/detail/named_labels.h"
#include "io/patient/detail/slicer_segments.h"
#include "io/patient/label_map.h"

namespace trocar::io {
namespace fs = std::filesystem;
using detail::Place;
namespace {

constexpr std::size_t kFilesAtOnce = 8;  ///< Masks unpacked at a time: limits the memory.

Result<std::vector<patient_builder::LabelSource>> read_label_file(const fs::path& path, const LabelMap& map,
                                                                  Place place, std::vector<std::string>& warnings) {
  TROCAR_TRY_STATUS(detail::check_image_path(path));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(path));
  warnings.insert(warnings.end(), raw.warnings.begin(), raw.warnings.end());
  TROCAR_TRY(std::vector<patient_builder::LabelSource> sources, detail::read_slicer_segments(raw, map, path, warnings));
  if (!sources.empty()) return sources;
  TROCAR_TRY(sources.emplace_back(), detail::name_labels(raw, path, map, place, warnings));
  return sources;
}

// Folders of masks.

Result<std::vector<fs::path>> sorted_entries(const fs::path& folder, bool want_folders) {
  auto paths = list_folder(folder);
  if (paths)
    std::erase_if(*paths, [want_folders](const fs::path& path) {
      std::error_code gone;
      const bool is_wanted = want_folders ? fs::is_directory(path, gone) : fs::is_regular_file(path, gone);
      return !is_wanted || path.filename().string().starts_with('.');
    });
  return paths;
}

Result<std::vector<patient_builder::LabelSource>> read_mask_files(const std::vector<fs::path>& files,
                                                                  const LabelMap& map,
                                                                  std::vector<std::string>& warnings) {
  detail::MaskFolder folder;
  for (std::size_t begin = 0; begin < files.size(); begin += kFilesAtOnce) {
    const std::size_t count = std::min(kFilesAtOnce, files.size() - begin);
    std::vector<Result<std::vector<patient_builder::LabelSource>>> read(count);
    std::vector<std::vector<std::string>> told(count);
    parallel_for(count, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n)
        read[n] = read_label_file(files[begin + n], map, Place::kInFolder, told[n]);
    });
    for (const auto& of_file : told) warnings.insert(warnings.end(), of_file.begin(), of_file.end());
    for (auto& result : read) {
      TROCAR_TRY(std::vector<patient_builder::LabelSource> sources, std::move(result));
      for (patient_builder::LabelSource& source : sources) folder.add(std::move(source));
    }
  }
  return folder.take();
}

/// A mask of another patient, or in another frame of reference, lies anywhere in this CT.
Status check_mask_origin(const detail::DicomVolume<std::uint8_t>& mask, const dicom::CtReference& ct,
                         const fs::path& folder) {
  const auto differ = [](const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; };
  if (differ(mask.patient_id, ct.patient_id))
    return fail("the mask is of another patient than the CT (PatientID differs)", folder.string(),
                "give the masks of this patient");
  if (!differ(mask.frame_of_reference, ct.frame_of_reference)) return {};
  return fail(fmt::format("the mask has another frame of reference ({}) than the CT ({})", mask.frame_of_reference,
                          ct.frame_of_reference),
              folder.string(), "give the masks that were drawn on this CT");
}

/// The stored numbers count: some masks have the header of their CT, with its intercept of -1024. If all of them are
/// above zero, they are numbers with an offset.
Result<detail::DicomVolume<std::uint8_t>> read_mask_volume(const fs::path& folder) {
  using detail::PixelNumbers;
  const auto read = [&](PixelNumbers numbers) {
    return detail::read_dicom_folder<std::uint8_t>(folder, detail::convert_mask, {}, {}, numbers);
  };
  auto mask = read(PixelNumbers::kStored);
  if (!mask || std::ranges::count(mask->grid.voxels, std::uint8_t{0}) > 0) return mask;
  return read(PixelNumbers::kRescaled);
}

Result<patient_builder::LabelSource> read_dicom_mask(const fs::path& folder, const LabelMap& map,
                                                     const dicom::CtReference& ct) {
  TROCAR_TRY(auto mask, read_mask_volume(folder));
  TROCAR_TRY_STATUS(check_mask_origin(mask, ct, folder));
  return patient_builder::LabelSource{
      folder.string(), std::move(mask.grid), {{1, map.name_of(folder.filename().string())}}, false, {}};
}

// What a folder holds beside what is read.

/// A path with a trailing slash has no file name.
std::string last_name_of(const fs::path& folder) {
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

/// True for a file that can hold voxels: not a text, table, picture or list of hashes.
bool may_hold_voxels(const fs::path& file) {
  constexpr std::array<std::string_view, 22> kOthers{
      ".txt", ".json", ".csv", ".tsv",  ".xml", ".toml", ".yaml", ".yml",    ".md",   ".html", ".pdf",
      ".log", ".png",  ".jpg", ".jpeg", ".py",  ".sh",   ".md5",  ".sha256", ".xlsx", ".ctbl", ".stl"};
  return std::ranges::find(kOthers, ascii::lower_case(file.extension().string())) == kOthers.end();
}

/// For warnings: what cannot be listed is not named.
std::vector<fs::path> or_none(Result<std::vector<fs::path>> listed) {
  return std::move(listed).value_or(std::vector<fs::path>());
}

/// A folder with images in it, not deeper.
bool holds_images(const fs::path& folder) {
  const std::vector<fs::path> files = or_none(sorted_entries(folder, false));
  return std::ranges::any_of(files, [](const fs::path& file) { return detail::find_image_format(file).has_value(); }) ||
         detail::has_dicom_images(folder);
}

void tell_left_out(const fs::path& folder, const std::vector<fs::path>& left_out, std::vector<std::string>& warnings) {
  if (left_out.empty()) return;
  constexpr std::size_t kMostNamed = 6;
  std::vector<std::string> names;
  for (const fs::path& path : left_out)
    if (names.size() < kMostNamed) names.push_back(path.lexically_relative(folder).string());
  warnings.push_back(fmt::format(
      "{}: not read: {}{}; give each by --labels of its own if it belongs to the segmentation", last_name_of(folder),
      fmt::join(names, ", "),
      left_out.size() > kMostNamed ? fmt::format(" and {} more", left_out.size() - kMostNamed) : std::string()));
}

/// Beside masks: files of another kind (.hdr with .img), and folders with images.
std::vector<fs::path> beside_masks(const fs::path& folder) {
  std::vector<fs::path> left_out;
  // The voxels of a header are read with it.
  const auto is_data = [](const fs::path& file) {
    const std::string ending = ascii::lower_case(file.extension().string());
    return ending == ".raw" || ending == ".zraw";
  };
  for (const fs::path& file : or_none(sorted_entries(folder, false)))
    if (!detail::find_image_format(file) && !is_data(file) && may_hold_voxels(file)) left_out.push_back(file);
  for (const fs::path& inner : or_none(sorted_entries(folder, true)))
    if (holds_images(inner)) left_out.push_back(inner);
  return left_out;
}

/// Beside DICOM objects: image files of another kind, in the folder or below.
std::vector<fs::path> beside_objects(const fs::path& folder) {
  std::vector<fs::path> left_out;
  for (const fs::path& file : or_none(detail::files_below(folder)))
    if (detail::find_image_format(file)) left_out.push_back(file);
  return left_out;
}

Result<std::vector<patient_builder::LabelSource>> read_label_folder(const fs::path& folder, const LabelMap& map,
                                                                    const dicom::CtReference& ct,
                                                                    std::vector<std::string>& warnings) {
  TROCAR_TRY(std::vector<fs::path> files, sorted_entries(folder, false));
  std::erase_if(files, [](const fs::path& file) { return !detail::find_image_format(file); });
  if (!files.empty()) {
    tell_left_out(folder, beside_masks(folder), warnings);
    return read_mask_files(files, map, warnings);
  }

  detail::MaskFolder masks;
  // A path with a trailing slash has no file name.
  const fs::path self = fs::absolute(folder / ".").lexically_normal().parent_path();
  if (detail::has_dicom_images(self)) {
    TROCAR_TRY(patient_builder::LabelSource mask, read_dicom_mask(self, map, ct));
    masks.add(std::move(mask));
    return masks.take();
  }
  bool any = false;
  TROCAR_TRY(const std::vector<fs::path> folders, sorted_entries(folder, true));
  for (const fs::path& series : folders) {
    if (!detail::has_dicom_images(series)) continue;
    TROCAR_TRY(patient_builder::LabelSource mask, read_dicom_mask(series, map, ct));
    masks.add(std::move(mask));
    any = true;
  }
  if (any) return masks.take();
  return fail("no mask in the folder", folder.string(),
              "give a folder of .nii.gz, .nrrd or .mha masks, of DICOM mask series (one sub-folder a structure), or of "
              "DICOM SEG or RTSTRUCT files");
}

Result<std::vector<patient_builder::LabelSource>> read_path(const fs::path& path, const LabelMap& map,
                                                            const dicom::CtReference& ct,
                                                            std::vector<std::string>& warnings) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  TROCAR_TRY(const std::vector<fs::path> objects, detail::find_dicom_labels(path));
  if (objects.empty())
    return is_folder ? read_label_folder(path, map, ct, warnings)
                     : read_label_file(path, map, Place::kNamedByUser, warnings);
  if (is_folder) tell_left_out(path, beside_objects(path), warnings);
  std::vector<patient_builder::LabelSource> all;
  for (const fs::path& object : objects) {
    TROCAR_TRY(std::vector<patient_builder::LabelSource> sources, detail::read_dicom_labels(object, map, ct, warnings));
    std::move(sources.begin(), sources.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace

Result<std::vector<patient_builder::LabelSource>> read_label_sources(const std::vector<fs::path>& paths,
                                                                     const std::string& label_map,
                                                                     const dicom::CtReference& ct,
                                                                     std::vector<std::string>& warnings) {
  TROCAR_TRY(const LabelMap map, LabelMap::load(label_map));
  std::vector<patient_builder::LabelSource> all;
  for (const fs::path& path : paths) {
    TROCAR_TRY(std::vector<patient_builder::LabelSource> sources, read_path(path, map, ct, warnings));
    std::move(sources.begin(), sources.end(), std::back_inserter(all));
  }
  if (all.empty() && !paths.empty())
    return fail("the label map leaves out every label", label_map, "name at least one structure in [labels]");
  detail::leave_out_unused(all, map, warnings);
  const std::string where = paths.size() == 1 ? paths.front().string() : fmt::format("{} files", paths.size());
  TROCAR_TRY_STATUS(detail::check_voxels(all, map, ct.grid, where, warnings));
  return all;
}

Result<std::vector<patient_builder::LabelSource>> read_label_sources(const std::vector<fs::path>& paths,
                                                                     const std::string& label_map) {
  std::vector<std::string> warnings;
  return read_label_sources(paths, label_map, {}, warnings);
}

std::vector<std::string> series_of_labels(const std::vector<fs::path>& paths) {
  std::vector<std::string> all;
  for (const fs::path& path : paths) {
    const auto files = detail::find_dicom_labels(path);
    if (!files) continue;
    for (const fs::path& file : *files) {
      const auto series = dicom::referenced_series(file);
      if (series) all.insert(all.end(), series->begin(), series->end());
    }
  }
  return all;
}

}  // namespace trocar::io
