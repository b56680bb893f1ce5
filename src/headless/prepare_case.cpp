#include "headless/prepare_case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/data_dir.h"
#include "core/log.h"

namespace trocar {

Result<Case> load_tables(const CaseOptions& options) {
  const std::filesystem::path data = data_dir();
  if (data.empty()) return fail("the data folder was not found", "", "set TROCAR_DATA_DIR to it");
  Case made;
  TROCAR_TRY(made.task, load_task(data / "tasks", options.task));
  const std::string needle = options.needle.empty() ? made.task.needle : options.needle;
  TROCAR_TRY(made.needle, load_needle(data / "needles.toml", needle));
  const std::filesystem::path tissues =
      options.tissue_file.empty() ? data / "tissues.toml" : std::filesystem::path(options.tissue_file);
  TROCAR_TRY(made.tissues, load_tissue_table(tissues, options.profile));
  for (const std::string& assignment : options.overrides) TROCAR_TRY_STATUS(apply_override(made.tissues, assignment));
  return made;
}

Result<Case> prepare_case(std::shared_ptr<const VirtualPatient> patient, const CaseOptions& options,
                          const Progress& progress) {
  TROCAR_TRY(Case made, load_tables(options));
  const TaskReadiness readiness = check_task(made.task, *patient);
  if (!readiness.is_possible)
    return fail(
        fmt::format("the patient cannot serve the task {}: {}", made.task.name, fmt::join(readiness.reasons, "; ")),
        patient->name, "see trocar patient check");
  made.is_parenchymal = readiness.is_parenchymal;
  TROCAR_TRY(const auto paths, plan_paths(made.task, *patient, made.needle, {1, options.seed}, progress));
  made.plan = paths.front();
  log_info("planned path: {:.1f} mm, {:.1f} mm of it in the organ, {:.1f} mm to spare from {}", made.plan.length_mm,
           made.plan.organ_path_mm, made.plan.smallest_margin_mm, made.plan.nearest_risk);
  made.patient = std::move(patient);
  return made;
}

}  // namespace trocar
