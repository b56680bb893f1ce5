#include "report/text_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/detail/verdict.h"

namespace trocar::report {
using namespace detail;
namespace {

std::string verdict_text(const storage::Session& session) {
  if (!session.outcome) return "No verdict: the session is incomplete, the program ended during the attempt\n";
  const scoring::Outcome& outcome = *session.outcome;
  const std::vector<std::string> reasons = reasons_of(outcome);
  std::string text =
      fmt::format("{}{}{}\n", verdict_of(outcome).word, reasons.empty() ? "" : ": ", fmt::join(reasons, "; "));
  if (outcome.is_scored())
    text += fmt::format("{:.0f} of 100 points, target {}\n", outcome.score, scoring::target_words(outcome));
  for (std::size_t n = 0; n < outcome.hints.size(); ++n) {
    const scoring::Hint& hint = outcome.hints[n];
    text += fmt::format("{}{}{}\n",
                        is_praise(hint) ? ""
                        : n == 0        ? "improve first: "
                                        : "then: ",
                        hint.text, hint.at_s ? fmt::format(" (at {:.1f} s)", *hint.at_s) : "");
  }
  for (const scoring::ScorePart& part : outcome.parts)
    text += fmt::format("  {:<44} {:>12} {:>6.1f} of {:.1f} points\n", part.title, scoring::part_value_text(part),
                        part.points, part.max_points);
  return text;
}

std::string step_text(const StepTime& step) {
  if (!step.begun_s) return "not counted, a step before it was not done";
  if (!step.done_s) return fmt::format("begun at {:.1f} s, not done", *step.begun_s);
  return fmt::format("begun at {:.1f} s, done at {:.1f} s, took {:.1f} s", *step.begun_s, *step.done_s,
                     *step.done_s - *step.begun_s);
}

}  // namespace

std::string text_report(const storage::Session& session, const ReportStory& story) {
  const storage::SessionInfo& info = session.info;
  std::string text =
      fmt::format("{} on {} by {}, {}{}\n", story.title.empty() ? info.task : story.title, info.patient_name,
                  info.operator_name, info.started_utc, info.level.empty() ? "" : ", level " + info.level);
  text += verdict_text(session);
  if (!story.steps.empty()) text += "steps:\n";
  for (std::size_t n = 0; n < story.steps.size(); ++n)
    text += fmt::format("  {}. {}: {}\n", n + 1, story.steps[n].title, step_text(story.steps[n]));
  if (!story.actions.empty()) text += "actions:\n";
  for (const ActionLine& action : story.actions)
    text += fmt::format("  {:.1f} s, {:.1f} mm deep: {}\n", action.time_s, action.depth_mm, action.text);
  const Interruptions gaps = interruptions_of(session);
  if (const std::string many = gaps.many_text(); !many.empty()) text += "interruptions: " + many + "\n";
  for (const tasks::Interruption& gap : gaps.listed)
    text += fmt::format("interruption at {:.2f} s: {:.2f} s, {}\n", gap.from_s, gap.to_s - gap.from_s, gap.reason);
  if (gaps.short_ones > 0) text += fmt::format("{}\n", gaps.short_text());
  return text;
}

}  // namespace trocar::report
