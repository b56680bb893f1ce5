// The expert of every task with each structure on the way to the target. docs/validation.md, Harm.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "anatomy/structure_words.h"
#include "attempt/offline/run_session.h"
#include "bench/benchmarks.h"
#include "cases/open_case.h"
#include "core/files/folders.h"
#include "io/patient/patient_cache.h"
#include "phantom/phantom.h"

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

Result<std::shared_ptr<const cases::OpenCase>> open_harm_case(const std::string& task, const std::string& patient) {
  cases::CaseChoice choice;
  choice.options.task = task;
  choice.patient_source = patient;
  return cases::make_open_case(choice, {nullptr, io::patient_cache_folder()});
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

/// Adds a row for each structure: the score of the attempt that goes through it.
Status add_structures(const char* task, const char* name, const Options& options, std::vector<CaseResult>& results) {
  TROCAR_TRY(const auto open, open_harm_case(task, name));
  const cases::Case& the_case = open->the_case;
  for (const anatomy::Label* label : harmed_labels(the_case)) {
    TROCAR_TRY(const scoring::Outcome outcome, go_through(the_case, *label, name));
    const tasks::Harm grade = tasks::find_harm(the_case.task, *label).grade;
    const bool is_sum_enough = outcome.target_reached && outcome.score >= the_case.task.pass_mark;
    const std::string words = anatomy::structure_words(label->name);
    results.push_back({fmt::format("harm/{}/{}", task, words),
                       "points",
                       figure_of(outcome.score),
                       {},
                       fmt::format("{}; {}", to_string(grade), verdict_of(outcome)),
                       {{"grade", static_cast<double>(grade)},
                        {"by_sum", is_sum_enough ? 1.0 : 0.0},
                        {"passed", outcome.is_passed ? 1.0 : 0.0}}});
    results.back().is_missed = grade == tasks::Harm::kCritical && outcome.is_passed;
    core::report(options.progress, fmt::format("{}: {}", task, words), 0.0);
  }
  return {};
}

/// Attempts of an operator on all embedded patients with a difficulty.
Result<CaseResult> good_attempts(const std::string& operator_name, const Options& options) {
  double passed = 0.0, all = 0.0, harmed = 0.0;
  std::string failed;
  for (const phantom::PhantomInfo& info : phantom::embedded_patients()) {
    if (info.difficulty == 0) continue;
    for (const std::string& task : info.tasks) {
      TROCAR_TRY(const auto open, open_harm_case(task, info.name));
      const TemporaryFolder folder;
      attempt::RunOptions run;
      run.operator_name = operator_name;
      run.patient_source = info.name;
      run.session = folder / "good.session";
      TROCAR_TRY(const attempt::RunResult result, attempt::run_session(open->the_case, run));
      const scoring::Outcome& outcome = result.outcome;
      passed += outcome.is_passed ? 1.0 : 0.0;
      harmed += outcome.harms.empty() ? 0.0 : 1.0;
      all += 1.0;
      if (!outcome.is_passed) failed += fmt::format("; {}: {}", info.name, verdict_of(outcome));
      core::report(options.progress, info.name, 0.0);
    }
  }
  return CaseResult{"harm/good/" + operator_name,
                    "",
                    figure_of(passed),
                    {},
                    fmt::format("of {:.0f} attempts passed{}", all, failed),
                    {{"all", all}, {"harmed", harmed}}};
}

}  // namespace

Result<std::vector<CaseResult>> run_harm_benchmark(const Options& options) {
  std::vector<CaseResult> results;
  for (const auto& [task, name] : kHarmCases) TROCAR_TRY_STATUS(add_structures(task, name, options, results));
  for (const char* const operator_name : {"expert", "novice:0.1"}) {
    TROCAR_TRY(CaseResult good, good_attempts(operator_name, options));
    results.push_back(std::move(good));
  }
  return results;
}

}  // namespace trocar::bench
