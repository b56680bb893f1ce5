// Effect of an incomplete segmentation: forces of the same poses on fully and partly segmented data (the study of the
// Luebeck group, references.md).

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "bench/benchmarks.h"
#include "bench/haptics/curve_output.h"
#include "cases/prepare_case.h"
#include "cases/scene_request.h"
#include "core/files/output_file.h"
#include "lab/cases/segmentation_study.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {

constexpr int kMostPlanned = 100000;     ///< Limit of plan_paths; the study's paths are a sample of them.
constexpr std::size_t kWorstPlaces = 8;  ///< Rows of the table.
constexpr haptics::ForceModel kModel = haptics::ForceModel::kProxy;  ///< Model of the study.

Result<std::vector<cases::PrescribedMotion>> plan_motions(const cases::Case& tables,
                                                          const anatomy::VirtualPatient& patient,
                                                          const Options& options) {
  TROCAR_TRY(const auto planned,
             tasks::plan_paths(tables.task, patient, tables.needle, {kMostPlanned, options.seed}, options.progress));
  cases::StudyMotion study;
  study.seed = options.seed;
  std::vector<cases::PrescribedMotion> motions;
  for (const std::size_t i :
       cases::spread_choice(planned.size(), static_cast<std::size_t>(options.paths), options.seed))
    motions.push_back(cases::study_motion(planned[i].line_P, i, study));
  return motions;
}

Figures over_paths(const std::vector<cases::PathError>& errors, double cases::PathError::*value) {
  std::vector<double> values;
  for (const cases::PathError& error : errors) values.push_back(error.*value);
  return figures_of(std::move(values));
}

/// Name of what gave way; empty: nothing.
std::string name_of_layer(std::uint8_t layer, const anatomy::TissueTable& tissues) {
  if (layer == haptics::kNoLayer) return {};
  return layer == cases::kBorder ? "border_in_ct" : tissues.layers[layer].name;
}

/// "path 12 at 3.214 s, 22.1 mm deep, adipose > muscle; peritoneum gives way in one only": the path with the largest
/// value, and where on it that is.
std::string place_of_largest(const std::vector<cases::PathError>& errors, double cases::PathError::*value,
                             cases::ErrorPlace cases::PathError::*where, const anatomy::TissueTable& tissues) {
  const auto worst =
      std::max_element(errors.begin(), errors.end(), [&](const auto& a, const auto& b) { return a.*value < b.*value; });
  if (worst == errors.end() || !((*worst).*value > 0.0)) return "nowhere";
  const cases::ErrorPlace& place = (*worst).*where;
  std::string text = fmt::format("path {} at {:.3f} s, {:.1f} mm deep, {}", worst - errors.begin() + 1, place.time_s,
                                 place.depth_mm, tissues.tissues[place.tissue].name);
  if (place.ahead != place.tissue) text += fmt::format(" > {}", tissues.tissues[place.ahead].name);
  if (place.layer != haptics::kNoLayer)
    text += fmt::format("; {} gives way in one only", name_of_layer(place.layer, tissues));
  return text;
}

std::vector<CaseResult> results_of(const std::vector<cases::PathError>& errors, const std::string& what,
                                   const anatomy::TissueTable& tissues, double took_s) {
  const cases::StudyFigures figures = cases::study_figures(errors);
  return {
      {"paths/mean-rms", "n", figure_of(figures.mean_rms_n), {}, "mean over paths; published 0.12; " + what},
      {"paths/rms", "n", over_paths(errors, &cases::PathError::rms_n), {}, "over paths"},
      {"paths/mean-max", "n", figure_of(figures.mean_max_n), {}, "mean over paths of the largest error of each"},
      {"paths/max",
       "n",
       over_paths(errors, &cases::PathError::max_n),
       {},
       fmt::format("over paths, of the largest error of each; published max 1.6; {}",
                   place_of_largest(errors, &cases::PathError::max_n, &cases::PathError::worst, tissues))},
      {"paths/max-apart",
       "n",
       over_paths(errors, &cases::PathError::max_apart_n),
       {},
       fmt::format("without {:.0f} ms before and after a layer or border that gives way in both within {} mm; {}",
                   kMsPerS * cases::kGiveWay_s, cases::kSamePlace_mm,
                   place_of_largest(errors, &cases::PathError::max_apart_n, &cases::PathError::worst_apart, tissues))},
      {"paths/affected",
       "ratio",
       figure_of(figures.affected),
       {},
       fmt::format("of all ticks behind the skin: off by more than {} N and {:.0f} %; published 0.12",
                   cases::kAffected_n, 100.0 * cases::kAffectedShare)},
      {"paths/torque-rms",
       "nmm",
       over_paths(errors, &cases::PathError::torque_rms_nmm),
       {},
       fmt::format("over paths; mean {:.2f}", figures.mean_torque_rms_nmm)},
      {"paths/torque-max", "nmm", over_paths(errors, &cases::PathError::torque_max_nmm), {}, "over paths"},
      {"paths/force-rms",
       "n",
       over_paths(errors, &cases::PathError::full_rms_n),
       {},
       "the fully segmented force itself, to hold the errors against"},
      {"paths/time", "ms", figure_of(1e3 * took_s), {}, "both forces on all paths, planning not counted"}};
}

void add_worst_places(std::vector<CaseResult>& results, const std::vector<cases::PathError>& errors,
                      const anatomy::TissueTable& tissues) {
  const auto places = cases::worst_places(errors, tissues);
  for (std::size_t i = 0; i < std::min(places.size(), kWorstPlaces); ++i) {
    Figures figures = figure_of(places[i].mean_max_n);
    figures.max = places[i].max_n;
    results.push_back({"paths/worst/" + places[i].place,
                       "n",
                       figures,
                       {},
                       fmt::format("largest error of {} paths; mean and max", places[i].paths)});
  }
}

/// Both scenes, the paths through them and the results.
struct Study {
  std::shared_ptr<const haptics::HapticScene> full;
  std::shared_ptr<const haptics::HapticScene> partly;
  std::vector<cases::PrescribedMotion> motions;
  std::vector<cases::PathError> errors;
};

std::string csv_of(const Study& study, const anatomy::TissueTable& tissues) {
  std::string csv =
      "path,entry_x_mm,entry_y_mm,entry_z_mm,target_x_mm,target_y_mm,target_z_mm,rms_n,max_n,torque_rms_nmm,"
      "torque_max_nmm,affected,force_rms_n,force_max_n,worst_at_mm,worst_tissue,worst_ahead,max_apart_n,apart_at_s,"
      "apart_at_mm,apart_tissue,apart_ahead,apart_layer\n";
  for (std::size_t i = 0; i < study.errors.size(); ++i) {
    const cases::PathError& e = study.errors[i];
    const Vec3& a = e.line_P.a;
    const Vec3& b = e.line_P.b;
    csv +=
        fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},", i + 1, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    csv += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{},{},", e.rms_n, e.max_n,
                       e.torque_rms_nmm, e.torque_max_nmm, static_cast<double>(e.affected) / std::max(1, e.ticks),
                       e.full_rms_n, e.full_max_n, e.worst.depth_mm, tissues.tissues[e.worst.tissue].name,
                       tissues.tissues[e.worst.ahead].name);
    const cases::ErrorPlace& apart = e.worst_apart;
    csv += fmt::format("{:.4f},{:.3f},{:.2f},{},{},{}\n", e.max_apart_n, apart.time_s, apart.depth_mm,
                       tissues.tissues[apart.tissue].name, tissues.tissues[apart.ahead].name,
                       name_of_layer(apart.layer, tissues));
  }
  return csv;
}

/// Both forces along one of the paths.
PathCurves curves_on(const Study& study, std::size_t i, const anatomy::TissueTable& tissues, const std::string& name) {
  PathCurves path;
  path.name = name;
  path.title =
      fmt::format("{}, {} model, path {}, rms {:.2f} N, max {:.2f} N", study.full->patient->name,
                  to_string(study.full->options.force_model), i + 1, study.errors[i].rms_n, study.errors[i].max_n);
  path.pieces = cases::pieces_along(*study.full, tissues, study.motions[i].line_P);
  for (const auto& [label, scene] : {std::pair("fully segmented", study.full), std::pair("partly", study.partly)}) {
    NamedCurve curve{label, cases::force_curve(*scene, study.motions[i]), {}};
    curve.events = cases::find_curve_events(curve.points, tissues);
    path.curves.push_back(std::move(curve));
  }
  return path;
}

/// paths.csv, and both forces along the worst, the median and the best path (by their largest error).
Status write_study(const Study& study, const anatomy::TissueTable& tissues, const std::filesystem::path& folder) {
  TROCAR_TRY_STATUS(write_file_atomically(folder / "paths.csv", csv_of(study, tissues)));
  std::vector<std::size_t> order(study.errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return study.errors[a].max_n < study.errors[b].max_n; });
  TROCAR_TRY_STATUS(write_curves(curves_on(study, order.back(), tissues, "worst"), tissues, folder));
  TROCAR_TRY_STATUS(write_curves(curves_on(study, order[order.size() / 2], tissues, "median"), tissues, folder));
  return write_curves(curves_on(study, order.front(), tissues, "best"), tissues, folder);
}

}  // namespace

Result<std::vector<CaseResult>> run_paths_benchmark(const Options& options) {
  cases::CaseOptions case_options;
  case_options.task = options.task;
  TROCAR_TRY(const cases::Case tables, cases::load_tables(case_options));
  TROCAR_TRY(const auto patient, patient_of(options));
  const haptics::NeedleGeometry needle = cases::needle_geometry(tables.needle);
  haptics::HapticOptions haptic;
  haptic.force_model = options.force_model.value_or(kModel);
  haptic.has_weight_compensation = false;
  haptic.seed = options.seed;
  Study study;
  TROCAR_TRY(study.full, haptics::make_haptic_scene(patient, tables.tissues, needle, {}, haptic));
  TROCAR_TRY(anatomy::VirtualPatient partly,
             cases::partly_segmented(*patient, cases::kPartlySegmented,
                                     options.is_unlabelled ? cases::Rest::kUnlabelled : cases::Rest::kFound));
  const auto less = std::make_shared<const anatomy::VirtualPatient>(std::move(partly));
  TROCAR_TRY(study.partly, haptics::make_haptic_scene(less, tables.tissues, needle, {}, haptic));
  TROCAR_TRY(study.motions, plan_motions(tables, *patient, options));

  const auto start = std::chrono::steady_clock::now();
  study.errors = cases::compare_forces(*study.full, *study.partly, study.motions, options.progress);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;

  const std::string what = fmt::format(
      "{} paths of {}, {} model, {} labels of {} in the full patient", study.errors.size(), patient->name,
      to_string(haptic.force_model), less->label_table.labels.size(), patient->label_table.labels.size(), took.count());
  std::vector<CaseResult> results = results_of(study.errors, what, tables.tissues, took.count());
  add_worst_places(results, study.errors, tables.tissues);
  if (options.out.empty()) return results;
  TROCAR_TRY_STATUS(write_folder_atomically(
      options.out, [&](const std::filesystem::path& folder) { return write_study(study, tables.tissues, folder); }));
  return results;
}

}  // namespace trocar::bench
