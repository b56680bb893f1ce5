// A cohort of scripted novices: their scores, and the effect of the path constraint on their hands. docs/validation.md,
// The novice cohort.

#include <fmt/format.h>

#include <algorithm>

#include "attempt/offline/run_session.h"
#include "bench/benchmarks.h"
#include "bench/real_data.h"
#include "core/files/folders.h"
#include "io/patient/build_from_files.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {
namespace fs = std::filesystem;

constexpr int kNovices = 40;

struct CohortPatient {
  std::string name;
  std::shared_ptr<const anatomy::VirtualPatient> patient;
};

/// Effect of the path constraint in one attempt.
struct ConstraintFigures {
  double inward_n = 0.0;   ///< Largest component along the needle's axis into the body.
  double step_n = 0.0;     ///< Largest change from one tick to the next.
  double largest_n = 0.0;  ///< Largest force.
};

ConstraintFigures constraint_figures(const std::vector<telemetry::TickSample>& samples) {
  ConstraintFigures figures;
  Vec3 before_n = Vec3::Zero();
  for (const telemetry::TickSample& sample : samples) {
    figures.inward_n = std::max(figures.inward_n, sample.f_constraint_n.dot(sample.axis));
    figures.step_n = std::max(figures.step_n, (sample.f_constraint_n - before_n).norm());
    figures.largest_n = std::max(figures.largest_n, sample.f_constraint_n.norm());
    before_n = sample.f_constraint_n;
  }
  return figures;
}

Result<CohortPatient> build(const io::PatientFiles& files, const Options& options) {
  std::vector<std::string> warnings;
  TROCAR_TRY(anatomy::VirtualPatient patient, io::build_from_files(files, warnings, options.progress));
  return CohortPatient{files.name, std::make_shared<const anatomy::VirtualPatient>(std::move(patient))};
}

/// Adds the available patients of real CTs and prints the missing ones.
Status add_real_patients(std::vector<CohortPatient>& patients, const Options& options) {
  const auto say_missing = [&](const fs::path& path) {
    if (options.print) options.print(fmt::format("left out, there is no {}\n", path.string()));
  };
  io::PatientFiles files;
  const fs::path torso = real_data() / "ct-torso";
  if (fs::exists(torso)) {
    files.ct = torso / "example_ct.nii.gz";
    files.labels = {torso / "example_seg_fast_force_split.nii.gz"};
    files.name = "ct-torso";
    TROCAR_TRY(CohortPatient built, build(files, options));
    patients.push_back(std::move(built));
  } else {
    say_missing(torso);
  }
  const fs::path archive = real_data() / "ct-liver" / "3dircadb1.17_dicom_and_masks.tar.xz";
  if (!fs::exists(archive)) {
    say_missing(archive);
    return {};
  }
  const TemporaryFolder folder;
  TROCAR_TRY_STATUS(run_quietly({"tar", "-xJf", archive.string(), "-C", folder.path().string()}));
  files.ct = folder / "PATIENT_DICOM";
  files.labels = {folder / "MASKS_DICOM"};
  files.label_map.clear();
  files.name = "ct-liver";
  TROCAR_TRY(CohortPatient built, build(files, options));
  patients.push_back(std::move(built));
  return {};
}

Result<std::vector<CohortPatient>> cohort_patients(const Options& options) {
  if (options.patient) return std::vector<CohortPatient>{{options.patient->name, options.patient}};
  TROCAR_TRY(anatomy::VirtualPatient abdomen, phantom::generate_phantom("abdomen", 1, {}, options.progress));
  std::vector<CohortPatient> patients{{"abdomen", std::make_shared<const anatomy::VirtualPatient>(std::move(abdomen))}};
  TROCAR_TRY_STATUS(add_real_patients(patients, options));
  return patients;
}

/// All novices on one patient: the same plan, seeds 1 to kNovices of operator and friction.
Status add_cohort(std::vector<CaseResult>& results, const CohortPatient& on, const Options& options) {
  TROCAR_TRY(const cases::Case the_case, cases::prepare_case(on.patient, {}, options.progress));
  const TemporaryFolder folder;
  std::vector<double> scores, inward_n, step_n, largest_n;
  int reached = 0;
  for (int seed = 1; seed <= kNovices; ++seed) {
    attempt::RunOptions run;
    run.operator_name = "novice";
    run.seed = static_cast<std::uint64_t>(seed);
    run.session = folder / fmt::format("novice{}.trocar", seed);
    if (options.force_model) run.force_model = to_string(*options.force_model);
    TROCAR_TRY(const attempt::RunResult result, attempt::run_session(the_case, run));
    TROCAR_TRY(const storage::Session session, storage::load_session(run.session));
    fs::remove(run.session);
    const ConstraintFigures figures = constraint_figures(session.samples);
    scores.push_back(result.outcome.score);
    reached += result.outcome.target_reached ? 1 : 0;
    inward_n.push_back(figures.inward_n);
    step_n.push_back(figures.step_n);
    largest_n.push_back(figures.largest_n);
    core::report(options.progress, on.name, static_cast<double>(seed) / kNovices);
  }
  const auto [worst, best] = std::minmax_element(scores.begin(), scores.end());
  double sum = 0.0;
  for (const double score : scores) sum += score;
  const std::string prefix = "cohort/" + on.name;
  results.push_back({prefix + "/score",
                     "points",
                     figures_of(scores),
                     {},
                     fmt::format("mean {:.2f}, {:.1f} to {:.1f}; {} of {} reach the target", sum / kNovices, *worst,
                                 *best, reached, kNovices),
                     {{"mean", sum / kNovices}, {"lowest", *worst}, {"highest", *best}, {"reached", reached}}});
  results.push_back(
      {prefix + "/inward", "n", figures_of(inward_n), {}, "path constraint into the body, most an attempt"});
  results.push_back({prefix + "/step", "n", figures_of(step_n), {}, "path constraint, largest change in a tick"});
  results.push_back({prefix + "/constraint", "n", figures_of(largest_n), {}, "path constraint, most an attempt"});
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_cohort_benchmark(const Options& options) {
  TROCAR_TRY(const auto patients, cohort_patients(options));
  std::vector<CaseResult> results;
  for (const CohortPatient& on : patients) TROCAR_TRY_STATUS(add_cohort(results, on, options));
  return results;
}

}  // namespace trocar::bench
