// The expert of every task with each structure on the way to the target. docs/validation.md, Harm.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "anatomy/structure_words.h"
#include "attempt/offline/run_session.h"
#include "bench/benchmarks.h"
#include "cases/open_case.h"
#include "core/files/temporary_folder.h"
#include "io/patient/open_patient.h"
#include "io/patient/patient_cache.h"

namespace trocar::bench {
namespace {

constexpr std::pair<const char*, const char*> kHarmCases[] = {{"liver-biopsy", "biopsy-1"},
                                                              {"lumbar-puncture", "lumbar-1"},
                                                              {"ascites-puncture", "ascites-1"},
                                                              {"ptcd", "ptcd-1"}};
constexpr double kBall_mm = 8.0;           // radius of the structure on the way
constexpr double kBeforeTarget_mm = 15.0;  // from its middle to the target at least

/// The patient with a ball of a label on the planned path, half way to the target; target and skin stay.
std::shared_ptr<const anatomy::VirtualPatient> with_structure_on_the_way(const cases::Case& the_case,
                                                                         const anatomy::Label& label) {
  auto changed = std::make_shared<anatomy::VirtualPatient>(*the_case.patient);
  const Segment& path_P = the_case.plan.line_P;
  const double length_mm = path_P.length_mm();
  const Vec3 middle_P = path_P.a + std::min(0.5 * length_mm, length_mm - kBeforeTarget_mm) * path_P.direction();
  volume::LabelGrid& labels = changed->labels;
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if ((labels.geometry.centre_mm(labels.geometry.index_of(n)) - middle_P).squaredNorm() > kBall_mm * kBall_mm)
      continue;
    const anatomy::Label* const old = changed->label_table.find(labels.voxels[n]);
    if (old == nullptr || !tasks::is_target(the_case.task, *old)) labels.voxels[n] = label.id;
  }
  return changed;
}

/// Labels that a needle harms and bone, which stops it, left out; of paired and numbered ones the first.
std::vector<const anatomy::Label*> harmed_labels(const cases::Case& the_case) {
  std::set<std::string> seen;
  std::vector<const anatomy::Label*> labels;
  for (const anatomy::Label& label : the_case.patient->label_table.labels) {
    if (tasks::find_harm(the_case.task, label).grade == tasks::Harm::kNone) continue;
    std::string kind = anatomy::without_side(anatomy::plain_name(label.name));
    while (!kind.empty() && kind.back() >= '0' && kind.back() <= '9') kind.pop_back();
    if (label.tissue == "bone") continue;
    if (seen.insert(kind).second) labels.push_back(&label);
  }
  return labels;
}

Result<scoring::Outcome> go_through(const cases::Case& the_case, const anatomy::Label& label,
                                    const std::string& patient) {
  cases::Case blocked = the_case;
  blocked.patient = with_structure_on_the_way(the_case, label);
  const TemporaryFolder folder;
  attempt::RunOptions run;
  run.operator_name = "expert";
  run.patient_source = patient;
  run.session = folder / "through.session";
  TROCAR_TRY(attempt::RunResult result, attempt::run_session(blocked, run));
  return std::move(result.outcome);
}

std::string verdict_of(const scoring::Outcome& outcome) {
  if (outcome.is_passed) return "passed";
  return fmt::format("not passed: {}", outcome.fails.empty() ? outcome.not_scored : outcome.fails.front());
}

}  // namespace

Result<std::vector<CaseResult>> run_harm_benchmark(const Options& options) {
  std::vector<CaseResult> results;
  for (const auto& [task, name] : kHarmCases) {
    cases::CaseChoice choice;
    choice.options.task = task;
    choice.patient_source = name;
    TROCAR_TRY(const auto open, cases::make_open_case(choice, {nullptr, io::patient_cache_folder()}));
    const cases::Case& the_case = open->the_case;
    double critical = 0.0, by_sum = 0.0, passed = 0.0;
    for (const anatomy::Label* label : harmed_labels(the_case)) {
      TROCAR_TRY(const scoring::Outcome outcome, go_through(the_case, *label, name));
      const tasks::Harm grade = tasks::find_harm(the_case.task, *label).grade;
      const bool is_sum_enough = outcome.target_reached && outcome.score >= the_case.task.pass_mark;
      if (grade == tasks::Harm::kCritical) {
        critical += 1.0;
        by_sum += is_sum_enough ? 1.0 : 0.0;
        passed += outcome.is_passed ? 1.0 : 0.0;
      }
      if (options.print)
        options.print(fmt::format("{:<17} {:<26} {:<9} {:>5.1f} {:<10}  {}\n", task,
                                  anatomy::structure_words(label->name), to_string(grade), outcome.score,
                                  is_sum_enough ? "passed" : "not passed", verdict_of(outcome)));
    }
    const auto add = [&](const char* what, double count, const char* note) {
      results.push_back({fmt::format("harm/{}/{}", task, what), "", figure_of(count), {}, note});
    };
    add("critical", critical, "structures with critical harm on the way to the target");
    add("by-sum", by_sum, "of them passed by the score alone");
    add("passed", passed, "of them passed");
  }
  return results;
}

}  // namespace trocar::bench
