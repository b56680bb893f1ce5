// trocar patient variants: generates many bodies of the whole range, and checks each of them.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/commands.h"
#include "cli/output.h"
#include "config/json.h"
#include "core/files/folders.h"
#include "phantom/consistency.h"
#include "phantom/phantom.h"
#include "tasks/assess_path.h"

namespace trocar::cli {
namespace {

struct VariantsArguments {
  std::uint64_t first = 1;
  std::int64_t count = 200;
  double voxel_mm = 2.0;
  bool is_json = false;
};

/// The faults of one body: contradictions in it, or its task cannot be performed.
Result<std::vector<std::string>> faults_of(const anatomy::VirtualPatient& patient, const tasks::Task& task,
                                           const tasks::Needle& needle) {
  std::vector<std::string> faults = phantom::find_contradictions(patient);
  const tasks::TaskReadiness readiness = tasks::check_task(task, patient);
  if (!readiness.is_possible)
    for (const std::string& reason : readiness.reasons) faults.push_back(reason);
  for (const anatomy::NeedlePath& path : patient.paths) {
    const tasks::PathAssessment assessment = tasks::assess_path(task, patient, needle, path.line_P);
    for (const tasks::PathFinding& finding : assessment.findings)
      if (finding.fault == tasks::PathFault::kTooLong || finding.fault == tasks::PathFault::kGlancing ||
          finding.fault == tasks::PathFault::kOutOfReach)
        faults.push_back(fmt::format("{}: {}", path.name, finding.text));
  }
  if (patient.paths.empty()) faults.push_back("there is no expert path");
  return faults;
}

Result<std::vector<std::string>> check_seed(std::uint64_t seed, double voxel_mm, const std::string& task_name) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const tasks::Task task, tasks::load_task(data / "tasks", task_name));
  TROCAR_TRY(const std::vector<tasks::Needle> all, tasks::load_needles(data / "needles.toml"));
  const std::vector<tasks::Needle> needles = tasks::needles_like(all, task.needle);
  if (needles.empty()) return fail("there is no needle " + task.needle, "needles.toml", "correct the task");
  const tasks::Needle& needle =  // a thick wall takes the longest one
      *std::max_element(needles.begin(), needles.end(),
                        [](const tasks::Needle& a, const tasks::Needle& b) { return a.length_mm < b.length_mm; });
  const auto patient = phantom::generate_phantom(phantom::kVariantPatient, seed, {{0, 0, 0}, voxel_mm});
  if (!patient) return std::vector<std::string>{patient.error().text()};
  return faults_of(*patient, task, needle);
}

Status check_variants(const VariantsArguments& arguments) {
  config::Json failures = config::Json::array();
  {
    const ProgressPrinter printer;
    const Progress progress = printer.callback();
    for (std::int64_t n = 0; n < arguments.count; ++n) {
      const std::uint64_t seed = arguments.first + static_cast<std::uint64_t>(n);
      core::report(progress, fmt::format("seed {}", seed),
                   static_cast<double>(n) / static_cast<double>(arguments.count));
      const std::string task = phantom::variant_task(seed);
      TROCAR_TRY(const std::vector<std::string> faults, check_seed(seed, arguments.voxel_mm, task));
      if (!faults.empty()) failures.push_back({{"seed", seed}, {"task", task}, {"faults", faults}});
    }
  }
  if (arguments.is_json) {
    print_json({{"first", arguments.first}, {"count", arguments.count}, {"failures", failures}});
  } else {
    for (const config::Json& failure : failures)
      for (const config::Json& fault : failure["faults"])
        fmt::print("seed {:<6} {:<18} {}\n", failure["seed"].get<std::uint64_t>(), failure["task"].get<std::string>(),
                   fault.get<std::string>());
    fmt::print("{} of {} bodies are sound and serve their task\n",
               arguments.count - static_cast<std::int64_t>(failures.size()), arguments.count);
  }
  if (failures.empty()) return {};
  return fail(fmt::format("{} of {} bodies have faults", failures.size(), arguments.count), "variants",
              "see the list; trocar patient generate variant --seed N writes one of them");
}

}  // namespace

void add_patient_variants_command(Command& patient, Action& action) {
  Command variants = patient.add_command(
      "variants", "Generate many procedural bodies and check that each is sound and serves its task");
  variants.footer("Example:\n  trocar patient variants --seed 1 --count 200\n");
  const auto v = std::make_shared<VariantsArguments>();
  variants.add_option("--seed", v->first, "First seed").seed().show_default();
  variants.add_option("--count", v->count, "Number of seeds").whole_number_within(1, 100000).show_default();
  variants.add_option("--voxel-mm", v->voxel_mm, "Edge of the voxels").number_within(0.5, 10.0, "mm").show_default();
  variants.add_flag("--json", v->is_json, "Print one JSON object");
  variants.when_parsed([&action, v] { action = [v] { return check_variants(*v); }; });
}

}  // namespace trocar::cli
