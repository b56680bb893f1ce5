#include "report/detail/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/detail/html.h"
#include "report/detail/sections.h"
#include "tasks/action.h"

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

namespace {

constexpr double kLowShare = 0.5;  ///< Share of a part's points below which the bar is drawn as weak.

/// A number with at most one decimal, none for integers.
std::string short_number(double value) {
  const bool is_whole = std::abs(value - std::round(value)) < 0.05;
  return number_text(value, is_whole ? 0 : 1);
}

std::string score_ring(double score) {
  constexpr double kRadius = 70.0;
  const double around = 2.0 * 3.14159265358979 * kRadius;
  const double share = std::isfinite(score) ? std::clamp(score / 100.0, 0.0, 1.0) : 0.0;
  return fmt::format(
      "<svg viewBox=\"0 0 172 172\" role=\"img\" aria-label=\"Score {0} of 100\">"
      "<circle cx=\"86\" cy=\"86\" r=\"{1}\" fill=\"none\" stroke=\"#dfe6ea\" stroke-width=\"15\"/>"
      "<circle cx=\"86\" cy=\"86\" r=\"{1}\" fill=\"none\" stroke=\"#0b6e75\" stroke-width=\"15\" "
      "stroke-dasharray=\"{2:.1f} {3:.1f}\" transform=\"rotate(-90 86 86)\"/>"
      "<text x=\"86\" y=\"98\" text-anchor=\"middle\" font-size=\"46\" font-weight=\"650\">{0}</text>"
      "<text x=\"86\" y=\"120\" text-anchor=\"middle\" font-size=\"14\" fill=\"#5a6875\">of 100</text></svg>",
      number_text(score, 0), kRadius, share * around, around);
}

std::string part_row(const scoring::ScorePart& part) {
  if (scoring::is_deduction(part))
    return fmt::format("<tr><td>{}</td><td></td><td></td><td class=\"number\"><b>{}</b></td></tr>", escape(part.title),
                       number_text(part.points, std::abs(part.points - std::round(part.points)) < 0.05 ? 0 : 1));
  const double share =
      part.max_points > 0.0 && std::isfinite(part.points) ? std::clamp(part.points / part.max_points, 0.0, 1.0) : 0.0;
  return fmt::format(
      "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"bar\"><div class=\"track\"><div class=\"fill{}\" "
      "style=\"width:{:.1f}%\"></div></div></td><td class=\"number\"><b>{}</b> / {}</td></tr>",
      escape(part.title), escape(scoring::part_value_text(part)), share < kLowShare ? " low" : "", 100.0 * share,
      short_number(part.points), short_number(part.max_points));
}

std::string icon_svg(const Verdict& verdict) {
  return fmt::format(
      "<svg class=\"icon\" viewBox=\"0 0 100 100\" aria-hidden=\"true\"><circle cx=\"50\" cy=\"50\" r=\"46\" "
      "fill=\"currentColor\"/><path d=\"{}\" fill=\"none\" stroke=\"#ffffff\" stroke-width=\"12\" "
      "stroke-linecap=\"round\" stroke-linejoin=\"round\"/></svg>",
      verdict.icon);
}

std::string reasons_list(const scoring::Outcome& outcome) {
  const std::vector<std::string> reasons = reasons_of(outcome);
  if (reasons.empty()) return {};
  std::string list = "<ul class=\"reasons\">";
  for (const std::string& reason : reasons) list += "<li>" + escape(capitalised(reason)) + "</li>";
  return list + "</ul>";
}

/// "83 of 100 points, target reached, level Exam".
std::string verdict_facts(const storage::Session& session) {
  const scoring::Outcome& outcome = *session.outcome;
  std::string facts;
  if (outcome.is_scored())
    facts = fmt::format("{} of 100 points, target {}", number_text(outcome.score, 0), scoring::target_words(outcome));
  if (!session.info.level.empty())
    facts += (facts.empty() ? "Level " : ", level ") + escape(title_words(session.info.level));
  return facts;
}

/// Lists the damaged parts, which are missing; empty if there is no damage.
std::string damage_note(const storage::Session& session) {
  if (session.damage.empty()) return {};
  std::string parts;
  for (const storage::SessionDamage& damage : session.damage)
    parts += (parts.empty() ? "" : ", ") + escape(damage.part);
  return "<p class=\"warning\"><b>This session is damaged.</b> Missing: " + parts + ".</p>";
}

/// "the needle went 12 mm into the heart (blood fills the pericardium and stops the heart)".
std::string harm_text(const metrics::HarmEvent& event) {
  return metrics::harm_words(event) + (event.reason.empty() ? "" : " (" + event.reason + ")");
}

std::string hint_text(const scoring::Hint& hint) {
  const std::string when =
      hint.at_s ? fmt::format(" <span class=\"when\">at {} s</span>", number_text(*hint.at_s, 1)) : std::string();
  return escape(hint.text) + when;
}

}  // namespace

std::string verdict_section(const storage::Session& session) {
  if (!session.outcome && !session.damage.empty()) return damage_note(session);
  if (!session.outcome)
    return "<p class=\"warning\"><b>This session is incomplete.</b> The program ended during the attempt: there is no "
           "score. The recorded ticks are shown below.</p>";
  const scoring::Outcome& outcome = *session.outcome;
  const Verdict verdict = verdict_of(outcome);
  std::string out = damage_note(session);
  for (const metrics::HarmEvent& event : outcome.harms)
    if (event.grade >= tasks::Harm::kMajor)
      out += fmt::format("<p class=\"harm\">\u26a0 {} harm: {}</p>", capitalised(to_string(event.grade)),
                         escape(harm_text(event)));
  out += fmt::format("<section class=\"verdict {} together\">{}<div><h2>{}</h2><p>{}</p>{}</div></section>",
                     verdict.style, icon_svg(verdict), verdict.word, verdict_facts(session), reasons_list(outcome));
  if (outcome.harms.empty() && !outcome.risks_touched.empty())  // of an older program
    out += fmt::format("<p class=\"warning\">Structures at risk touched: <b>{}</b>.</p>",
                       joined_words(outcome.risks_touched));
  for (const metrics::HarmEvent& event : outcome.harms)
    if (event.grade < tasks::Harm::kMajor)
      out += fmt::format("<p class=\"warning\">{}.</p>", escape(capitalised(harm_text(event))));
  return out;
}

std::string advice_section(const storage::Session& session) {
  if (!session.outcome || session.outcome->hints.empty()) return {};
  const std::vector<scoring::Hint>& hints = session.outcome->hints;
  std::string out = fmt::format("<section class=\"together\"><h2>{}</h2><p class=\"first-hint\">",
                                is_praise(hints.front()) ? "Advice" : "Improve this first") +
                    hint_text(hints.front()) + "</p>";
  if (hints.size() > 1) {
    out += "<h3>Then</h3><ol class=\"hints\" start=\"2\">";
    for (std::size_t n = 1; n < hints.size(); ++n) out += "<li>" + hint_text(hints[n]) + "</li>";
    out += "</ol>";
  }
  return out + "</section>";
}

std::string score_section(const storage::Session& session) {
  if (!session.outcome || !session.outcome->is_scored()) return {};
  const scoring::Outcome& outcome = *session.outcome;
  std::string out = fmt::format(
      "<section class=\"together\"><h2>Score</h2><div class=\"result\"><div class=\"ring\">{}</div>"
      "<table class=\"parts\"><tbody>",
      score_ring(outcome.score));
  for (const scoring::ScorePart& part : outcome.parts) out += part_row(part);
  return out + "</tbody></table></div></section>";
}

std::string steps_section(const storage::Session& session, const ReportStory& story) {
  if (story.steps.empty()) return {};
  std::string out =
      "<section class=\"together\"><h2>Steps</h2><table class=\"list steps\"><thead><tr><th>Step</th><th>Begun</th>"
      "<th>Done</th><th>Took</th></tr></thead><tbody>";
  const auto time = [](const std::optional<double>& time_s, const char* otherwise) {
    return time_s ? number_text(*time_s, 1) + " s" : std::string(otherwise);
  };
  for (std::size_t n = 0; n < story.steps.size(); ++n) {
    const StepTime& step = story.steps[n];
    std::optional<double> took_s;
    if (step.begun_s && step.done_s) took_s = *step.done_s - *step.begun_s;
    out += fmt::format("<tr{}><td>{}. {}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                       step.done_s ? "" : " class=\"undone\"", n + 1, escape(step.title),
                       time(step.begun_s, "not begun"), time(step.done_s, "not done"), time(took_s, "\u2013"));
  }
  out +=
      "</tbody></table><p class=\"note\">A step begins when the steps before it are done, and is done when all that it "
      "asks for held at the same time.";
  const bool is_all_done =
      std::ranges::all_of(story.steps, [](const StepTime& step) { return step.done_s.has_value(); });
  if (story.needs_image && session.transducer.empty() && !is_all_done)
    out += " No transducer was recorded: a step that needs its image, and those after it, cannot be done.";
  return out + "</p></section>";
}

std::string actions_section(const ReportStory& story) {
  if (story.actions.empty()) return {};
  std::string out =
      "<section class=\"together\"><h2>Actions</h2><table class=\"list actions\"><thead><tr><th>Time</th><th>Depth</th>"
      "<th>Action</th></tr></thead><tbody>";
  for (const ActionLine& action : story.actions)
    out += fmt::format("<tr><td>{} s</td><td>{} mm</td><td>{}</td></tr>", number_text(action.time_s, 1),
                       number_text(action.depth_mm, 1), escape(capitalised(action.text)));
  return out + "</tbody></table></section>";
}

}  // namespace trocar::report::detail
