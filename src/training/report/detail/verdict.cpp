#include "report/detail/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "report/detail/html.h"
#include "tasks/active_time.h"

namespace trocar::report::detail {
namespace {

constexpr Verdict kPassed{"Passed", "passed", "M24 52 L42 70 L76 32"};
constexpr Verdict kNotPassed{"Not passed", "failed", "M30 30 L70 70 M70 30 L30 70"};
constexpr Verdict kNoVerdict{"No verdict", "unjudged", "M50 26 L50 56 M50 70 L50 72"};

bool has_verdict(const scoring::Outcome& outcome) {
  return outcome.is_passed || !outcome.is_scored() || !outcome.fails.empty();
}

}  // namespace

Verdict verdict_of(const scoring::Outcome& outcome) {
  if (outcome.is_passed) return kPassed;
  return has_verdict(outcome) ? kNotPassed : kNoVerdict;
}

std::vector<std::string> reasons_of(const scoring::Outcome& outcome) {
  std::vector<std::string> reasons;
  if (!outcome.is_scored()) reasons.push_back("not scored, " + outcome.not_scored);
  reasons.insert(reasons.end(), outcome.fails.begin(), outcome.fails.end());
  if (!has_verdict(outcome))
    reasons.emplace_back("the session is of an older program, which did not judge whether an attempt passes");
  return reasons;
}

std::string Interruptions::many_text() const {
  if (listed.size() == noticed) return {};
  return fmt::format("{}, {} s in total; the longest ones follow", noticed, number_text(noticed_s, 2));
}

std::string Interruptions::short_text() const {
  return fmt::format("{} interruption{} shorter than {:g} s, {:.2f} s in total", short_ones, short_ones == 1 ? "" : "s",
                     tasks::kNoticedInterruption_s, short_s);
}

Interruptions interruptions_of(const storage::Session& session) {
  Interruptions all;
  for (const tasks::Interruption& gap : session.interruptions) {
    const double length_s = gap.to_s - gap.from_s;
    if (length_s < tasks::kNoticedInterruption_s) {
      ++all.short_ones;
      all.short_s += length_s;
    } else {
      ++all.noticed;
      all.noticed_s += length_s;
      all.listed.push_back(gap);
    }
  }
  constexpr std::size_t kMostListed = 5;
  if (all.listed.size() <= kMostListed) return all;
  std::ranges::stable_sort(all.listed, std::greater(), [](const auto& gap) { return gap.to_s - gap.from_s; });
  all.listed.resize(kMostListed);
  std::ranges::sort(all.listed, {}, &tasks::Interruption::from_s);
  return all;
}

}  // namespace trocar::report::detail
