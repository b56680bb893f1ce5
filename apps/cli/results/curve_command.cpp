// trocar results curve: how a person learns a task.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/json_parts.h"
#include "cli/results/commands.h"
#include "config/json.h"
#include "results/attempt_json.h"
#include "results/people.h"
#include "results/proficiency.h"
#include "tasks/task.h"

namespace trocar::cli {
namespace {

using results::LearningCurve;

struct CurveArguments {
  std::string person, task;
  std::int64_t window = 5;
  results::CurveRules rules;
  bool is_json = false;
};

const char* decision_text(cohort::Cusum::Decision decision) {
  return decision == cohort::Cusum::Decision::kAcceptable ? "acceptable" : "unacceptable";
}

config::Json cusum_json(const LearningCurve& curve, const cohort::CusumRates& rates) {
  config::Json values = config::Json::array(), signals = config::Json::array();
  for (const results::CurveAttempt& point : curve.attempts) values.push_back(point.cusum);
  for (const cohort::Cusum::Signal& signal : curve.cusum.signals)
    signals.push_back({{"attempt", signal.attempt}, {"failure_rate", decision_text(signal.decision)}});
  return {{"values", std::move(values)},       {"signals", std::move(signals)},  {"lower", curve.cusum.lower},
          {"upper", curve.cusum.upper},        {"acceptable", rates.acceptable}, {"unacceptable", rates.unacceptable},
          {"pass_step", curve.cusum.pass_step}};
}

config::Json curve_json(const LearningCurve& curve, const results::Person& person, const CurveArguments& arguments) {
  config::Json peers = config::Json::array(), experts;
  for (const auto& point : curve.peer_curve)
    peers.push_back(point ? config::Json({{"people", point->people}, {"mean", point->mean}}) : config::Json(nullptr));
  if (curve.experts)
    experts = {{"n", curve.experts->people},
               {"simulated", curve.experts->is_simulated},
               {"mean", curve.experts->mean},
               {"low", curve.experts->low},
               {"high", curve.experts->high}};
  return {{"person", person.name},
          {"group", to_string(person.group)},
          {"simulated", person.is_simulated},
          {"task", arguments.task},
          {"window", arguments.window},
          {"counts", counts_json(curve.counts)},
          {"points", results::curve_points_json(curve)},
          {"cusum", cusum_json(curve, arguments.rules.cusum)},
          {"trend", or_null(curve.trend)},
          {"experts", std::move(experts)},
          {"peers", {{"n", curve.peers}, {"by_attempt", std::move(peers)}}}};
}

/// A line of the plot: scores 0..100 over its width. Later marks cover earlier ones.
class PlotLine {
 public:
  static constexpr std::size_t kWidth = 51;  // two points a character

  void mark(const std::optional<double>& score, char symbol) {
    if (!score || !std::isfinite(*score)) return;
    const double share = std::clamp(*score / 100.0, 0.0, 1.0);
    text_[static_cast<std::size_t>(std::lround(share * static_cast<double>(kWidth - 1)))] = symbol;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_ = std::string(kWidth, ' ');
};

std::string text_or_dash(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : std::string("-");
}

void print_attempts(const LearningCurve& curve, std::int64_t window) {
  const std::string mean_title = fmt::format("mean of {}", window);
  fmt::print("  n  {:<16}  {:<12} {:>5}  {:<10} {:>10} {:>6}  0{:>{}}\n", "started (UTC)", "patient", "score", "",
             mean_title, "CUSUM", "100", PlotLine::kWidth - 1);
  for (std::size_t n = 0; n < curve.attempts.size(); ++n) {
    const results::CurveAttempt& point = curve.attempts[n];
    const results::Attempt& attempt = point.attempt;
    PlotLine line;
    if (curve.experts) line.mark(curve.experts->mean, 'E');
    if (n < curve.peer_curve.size() && curve.peer_curve[n]) line.mark(curve.peer_curve[n]->mean, '.');
    line.mark(point.moving_mean, 'o');
    line.mark(attempt.score, '*');
    const char* const verdict = !attempt.score ? "no result" : attempt.is_passed ? "passed" : "not passed";
    fmt::print("{:>3}  {:<16}  {:<12} {:>5}  {:<10} {:>10} {:>6}  |{}|\n", n + 1, minute_text(attempt.started),
               plain_line(attempt.the_case.patient), text_or_dash(attempt.score, 1), verdict,
               text_or_dash(point.moving_mean, 1), fmt::format("{:.2f}", point.cusum), line.text());
  }
  fmt::print("plot: * score, o moving mean{}{}\n", curve.peers > 0 ? ", . mean of the peers at this attempt" : "",
             curve.experts ? ", E mean of the experts" : "");
}

const char* simulated_text(bool is_simulated) {
  return is_simulated ? ", simulated" : "";
}

void print_cusum(const cohort::Cusum& cusum, const cohort::CusumRates& rates) {
  fmt::print("CUSUM: at {:.2f} the failure rate is acceptable ({:.0f} %), at {:.2f} unacceptable ({:.0f} %): ",
             cusum.lower, 100.0 * rates.acceptable, cusum.upper, 100.0 * rates.unacceptable);
  if (cusum.signals.empty()) {
    fmt::print("not decided yet\n");
    return;
  }
  const cohort::Cusum::Signal& last = cusum.signals.back();
  fmt::print("{} since attempt {}\n", decision_text(last.decision), last.attempt);
}

void print_curve(const LearningCurve& curve, const results::Person& person, const CurveArguments& arguments) {
  fmt::print("{} ({}{}), {}: {} of {} passed\n", person.name, to_string(person.group),
             simulated_text(person.is_simulated), arguments.task, curve.counts.passed, curve.counts.counted());
  fmt::print("{}\n", learning::counts_text(curve.counts));
  if (curve.attempts.empty()) return;
  print_attempts(curve, arguments.window);
  if (curve.trend) fmt::print("trend: {:+.1f} points an attempt (median slope)\n", *curve.trend);
  print_cusum(curve.cusum, arguments.rules.cusum);
  if (curve.experts)
    fmt::print("experts: {:.1f} points (mean of {}, {:.1f} to {:.1f}{})\n", curve.experts->mean, curve.experts->people,
               curve.experts->low, curve.experts->high, simulated_text(curve.experts->is_simulated));
  if (curve.peers > 0)
    fmt::print("peers: {} people, each counted once{}\n", curve.peers, simulated_text(person.is_simulated));
}

Status check_task(const std::string& task) {
  TROCAR_TRY(const std::filesystem::path folder, find_data("tasks"));
  TROCAR_TRY_STATUS(tasks::load_task(folder, task));
  return {};
}

Status show_curve(const std::string& url, CurveArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.person));
  arguments.rules.window = static_cast<std::size_t>(arguments.window);
  TROCAR_TRY(const LearningCurve curve, results::learning_curve(repository, person, arguments.task, arguments.rules));
  // A misspelt task; one of a file of its own may have any name.
  if (curve.counts.counted() + curve.counts.left_out() == 0) TROCAR_TRY_STATUS(check_task(arguments.task));
  if (arguments.is_json) {
    print_json(curve_json(curve, person, arguments));
  } else {
    print_curve(curve, person, arguments);
  }
  return {};
}

}  // namespace

void add_results_curve_command(Command& results, const DatabaseOption& url, Action& action) {
  Command command = results.add_command("curve", "Show how a person learns a task: moving mean and CUSUM");
  const auto a = std::make_shared<CurveArguments>();
  command.add_option("--person", a->person, "Name of the person").required();
  command.add_option("--task", a->task, "Task; see trocar task list").required();
  command.add_option("--window", a->window, "Attempts of the moving mean").whole_number_within(1, 1000).show_default();
  command.add_option("--acceptable", a->rules.cusum.acceptable, "Failure rate of a competent person")
      .number_within(0.001, 0.9, "")
      .show_default();
  command.add_option("--unacceptable", a->rules.cusum.unacceptable, "Failure rate that must be found")
      .number_within(0.001, 0.999, "")
      .show_default();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer("Example:\n  trocar results curve --person \"Anna Meier\" --task liver-biopsy\n");
  command.when_parsed([&action, url, a] { action = [url, a] { return show_curve(*url, *a); }; });
}

}  // namespace trocar::cli
