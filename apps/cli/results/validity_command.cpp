// trocar results validity: evidence that the scores of a task mean something.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "cli/json_parts.h"
#include "cli/results/commands.h"
#include "config/json.h"
#include "core/text.h"
#include "results/attempts.h"
#include "results/validity.h"

namespace trocar::cli {
namespace {

using cohort::Validity;

struct ValidityArguments {
  results::EvidenceFilter filter;
  cohort::ValidityRules rules;
  learning::AttemptCounts counts;  ///< Of all attempts of the filter.
  std::string attempts = "1-3", correction = "bh";
  bool is_json = false;
};

/// "1-3", "4-", "2".
Result<cohort::AttemptRange> parse_attempts(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = parse_number<std::size_t>(text.substr(0, dash));
  auto last = first;
  if (dash != std::string::npos)
    last = dash + 1 == text.size() ? cohort::AttemptRange().last : parse_number<std::size_t>(text.substr(dash + 1));
  if (first && last && *first >= 1 && *last >= *first) return cohort::AttemptRange{*first, *last};
  return fail_usage("\"" + text + "\" is no range of attempts", "--attempts",
                    "write it as 1-3, or 4- for all from the fourth");
}

Result<cohort::Correction> parse_correction(const std::string& name) {
  if (name == "none") return cohort::Correction::kNone;
  if (name == "holm") return cohort::Correction::kHolm;
  if (name == "bh") return cohort::Correction::kBenjaminiHochberg;
  return fail_usage("unknown correction \"" + name + "\"", "--correction", "use bh, holm or none");
}

/// The level of help. `--level 0.05` was the level of significance in older programs.
Status check_level(const std::string& level) {
  if (level.empty() || learning::find_training_mode(level)) return {};
  return fail_usage(fmt::format("unknown level of help \"{}\"", level), "--level",
                    "use guided, assisted or exam; the level of significance is --significance");
}

config::Json metric_json(const cohort::MetricValidity& metric) {
  config::Json json = {{"name", metric.name}, {"title", metric.title}, {"unit", metric.unit}};
  if (!metric.separation) {
    json["reason"] = metric.separation.error().what;
    return json;
  }
  const cohort::Separation& found = *metric.separation;
  json["n_expert"] = found.experts;
  json["n_novice"] = found.novices;
  json["expert_median"] = found.expert_median;
  json["novice_median"] = found.novice_median;
  json["auc"] = found.auc;
  json["low"] = found.auc_interval.low;
  json["high"] = found.auc_interval.high;
  json["p"] = found.test.p;
  json["p_exact"] = found.test.is_exact;
  json["p_corrected"] = metric.corrected_p;
  json["discriminates"] = metric.discriminates;
  return json;
}

config::Json alpha_json(const Result<cohort::Alpha>& alpha) {
  if (!alpha) return {{"value", nullptr}, {"reason", alpha.error().what}};
  return {{"value", alpha->value},
          {"low", alpha->interval.low},
          {"high", alpha->interval.high},
          {"items", alpha->items},
          {"n", alpha->people}};
}

config::Json pass_mark_json(const Result<cohort::PassMark>& mark) {
  if (!mark) return {{"value", nullptr}, {"reason", mark.error().what}};
  return {{"value", mark->value},
          {"false_passes", mark->false_passes},
          {"false_fails", mark->false_fails},
          {"expected_false_pass", mark->expected_false_pass},
          {"expected_false_fail", mark->expected_false_fail},
          {"experts", mark->experts.people},
          {"novices", mark->novices.people}};
}

config::Json validity_json(const Validity& validity, const ValidityArguments& arguments) {
  config::Json metrics = config::Json::array();
  for (const cohort::MetricValidity& metric : validity.metrics) metrics.push_back(metric_json(metric));
  const double share =
      validity.tested > 0 ? static_cast<double>(validity.discriminating) / static_cast<double>(validity.tested) : 0.0;
  return {{"task", arguments.filter.task},
          {"patient", arguments.filter.patient},
          {"level_of_help", arguments.filter.level},
          {"attempts", arguments.attempts},
          {"counts", counts_json(arguments.counts)},
          {"expert_attempts", {{"counted", validity.expert_attempts}, {"without_result", validity.expert_unscored}}},
          {"novice_attempts", {{"counted", validity.novice_attempts}, {"without_result", validity.novice_unscored}}},
          {"experts", validity.experts},
          {"novices", validity.novices},
          {"simulated", validity.simulated > 0},
          {"simulated_people", validity.simulated},
          {"score", metric_json(validity.score)},
          {"passed", metric_json(validity.passes)},
          {"metrics", std::move(metrics)},
          {"significance", arguments.rules.level},
          {"correction", to_string(arguments.rules.correction)},
          {"discriminating",
           {{"share", validity.tested > 0 ? config::Json(share) : config::Json(nullptr)},
            {"count", validity.discriminating},
            {"of", validity.tested},
            {"uncorrected", validity.uncorrected}}},
          {"smallest_p",
           cohort::smallest_p_text(validity.experts, validity.novices, validity.tested, arguments.rules.level)},
          {"alpha", alpha_json(validity.alpha)},
          {"pass_mark", pass_mark_json(validity.pass_mark)}};
}

std::string value_text(double value) {
  return fmt::format("{:.4g}", value);
}

void print_metric(const cohort::MetricValidity& metric) {
  const std::string title = metric.unit == "1" ? metric.title : fmt::format("{} ({})", metric.title, metric.unit);
  if (!metric.separation) {
    fmt::print("{:<72} {}\n", title, metric.separation.error().what);
    return;
  }
  const cohort::Separation& found = *metric.separation;
  fmt::print("{:<72} {:>9} {:>9}  {:.2f} ({:.2f} to {:.2f})  {:>7.2g} {:>9.2g}  {}\n", title,
             value_text(found.expert_median), value_text(found.novice_median), found.auc, found.auc_interval.low,
             found.auc_interval.high, found.test.p, metric.corrected_p, metric.discriminates ? "yes" : "no");
}

std::string unscored_text(std::size_t count) {
  return count > 0 ? fmt::format(" ({} without a result: not passed, no score)", count) : std::string();
}

void print_people(const Validity& validity, const ValidityArguments& arguments) {
  const std::size_t people = validity.experts + validity.novices;
  std::string simulated;
  if (validity.simulated == people)
    simulated = "; all simulated, no real people";
  else if (validity.simulated > 0)
    simulated = fmt::format("; {} of {} people are simulated", validity.simulated, people);
  std::string of = arguments.filter.task;
  for (const std::string& part : {arguments.filter.patient, arguments.filter.level})
    if (!part.empty()) of += ", " + part;
  fmt::print("validity of {}: experts {}, novices {}, attempts {} of each{}\n", of, validity.experts, validity.novices,
             arguments.attempts, people > 0 ? simulated : "");
  fmt::print("{}\n", learning::counts_text(arguments.counts));
  fmt::print("of these are judged: {} of experts{}, {} of novices{}\n", validity.expert_attempts,
             unscored_text(validity.expert_unscored), validity.novice_attempts,
             unscored_text(validity.novice_unscored));
}

std::string share_text(std::size_t count, std::size_t of) {
  return fmt::format("{} of {}, {:.0f} %", count, of, 100.0 * static_cast<double>(count) / static_cast<double>(of));
}

void print_discriminating(const Validity& validity, const cohort::ValidityRules& rules) {
  if (validity.tested == 0) {
    fmt::print("discriminating metrics: none, no metric has values of both groups\n");
    return;
  }
  fmt::print("discriminating metrics (rank sum test on one mean a person, two-sided p up to {:g}):\n", rules.level);
  if (rules.correction != cohort::Correction::kNone)
    fmt::print("  {} after correction for {} metrics ({})\n", share_text(validity.discriminating, validity.tested),
               validity.tested, to_string(rules.correction));
  // doi 10.1186/s12909-023-05018-1
  fmt::print("  {} without correction; a published automatic assessment: {}\n",
             share_text(validity.uncorrected, validity.tested), share_text(37, 60));
}

void print_summary(const Validity& validity, const cohort::ValidityRules& rules) {
  print_discriminating(validity, rules);
  const std::string smallest =
      cohort::smallest_p_text(validity.experts, validity.novices, validity.tested, rules.level);
  if (!smallest.empty()) fmt::print("  {}\n", smallest);
  if (validity.alpha)
    fmt::print(
        "internal consistency: Cronbach's alpha {:.2f} (95 % {:.2f} to {:.2f}), {} parts of the score, {} people\n",
        validity.alpha->value, validity.alpha->interval.low, validity.alpha->interval.high, validity.alpha->items,
        validity.alpha->people);
  else
    fmt::print("internal consistency: none, {}\n", validity.alpha.error().what);
  if (!validity.pass_mark) {
    fmt::print("pass mark: none, {}\n", validity.pass_mark.error().what);
    return;
  }
  const cohort::PassMark& mark = *validity.pass_mark;
  fmt::print("pass mark by contrasting groups: {:.1f} points\n", mark.value);
  fmt::print("  false passes {} of {} novices (expected {:.1f} %), false fails {} of {} experts (expected {:.1f} %)\n",
             mark.false_passes, mark.novices.people, 100.0 * mark.expected_false_pass, mark.false_fails,
             mark.experts.people, 100.0 * mark.expected_false_fail);
}

void print_table(const Validity& validity) {
  if (!validity.score.separation) {
    fmt::print("no comparison: {}; trocar results change NAME --group expert says who is one\n",
               validity.score.separation.error().what);
    return;
  }
  fmt::print("{:<72} {:>9} {:>9}  {:<19}  {:>7} {:>9}  {}\n", "median over people of", "experts", "novices",
             "AUC (95 %)", "p", "corrected", "discriminates");
  print_metric(validity.score);
  print_metric(validity.passes);
  for (const cohort::MetricValidity& metric : validity.metrics) print_metric(metric);
}

void print_validity(const Validity& validity, const ValidityArguments& arguments) {
  print_people(validity, arguments);
  print_table(validity);
  print_summary(validity, arguments.rules);
}

/// The error where no attempt of the filter counts.
Status no_attempts(results::Repository& repository, const ValidityArguments& arguments) {
  TROCAR_TRY(const results::EvidenceChoices known, results::evidence_choices(repository, arguments.filter.task));
  const std::string& patient = arguments.filter.patient;
  if (!patient.empty() && std::ranges::find(known.patients, patient) == known.patients.end())
    return fail("no attempts at this case", patient,
                fmt::format("cases with attempts at {}: {}", arguments.filter.task, fmt::join(known.patients, ", ")));
  return fail(fmt::format("no attempts to compare ({})", learning::counts_text(arguments.counts)),
              arguments.filter.task, "see trocar results list");
}

Status show_validity(const std::string& url, ValidityArguments& arguments) {
  TROCAR_TRY(arguments.filter.attempts, parse_attempts(arguments.attempts));
  TROCAR_TRY(arguments.rules.correction, parse_correction(arguments.correction));
  TROCAR_TRY_STATUS(check_level(arguments.filter.level));
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  TROCAR_TRY(const Validity validity, results::validity_of(repository, arguments.filter, arguments.rules));
  const results::EvidenceFilter& filter = arguments.filter;
  TROCAR_TRY(arguments.counts,
             results::count_attempts(repository, {{}, filter.task, filter.course, filter.patient, filter.level}));
  if (validity.experts + validity.novices == 0) return no_attempts(repository, arguments);
  if (arguments.is_json) {
    print_json(validity_json(validity, arguments));
  } else {
    print_validity(validity, arguments);
  }
  return {};
}

}  // namespace

void add_results_validity_command(Command& results, const DatabaseOption& url, Action& action) {
  Command command = results.add_command(
      "validity", "Show how the metrics of a task separate experts from novices, consistency and pass mark");
  const auto a = std::make_shared<ValidityArguments>();
  command.add_option("--task", a->filter.task, "Task; see trocar task list").required();
  command.add_option("--course", a->filter.course, "Only people of this course");
  command.add_option("--patient", a->filter.patient, "Only attempts at this case: biopsy-2");
  command.add_option("--level", a->filter.level, "Only attempts at this level of help: guided, assisted or exam");
  command
      .add_option("--attempts", a->attempts, "Attempts of each person that count: 1-3, or 4- for all from the fourth")
      .show_default();
  command.add_option("--correction", a->correction, "For many metrics: bh (Benjamini-Hochberg), holm or none")
      .show_default();
  command.add_option("--significance", a->rules.level, "Level of significance")
      .number_within(0.0001, 0.5, "")
      .show_default();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer(
      "Examples:\n  trocar results validity --task liver-biopsy --attempts 1-2\n"
      "  trocar results validity --task liver-biopsy --patient biopsy-3 --level exam\n");
  command.when_parsed([&action, url, a] { action = [url, a] { return show_validity(*url, *a); }; });
}

}  // namespace trocar::cli
