// How much it matters that only some structures are segmented: forces of the same poses on fully and on partly
// segmented data (the study of the Luebeck group, references.md).

#include <fmt/format.h>

#include <chrono>

#include "anatomy/phantom/phantom.h"
#include "bench/benchmarks.h"
#include "headless/needle_geometry.h"
#include "headless/prepare_case.h"
#include "headless/segmentation_study.h"

namespace trocar::bench {
namespace {

constexpr int kMostPlanned = 100000;     ///< All that plan_paths gives; the study's paths are spread over them.
constexpr std::size_t kWorstPlaces = 8;  ///< In the table.
constexpr ForceModel kModel = ForceModel::kProxy;  ///< Of the study.

Result<std::shared_ptr<const VirtualPatient>> patient_of(const Options& options) {
  if (options.patient) return options.patient;
  TROCAR_TRY(VirtualPatient generated, generate_phantom("abdomen", 1, {}, options.progress));
  return std::make_shared<const VirtualPatient>(std::move(generated));
}

Result<std::vector<PrescribedMotion>> plan_motions(const Case& tables, const VirtualPatient& patient,
                                                   const Options& options) {
  TROCAR_TRY(const auto planned,
             plan_paths(tables.task, patient, tables.needle, {kMostPlanned, options.seed}, options.progress));
  StudyMotion study;
  study.seed = options.seed;
  std::vector<PrescribedMotion> motions;
  for (const std::size_t i : spread_choice(planned.size(), static_cast<std::size_t>(options.paths), options.seed))
    motions.push_back(study_motion(planned[i].line_P, i, study));
  return motions;
}

Figures over_paths(const std::vector<PathError>& errors, double PathError::*value) {
  std::vector<double> values;
  for (const PathError& error : errors) values.push_back(error.*value);
  return figures_of(std::move(values));
}

Figures single(double value) {
  Figures figures;
  figures.median = value;
  return figures;
}

std::vector<CaseResult> results_of(const std::vector<PathError>& errors, const std::string& what, double took_s) {
  const StudyFigures figures = study_figures(errors);
  Figures max = over_paths(errors, &PathError::max_n);
  return {{"paths/mean-rms", "n", single(figures.mean_rms_n), {}, "mean over paths; published 0.12; " + what},
          {"paths/rms", "n", over_paths(errors, &PathError::rms_n), {}, "over paths"},
          {"paths/mean-max", "n", single(figures.mean_max_n), {}, "mean over paths of the largest error of each"},
          {"paths/max", "n", max, {}, "over paths, of the largest error of each; published max 1.6"},
          {"paths/affected",
           "ratio",
           single(figures.affected),
           {},
           fmt::format("of all ticks behind the skin: off by more than {} N and {:.0f} %; published 0.12", kAffected_n,
                       100.0 * kAffectedShare)},
          {"paths/torque-rms",
           "nmm",
           over_paths(errors, &PathError::torque_rms_nmm),
           {},
           fmt::format("over paths; mean {:.2f}", figures.mean_torque_rms_nmm)},
          {"paths/torque-max", "nmm", over_paths(errors, &PathError::torque_max_nmm), {}, "over paths"},
          {"paths/force-rms",
           "n",
           over_paths(errors, &PathError::full_rms_n),
           {},
           "the fully segmented force itself, to hold the errors against"},
          {"paths/time", "ms", single(1e3 * took_s), {}, "both forces on all paths, planning not counted"}};
}

void add_worst_places(std::vector<CaseResult>& results, const std::vector<PathError>& errors,
                      const TissueTable& tissues) {
  const auto places = worst_places(errors, tissues);
  for (std::size_t i = 0; i < std::min(places.size(), kWorstPlaces); ++i) {
    Figures figures = single(places[i].mean_max_n);
    figures.max = places[i].max_n;
    results.push_back({"paths/worst/" + places[i].place,
                       "n",
                       figures,
                       {},
                       fmt::format("largest error of {} paths; mean and max", places[i].paths)});
  }
}

}  // namespace

Result<std::vector<CaseResult>> run_paths_benchmark(const Options& options) {
  CaseOptions case_options;
  case_options.task = options.task;
  TROCAR_TRY(const Case tables, load_tables(case_options));
  TROCAR_TRY(const auto patient, patient_of(options));
  const NeedleGeometry needle = needle_geometry(tables.needle);
  HapticOptions haptic;
  haptic.force_model = options.force_model.value_or(kModel);
  haptic.has_weight_compensation = false;
  haptic.seed = options.seed;
  TROCAR_TRY(const auto full, make_haptic_scene(patient, tables.tissues, needle, {}, haptic));
  const auto less = std::make_shared<const VirtualPatient>(partly_segmented(*patient, kPartlySegmented));
  TROCAR_TRY(const auto partly, make_haptic_scene(less, tables.tissues, needle, {}, haptic));
  TROCAR_TRY(const auto motions, plan_motions(tables, *patient, options));

  const auto start = std::chrono::steady_clock::now();
  const std::vector<PathError> errors = compare_forces(*full, *partly, motions, options.progress);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;

  const std::string what = fmt::format("{} paths of {}, {} model, {} of {} labels kept", errors.size(), patient->name,
                                       to_string(haptic.force_model), less->label_table.labels.size(),
                                       patient->label_table.labels.size(), took.count());
  std::vector<CaseResult> results = results_of(errors, what, took.count());
  add_worst_places(results, errors, tables.tissues);
  return results;
}

}  // namespace trocar::bench
