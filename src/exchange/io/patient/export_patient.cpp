#include "io/patient/export_patient.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "anatomy/derive/derive_choice.h"
#include "config/toml.h"
#include "core/ascii.h"
#include "core/files/atomic_file.h"
#include "core/files/data_dir.h"
#include "core/part_of_progress.h"
#include "dicom/volumes/write_volumes.h"
#include "io/image/image_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSkin = "skin";

volume::MaskGrid body_of(const anatomy::VirtualPatient& patient) {
  volume::MaskGrid body(patient.labels.geometry);
  for (std::size_t n = 0; n < body.voxels.size(); ++n) body.voxels[n] = patient.skin_distance_mm.voxels[n] < 0.0F;
  return body;
}

bool occurs(const anatomy::VirtualPatient& patient, std::uint8_t id) {
  return std::find(patient.labels.voxels.begin(), patient.labels.voxels.end(), id) != patient.labels.voxels.end();
}

/// Structures that a segmentation would contain, and those derived from them, which are named so: they lie within their
/// neighbours, so that a build could not derive them again. What is found from HU is left out.
std::vector<anatomy::Label> exported_labels(const anatomy::VirtualPatient& patient) {
  std::vector<anatomy::Label> labels;
  for (anatomy::Label label : patient.label_table.labels) {
    const bool was_derived = label.is_derived && anatomy::is_derivable(label.name);
    if ((label.is_derived && !was_derived) || !occurs(patient, label.id)) continue;
    if (was_derived) label.name = std::string(anatomy::kDerivedMark) + label.name;
    labels.push_back(std::move(label));
  }
  return labels;
}

std::string file_name_of(const std::string& name) {
  std::string file;
  for (const char c : name) file += ascii::is_letter_or_digit(c) || c == '_' || c == '-' ? c : '_';
  return file;
}

Status write_nifti(const anatomy::VirtualPatient& patient, const fs::path& folder, const Progress& progress) {
  const fs::path masks = folder / "segmentations";
  std::error_code error;
  fs::create_directories(masks, error);  // an error is reported when writing
  TROCAR_TRY_STATUS(write_image(patient.ct, folder / "ct.nii.gz"));
  const std::vector<anatomy::Label> labels = exported_labels(patient);
  volume::MaskGrid mask(patient.labels.geometry);
  for (std::size_t n = 0; n < labels.size(); ++n) {
    report(progress, labels[n].name, static_cast<double>(n) / static_cast<double>(labels.size()));
    std::transform(patient.labels.voxels.begin(), patient.labels.voxels.end(), mask.voxels.begin(),
                   [&](std::uint8_t id) { return static_cast<std::uint8_t>(id == labels[n].id); });
    TROCAR_TRY_STATUS(write_image(mask, masks / (file_name_of(labels[n].name) + ".nii.gz")));
  }
  return write_image(body_of(patient), masks / (std::string(kSkin) + ".nii.gz"));
}

/// Name of a structure without side -> its SNOMED CT code. A missing table only costs the codes.
std::map<std::string, std::string> codes_by_name() {
  std::map<std::string, std::string> codes;
  const auto folder = checked_data_dir();
  if (!folder) return codes;
  const auto file = config::load_toml(*folder / "structure_codes.toml");
  const auto table = file ? file->table("SCT") : Result<config::TomlTable>(tl::unexpected(file.error()));
  if (!table) return codes;
  for (const std::string& code : table->keys())
    if (const auto name = table->string(code)) codes.emplace(*name, code);
  return codes;
}

dicom::WrittenSegment segment_of(const anatomy::Label& label, const std::map<std::string, std::string>& codes) {
  dicom::WrittenSegment segment{label.id, label.name, {}, label.name, {}};
  const std::size_t mark = label.name.starts_with(anatomy::kDerivedMark) ? anatomy::kDerivedMark.size() : 0;
  const std::string structure = label.name.substr(mark);
  if (const auto whole = codes.find(structure); whole != codes.end()) {
    segment.code = whole->second;  // the code tells the side, too
    return segment;
  }
  for (const auto& [part, side] : {std::pair{"_left", "Left"}, std::pair{"_right", "Right"}}) {
    std::string name = structure;
    const std::size_t at = name.find(part);
    if (at == std::string::npos) continue;
    const auto found = codes.find(name.erase(at, std::string_view(part).size()));
    if (found == codes.end()) continue;
    segment.code = found->second;
    segment.side = side;
  }
  return segment;
}

Status write_dicom(const anatomy::VirtualPatient& patient, const fs::path& folder, const Progress& progress) {
  std::error_code error;
  fs::create_directories(folder / "ct", error);  // an error is reported when writing
  const dicom::VolumeIdentity identity = dicom::make_identity(patient.ct.geometry.size[2]);
  TROCAR_TRY_STATUS(dicom::write_ct_series(patient.ct, identity, folder / "ct", part_of(progress, 0.0, 0.7)));
  report(progress, "segmentation", 0.7);
  const auto codes = codes_by_name();
  std::vector<dicom::WrittenSegment> segments;
  for (const anatomy::Label& label : exported_labels(patient)) segments.push_back(segment_of(label, codes));
  TROCAR_TRY_STATUS(dicom::write_segmentation(patient.labels, segments, identity, folder / "segmentation.dcm"));
  return dicom::write_segmentation(body_of(patient), {{1, kSkin, "39937001", "Skin", {}}}, identity,
                                   folder / "body.dcm");
}

}  // namespace

Status export_patient(const anatomy::VirtualPatient& patient, ExportKind kind, const fs::path& folder,
                      const Progress& progress) {
  return write_folder_atomically(folder, [&](const fs::path& temporary) {
    return kind == ExportKind::kNifti ? write_nifti(patient, temporary, progress)
                                      : write_dicom(patient, temporary, progress);
  });
}

}  // namespace trocar::io
