#include "io/patient/build_from_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "config/toml.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/progress.h"
#include "core/text.h"
#include "core/version.h"
#include "dicom/volumes/write_volumes.h"
#include "io/ct_series/dicom_folder.h"
#include "io/image/image_file.h"
#include "io/patient/label_sources.h"
#include "io/patient/patient_folder.h"
#include "motion_builder/breathing_model.h"
#include "patient_builder/build_patient.h"
#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/plausibility/judge_anatomy.h"

namespace trocar::io {
namespace {

Status check_stop(const std::stop_token& stop, const PatientFiles& files) {
  if (stop.stop_requested()) return fail("stopped", files.ct.string(), "start the build again");
  return {};
}

/// The axis of a grid that runs most nearly along left and right.
std::size_t left_right_axis(const volume::GridGeometry& g) {
  Eigen::Index axis = 0;
  g.R_PV.row(0).cwiseAbs().maxCoeff(&axis);
  return static_cast<std::size_t>(axis);
}

/// Reverses this axis: mirrors the volume about the middle of its grid.
template <class T>
void mirror_left_right(volume::Grid<T>& grid) {
  const volume::GridGeometry& g = grid.geometry;
  const std::size_t a = left_right_axis(g);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    volume::Index3 ijk = g.index_of(n);
    if (2 * ijk[a] >= g.size[a] - 1) continue;
    ijk[a] = g.size[a] - 1 - ijk[a];
    std::swap(grid.voxels[n], grid.voxels[g.offset(ijk)]);
  }
}

Vec3 middle_P(const volume::GridGeometry& g) {
  return g.to_mm(0.5 * (volume::to_vec3(g.size) - Vec3::Ones()));
}

/// Mirrors labels together with their CT: about the middle of the CT, also where their own grid is smaller. Error: a
/// grid that lies obliquely to the CT's.
Status mirror_about(const volume::GridGeometry& ct, patient_builder::LabelSource& source) {
  volume::GridGeometry& g = source.labels.geometry;
  const Vec3 normal_P = ct.R_PV.col(static_cast<Eigen::Index>(left_right_axis(ct)));
  const Vec3 own_P = g.R_PV.col(static_cast<Eigen::Index>(left_right_axis(g)));
  constexpr double kParallel = 0.999999;
  if (std::abs(normal_P.dot(own_P)) < kParallel)
    return fail("the labels lie obliquely to the CT and cannot be mirrored with it", source.file,
                "give labels on the grid of the CT");
  mirror_left_right(source.labels);
  g.origin_P -= 2.0 * normal_P.dot(middle_P(g) - middle_P(ct)) * normal_P;
  return {};
}

/// What is mirrored is said in the provenance.
Status mirror(Mirroring mirroring, volume::CtGrid& ct, std::vector<patient_builder::LabelSource>& sources,
              std::vector<std::string>& provenance) {
  if (mirroring == Mirroring::kNone) return {};
  if (mirroring == Mirroring::kLabels) {
    provenance.emplace_back("mirrored left to right: labels");
    for (patient_builder::LabelSource& source : sources) mirror_left_right(source.labels);
    return {};
  }
  provenance.emplace_back("mirrored left to right: CT and labels");
  for (patient_builder::LabelSource& source : sources) TROCAR_TRY_STATUS(mirror_about(ct.geometry, source));
  mirror_left_right(ct);
  return {};
}

/// Counts the images of a series in a folder; nothing for a single file.
std::function<std::size_t(const std::string&)> series_counter(const std::filesystem::path& ct) {
  std::error_code error;
  if (!std::filesystem::is_directory(ct, error)) return {};
  return [ct](const std::string& series_uid) -> std::size_t {
    const auto all = detail::find_series(ct);
    if (!all) return 0;
    const auto found = std::find_if(all->begin(), all->end(), [&](const detail::SeriesImages& series) {
      return series.front().series_uid == series_uid;
    });
    return found != all->end() ? found->size() : 0;
  };
}

}  // namespace

std::string last_name(const std::filesystem::path& path) {
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

Result<anatomy::VirtualPatient> build_from_files(const PatientFiles& files, std::vector<std::string>& warnings,
                                                 const Progress& progress, const std::stop_token& stop) {
  report(progress, "reading the CT", 0.0);
  const auto preferred = files.series.empty() ? series_of_labels(files.labels) : std::vector<std::string>();
  TROCAR_TRY(CtScan scan, read_ct_scan(files.ct, files.series, preferred));
  volume::CtGrid& ct = scan.grid;
  std::move(scan.warnings.begin(), scan.warnings.end(), std::back_inserter(warnings));
  if (files.rescale) TROCAR_TRY_STATUS(anatomy::apply_rescale(*files.rescale, ct));
  if (auto status = anatomy::check_hounsfield(ct, patient_builder::air_of(files.confirmed)); !status)
    return fail(status.error().what, files.ct.string(), status.error().advice);
  TROCAR_TRY_STATUS(check_stop(stop, files));
  report(progress, "reading the labels", 0.2);
  const dicom::CtReference reference{ct.geometry,          scan.series_uid, scan.frame_of_reference, scan.slices_P,
                                     files.sibling_series, scan.patient_id, series_counter(files.ct)};
  TROCAR_TRY(auto sources, read_label_sources(files.labels, files.label_map, reference, warnings));
  TROCAR_TRY_STATUS(check_stop(stop, files));

  patient_builder::BuildOptions options;
  options.name = files.name;
  options.confirmed = files.confirmed;
  options.has_checked_hu = true;
  options.findings = files.findings;
  options.derive = files.derive;
  options.posture = files.posture;
  options.mirroring = files.mirroring;
  options.provenance = {fmt::format("built by trocar {}", kVersion), "CT: " + last_name(files.ct)};
  if (files.rescale)
    options.provenance.push_back(
        fmt::format("CT rescaled: HU = {} * stored + {}", files.rescale->slope, files.rescale->intercept));
  for (const std::filesystem::path& path : files.labels) options.provenance.push_back("labels: " + last_name(path));
  TROCAR_TRY_STATUS(mirror(files.mirroring, ct, sources, options.provenance));
  TROCAR_TRY(anatomy::VirtualPatient patient, patient_builder::build_patient(std::move(ct), std::move(sources), options,
                                                                             warnings, part_of(progress, 0.4, 0.9)));
  round_as_saved(patient);  // from the saved patient, the same model can be made again
  motion_builder::add_breathing_model(patient, part_of(progress, 0.9, 1.0));
  return patient;
}

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
    const bool was_derived = label.is_derived && patient_builder::is_derivable(label.name);
    if ((label.is_derived && !was_derived) || !occurs(patient, label.id)) continue;
    if (was_derived) label.name = std::string(patient_builder::kDerivedMark) + label.name;
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
  const std::size_t mark =
      label.name.starts_with(patient_builder::kDerivedMark) ? patient_builder::kDerivedMark.size() : 0;
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
