#include "patient_builder/build_patient.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "anatomy/known_structures.h"
#include "anatomy/label_statistics.h"
#include "anatomy/tissue/hounsfield.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/result.h"
#include "patient_builder/complete_labels.h"
#include "patient_builder/detail/merge_sources.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "patient_builder/repair/repair_segmentation.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"

namespace trocar::patient_builder {
namespace {

constexpr double kMinBodyMl = 100.0;       // assumed: smaller parts do not belong to a person
constexpr double kHintAgreement = 0.9;     // Dice coefficient above which a given body mask is used
constexpr double kHintRemoves = 0.01;      // share of the body that a given mask removes without a warning
constexpr double kMaxShareOutside = 0.02;  // share of a structure outside the body without a warning

/// Removes the voxels outside a given, filled mask of the whole body if it is similar to the one found. Depths are
/// measured from this skin: what it removes is told.
volume::MaskGrid apply_body_hint(volume::MaskGrid body, const volume::MaskGrid& given,
                                 std::vector<std::string>& warnings) {
  const volume::MaskGrid hint = volume::fill_holes_in_slices(given);
  std::size_t both = 0, found = 0, in_hint = 0;
  for (std::size_t n = 0; n < hint.voxels.size(); ++n) {
    both += hint.voxels[n] & body.voxels[n];
    found += body.voxels[n];
    in_hint += hint.voxels[n];
  }
  if (2.0 * static_cast<double>(both) < kHintAgreement * static_cast<double>(found + in_hint)) {
    warnings.push_back(
        fmt::format("the given mask of the body is not used: it has {:.0f} % in common with the body in "
                    "the CT",
                    200.0 * static_cast<double>(both) / static_cast<double>(found + in_hint)));
    return body;
  }
  const double removed_ml = static_cast<double>(found - both) * body.geometry.voxel_volume_mm3() / 1000.0;
  if (static_cast<double>(found - both) > kHintRemoves * static_cast<double>(found))
    warnings.push_back(
        fmt::format("the given mask of the body leaves out {:.0f} ml ({:.1f} %) of what the CT shows as "
                    "body: the skin, from which depths are measured, follows the mask",
                    removed_ml, 100.0 * static_cast<double>(found - both) / static_cast<double>(found)));
  for (std::size_t n = 0; n < hint.voxels.size(); ++n) body.voxels[n] &= hint.voxels[n];
  return volume::largest_component(body);
}

Result<volume::MaskGrid> find_checked_body(const volume::CtGrid& ct) {
  volume::MaskGrid body = find_body(ct);
  const auto voxels = static_cast<double>(std::count(body.voxels.begin(), body.voxels.end(), 1));
  if (voxels * ct.geometry.voxel_volume_mm3() / 1000.0 < kMinBodyMl)
    return fail("no body found in the CT", {}, "check that it is a CT in Hounsfield units and shows a patient");
  return body;
}

/// Clears labels outside the body; warns if a structure loses more than a rim. An organ that lies outside by a good
/// part is that of another patient; arms may lie beside what is found as the body.
std::vector<AnatomyFinding> clear_outside(const volume::MaskGrid& body, volume::LabelGrid& labels,
                                          const anatomy::LabelTable& table, std::vector<std::string>& warnings) {
  constexpr double kFarOutside = 0.05, kOfAllOrgans = 0.1, kOfAll = 0.15;
  constexpr std::size_t kMostNamed = 5;
  constexpr std::array<std::string_view, 4> kOfArms{"bone", "muscle", "adipose", "soft_tissue"};
  std::array<std::size_t, 256> all{}, outside{};
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    std::uint8_t& id = labels.voxels[n];
    ++all[id];
    if (body.voxels[n]) continue;
    ++outside[id];
    id = 0;
  }
  std::vector<std::string> far_outside;
  double organs = 0.0, organs_outside = 0.0, whole = 0.0, whole_outside = 0.0;
  for (const anatomy::Label& label : table.labels) {
    const auto voxels = static_cast<double>(std::max<std::size_t>(all[label.id], 1));
    const double share = static_cast<double>(outside[label.id]) / voxels;
    const bool is_organ = std::ranges::find(kOfArms, label.tissue) == kOfArms.end() && !label.is_derived;
    whole += voxels;
    whole_outside += share * voxels;
    organs += is_organ ? voxels : 0.0;
    organs_outside += is_organ ? share * voxels : 0.0;
    if (share <= kMaxShareOutside) continue;
    warnings.push_back(
        fmt::format("{:.0f} % of \"{}\" is outside the body and was removed", 100.0 * share, label.name));
    if (share > kFarOutside) far_outside.push_back(fmt::format("{:.0f} % of {}", 100.0 * share, label.name));
  }
  if (organs_outside <= kOfAllOrgans * organs && whole_outside <= kOfAll * whole) return {};
  if (far_outside.size() > kMostNamed) far_outside.resize(kMostNamed);
  return {
      {kOtherCt,
       fmt::format("{:.0f} % of the labels lie outside the body ({}): the segmentation seems to belong to another CT",
                   100.0 * whole_outside / whole, fmt::join(far_outside, ", ")),
       fmt::format("give the segmentation of this CT; --confirm {} if it is right", kOtherCt)}};
}

/// Removes the mark of derived structures (kDerivedMark) from the names of an exported segmentation; returns their
/// plain names.
std::vector<std::string> take_derived_marks(std::vector<LabelSource>& sources) {
  std::vector<std::string> derived;
  for (LabelSource& source : sources)
    for (auto& [value, name] : source.names) {
      if (!is_marked_derived(name)) continue;
      name.erase(0, kDerivedMark.size());
      derived.push_back(name);
    }
  return derived;
}

void warn_of_cut_structures(const anatomy::VirtualPatient& patient, std::size_t known_count,
                            std::vector<std::string>& warnings) {
  std::vector<std::string> cut;
  for (const anatomy::LabelStatistics& label : anatomy::label_statistics(patient)) {
    if (label.touches_border && label.id <= known_count) cut.push_back(patient.label_table.find(label.id)->name);
  }
  if (!cut.empty()) warnings.push_back(fmt::format("cut off by the border of the CT: {}", fmt::join(cut, ", ")));
}

}  // namespace

Result<anatomy::VirtualPatient> build_patient(volume::CtGrid ct, std::vector<LabelSource> sources,
                                              const BuildOptions& options, std::vector<std::string>& warnings,
                                              const Progress& progress) {
  if (ct.empty()) return fail("the CT has no voxels", "CT", "give a CT volume with image data");
  if (!options.has_checked_hu) TROCAR_TRY_STATUS(anatomy::check_hounsfield(ct, air_of(options.confirmed)));
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(const anatomy::KnownStructures known, anatomy::KnownStructures::load(data_folder));
  TROCAR_TRY_STATUS(check_completed_names(known));
  anatomy::VirtualPatient patient;
  patient.name = options.name;
  patient.provenance = options.provenance;
  patient.posture = options.posture;

  std::vector<AnatomyFinding> findings = judge_numbers(ct, sources, known);
  const std::vector<std::string> derived_before = take_derived_marks(sources);
  // Slices are axial from here on, independent of the stored order of the CT.
  patient.ct = volume::along_P(std::move(ct));
  report(progress, "labels", 0.0);
  TROCAR_TRY(detail::MergedLabels merged,
             detail::merge_sources(std::move(sources), patient.ct.geometry, known, warnings));
  report(progress, "body", 0.2);
  TROCAR_TRY(volume::MaskGrid body, find_checked_body(patient.ct));
  for (AnatomyFinding& finding : judge_posture(patient.ct, body, patient.posture))
    findings.push_back(std::move(finding));
  if (!merged.body_hint.empty()) body = apply_body_hint(std::move(body), merged.body_hint, warnings);
  merged.body_hint = {};
  for (AnatomyFinding& finding : judge_sides(body)) {
    if (finding.is_grave && air_of(options.confirmed) == anatomy::AirIn::kNowhere) take_sides_as_skin(body);
    findings.push_back(std::move(finding));
  }
  for (AnatomyFinding& finding : clear_outside(body, merged.labels, merged.table, warnings))
    findings.push_back(std::move(finding));

  patient.labels = std::move(merged.labels);
  patient.label_table = std::move(merged.table);
  for (anatomy::Label& label : patient.label_table.labels)
    label.is_derived = std::ranges::find(derived_before, label.name) != derived_before.end();
  for (AnatomyFinding& finding : judge_anatomy(patient, options.mirroring)) findings.push_back(std::move(finding));
  if (options.findings != nullptr) *options.findings = findings;
  TROCAR_TRY_STATUS(settle_findings(findings, options.confirmed, patient.provenance, warnings));

  report(progress, "distance to the skin", 0.4);
  patient.skin_distance_mm = volume::signed_distance_mm(body);
  report(progress, "errors of the segmentation", 0.6);
  patient.repairs = repair_segmentation(patient.ct, patient.labels, patient.label_table);
  for (const anatomy::Finding& repair : patient.repairs) warnings.push_back(repair.text);

  const std::size_t known_count = patient.label_table.labels.size();
  const std::vector<std::string> derived =
      complete_labels(patient, known, options.derive, part_of(progress, 0.7, 0.95));
  if (!derived.empty()) patient.provenance.push_back(fmt::format("derived: {}", fmt::join(derived, ", ")));
  warn_of_cut_structures(patient, known_count, warnings);
  patient.content_hash = anatomy::hash_patient(patient);
  report(progress, "patient", 1.0);
  return patient;
}

namespace {

// All numbers are assumed: chosen on two CTs (3 mm and 0.74 mm voxels), with a safety distance.
constexpr std::int16_t kSolidAboveHu = -300;  // skin and fat above, air, foam and cloth below
constexpr double kTableVoxelMm = 3.0;         // the table is found at this resolution
constexpr double kThinRadiusMm = 5.0;         // plates, tubes and blankets are thinner than twice this
constexpr double kLongMm = 120.0;             // thin parts that are longer do not belong to a body
constexpr double kSealRadiusMm = 7.0;         // gaps in the chest wall from removing the table
constexpr double kContourSearchMm = 4.0;      // search distance of the fine contour around the coarse one

volume::MaskGrid solid_of(const volume::CtGrid& ct) {
  volume::MaskGrid mask(ct.geometry);
  parallel_for(mask.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) mask.voxels[n] = ct.voxels[n] > kSolidAboveHu ? 1 : 0;
  });
  return mask;
}

/// a and not b.
volume::MaskGrid without(volume::MaskGrid a, const volume::MaskGrid& b) {
  for (std::size_t n = 0; n < a.voxels.size(); ++n) a.voxels[n] = a.voxels[n] && !b.voxels[n] ? 1 : 0;
  return a;
}

volume::MaskGrid opened(const volume::MaskGrid& mask, double radius_mm) {
  return volume::dilate(volume::erode(mask, radius_mm), radius_mm);
}

/// Thin connected parts of a mask with a long box: the CT table, tubes, folds of a blanket.
volume::MaskGrid long_thin_parts(const volume::MaskGrid& solid) {
  const volume::GridGeometry& geometry = solid.geometry;
  const volume::Components parts = volume::connected_components(without(solid, opened(solid, kThinRadiusMm)));
  struct Box {
    volume::Index3 low, high;
  };
  std::vector<Box> boxes(parts.voxel_counts.size(), Box{geometry.size, {-1, -1, -1}});
  for (std::size_t n = 0; n < parts.ids.voxels.size(); ++n) {
    if (parts.ids.voxels[n] == 0) continue;
    Box& box = boxes[static_cast<std::size_t>(parts.ids.voxels[n] - 1)];
    const volume::Index3 ijk = geometry.index_of(n);
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], ijk[a]);
      box.high[a] = std::max(box.high[a], ijk[a]);
    }
  }
  volume::MaskGrid mask(geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    if (parts.ids.voxels[n] == 0) continue;
    const Box& box = boxes[static_cast<std::size_t>(parts.ids.voxels[n] - 1)];
    double extent_mm = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      extent_mm = std::max(extent_mm, static_cast<double>(box.high[a] - box.low[a] + 1) *
                                          geometry.spacing_mm[static_cast<Eigen::Index>(a)]);
    mask.voxels[n] = extent_mm > kLongMm ? 1 : 0;
  }
  return mask;
}

/// Fills the body's lungs and bowel gas; seals a torn chest wall for this, but keeps outer folds open.
volume::MaskGrid filled(const volume::MaskGrid& body) {
  const volume::MaskGrid sealed = volume::dilate(body, kSealRadiusMm);
  const volume::MaskGrid cavities =
      volume::dilate(without(volume::fill_holes_in_slices(sealed), sealed), kSealRadiusMm);
  volume::MaskGrid whole = body;
  for (std::size_t n = 0; n < whole.voxels.size(); ++n) whole.voxels[n] |= cavities.voxels[n];
  return volume::fill_holes(volume::fill_holes_in_slices(whole));
}

volume::MaskGrid find_coarse_body(const volume::CtGrid& ct) {
  const volume::MaskGrid solid = solid_of(ct);
  const volume::MaskGrid body = volume::largest_component(without(solid, long_thin_parts(solid)));
  return volume::largest_component(opened(filled(body), kThinRadiusMm));
}

}  // namespace

volume::MaskGrid find_body(const volume::CtGrid& ct) {
  TROCAR_CHECK(volume::order_along_P(ct.geometry).is_identity());
  const volume::CtGrid coarse_ct =
      volume::resample_linear(ct, volume::isotropic_geometry(ct.geometry, kTableVoxelMm), -1000);
  volume::MaskGrid zones = find_coarse_body(coarse_ct);
  {  // 0: far from the body, 1: the fine contour decides, 2: deep inside
    const volume::MaskGrid near = volume::dilate(zones, kContourSearchMm);
    const volume::MaskGrid deep = volume::erode(zones, kContourSearchMm);
    for (std::size_t n = 0; n < zones.voxels.size(); ++n) zones.voxels[n] = deep.voxels[n] ? 2 : near.voxels[n];
  }
  volume::MaskGrid body = volume::resample_nearest(zones, ct.geometry, 0);
  parallel_for(body.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      std::uint8_t& voxel = body.voxels[n];
      voxel = voxel == 2 || (voxel == 1 && ct.voxels[n] > kSolidAboveHu) ? 1 : 0;
    }
  });
  return volume::largest_component(volume::fill_holes_in_slices(body));
}

}  // namespace trocar::patient_builder
