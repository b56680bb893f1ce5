#include "io/patient/build_from_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "anatomy/build_patient.h"
#include "anatomy/plausibility/judge_anatomy.h"
#include "core/part_of_progress.h"
#include "core/version.h"
#include "io/dicom/detail/find_series.h"
#include "io/image/image_file.h"
#include "io/patient/label_sources.h"

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
Status mirror_about(const volume::GridGeometry& ct, anatomy::LabelSource& source) {
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
Status mirror(Mirroring mirroring, volume::CtGrid& ct, std::vector<anatomy::LabelSource>& sources,
              std::vector<std::string>& provenance) {
  if (mirroring == Mirroring::kNone) return {};
  if (mirroring == Mirroring::kLabels) {
    provenance.emplace_back("mirrored left to right: labels");
    for (anatomy::LabelSource& source : sources) mirror_left_right(source.labels);
    return {};
  }
  provenance.emplace_back("mirrored left to right: CT and labels");
  for (anatomy::LabelSource& source : sources) TROCAR_TRY_STATUS(mirror_about(ct.geometry, source));
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
  if (auto status = anatomy::check_hounsfield(ct, anatomy::air_of(files.confirmed)); !status)
    return fail(status.error().what, files.ct.string(), status.error().advice);
  TROCAR_TRY_STATUS(check_stop(stop, files));
  report(progress, "reading the labels", 0.2);
  const dicom::CtReference reference{ct.geometry,          scan.series_uid, scan.frame_of_reference, scan.slices_P,
                                     files.sibling_series, scan.patient_id, series_counter(files.ct)};
  TROCAR_TRY(auto sources, read_label_sources(files.labels, files.label_map, reference, warnings));
  TROCAR_TRY_STATUS(check_stop(stop, files));

  anatomy::BuildOptions options;
  options.name = files.name;
  options.confirmed = files.confirmed;
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
  return anatomy::build_patient(ct, std::move(sources), options, warnings, part_of(progress, 0.4, 1.0));
}

}  // namespace trocar::io
