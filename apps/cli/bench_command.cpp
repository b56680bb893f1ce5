// trocar bench: the kernels' benchmarks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "bench/harness.h"
#include "commands.h"
#include "io/patient/open_patient.h"
#include "number_option.h"
#include "patient_option.h"

namespace trocar::cli {
namespace {

struct Arguments {
  std::vector<std::string> names;
  bool is_json = false;
  bool is_list = false;
  io::PatientSource source;
  std::string force_model;
  bench::Options options;
  std::vector<std::string> given;  ///< Options of kForSome that were given.
};

/// Options that only some benchmarks use.
constexpr const char* kForSome[] = {"--patient", "--patient-seed", "--task",    "--paths", "--force-model",
                                    "--seed",    "--out",          "--seconds", "--rate",  "--sequence"};

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

void print_table(std::string_view bench, const std::vector<bench::CaseResult>& results) {
  std::size_t width = 34;
  for (const bench::CaseResult& r : results) width = std::max(width, r.name.size());
  fmt::print("{}\n  {:<{}} {:>9} {:>9} {:>9} {:>9}  unit\n", bench, "case", width, "median", "p99", "p99.9", "max");
  for (const bench::CaseResult& r : results) {
    fmt::print("  {:<{}} {:>9} {:>9} {:>9} {:>9}  {:<5}", r.name, width, cell(r.figures.median), cell(r.figures.p99),
               cell(r.figures.p999), cell(r.figures.max), r.unit);
    if (r.peer)
      fmt::print("  {:.2f} times as fast as {} ({:.4g} {})", r.peer->ratio, r.peer->name, r.peer->median, r.unit);
    fmt::print("{}{}\n", r.note.empty() ? "" : "  ", r.note);
  }
}

Result<std::vector<const bench::Benchmark*>> choose(const std::vector<std::string>& names) {
  std::vector<const bench::Benchmark*> chosen;
  const auto& all = bench::all_benchmarks();
  if (names.empty()) {
    for (const bench::Benchmark& benchmark : all) chosen.push_back(&benchmark);
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const bench::Benchmark& b) { return b.name == name; });
    if (found == all.end()) return fail_usage("unknown benchmark", name, "see trocar bench --list");
    chosen.push_back(&*found);
  }
  return chosen;
}

/// Every benchmark of the run must support a given option.
Status check_options(const std::vector<const bench::Benchmark*>& chosen, const std::vector<std::string>& given) {
  for (const std::string& option : given) {
    for (const bench::Benchmark* benchmark : chosen) {
      const auto& usable = benchmark->options;
      if (std::find(usable.begin(), usable.end(), option) != usable.end()) continue;
      return fail_usage(
          fmt::format("the benchmark cannot use {}", option), std::string(benchmark->name),
          usable.empty() ? "it takes no options" : fmt::format("its options are {}", fmt::join(usable, ", ")));
    }
  }
  return {};
}

Status prepare(Arguments& arguments) {
  if (!arguments.force_model.empty()) {
    TROCAR_TRY(arguments.options.force_model, haptics::parse_force_model(arguments.force_model));
  }
  if (!arguments.options.out.empty()) TROCAR_TRY_STATUS(check_new(arguments.options.out));
  if (!arguments.is_json) arguments.options.print = [](std::string_view text) { fmt::print("{}", text); };
  return {};
}

Result<std::vector<bench::CaseResult>> measure(const bench::Benchmark& benchmark, const Arguments& arguments) {
  const ProgressPrinter printer;
  bench::Options options = arguments.options;
  options.progress = printer.callback();
  if (!arguments.source.folder_or_name.empty()) {
    TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient(arguments.source, printer.callback()));
    options.patient = std::make_shared<const anatomy::VirtualPatient>(std::move(patient));
  }
  return benchmark.run(options);
}

void list_benchmarks(bool is_json) {
  config::Json list = config::Json::array();
  for (const bench::Benchmark& b : bench::all_benchmarks()) {
    if (!is_json) fmt::print("{:<12} {}\n", b.name, b.description);
    list.push_back({{"name", b.name}, {"description", b.description}, {"options", b.options}});
  }
  if (is_json) print_json({{"benchmarks", list}});
}

Status run_benchmarks(Arguments& arguments) {
  if (arguments.is_list) {
    list_benchmarks(arguments.is_json);
    return {};
  }
  TROCAR_TRY(const auto chosen, choose(arguments.names));
  TROCAR_TRY_STATUS(check_options(chosen, arguments.given));
  TROCAR_TRY_STATUS(prepare(arguments));
  config::Json all = config::Json::array();
  for (const bench::Benchmark* benchmark : chosen) {
    TROCAR_TRY(const auto results, measure(*benchmark, arguments));
    if (arguments.is_json) {
      all.push_back(bench::to_json(benchmark->name, results));
    } else {
      print_table(benchmark->name, results);
    }
  }
  if (arguments.is_json) print_json(all.size() == 1 ? all.front() : config::Json{{"benches", all}});
  return {};
}

}  // namespace

void add_bench_command(CLI::App& program, Action& action) {
  const auto a = std::make_shared<Arguments>();
  CLI::App* command =
      program.add_subcommand("bench", "Measure the speed of the kernels and, if installed, of comparable libraries");
  command->add_option("NAME", a->names, "Benchmarks to run; default: all");
  command->add_flag("--list", a->is_list, "List the benchmarks");
  command->add_flag("--json", a->is_json, "Print one JSON object; with several benchmarks a list under \"benches\"");
  command->add_option("--patient", a->source.folder_or_name, "Patient folder, or an embedded patient's name");
  arguments::seed_number(
      command->add_option("--patient-seed", a->source.seed, "Random seed for the anatomy of an embedded patient"))
      ->capture_default_str();
  add_cache_option(*command, a->source);
  command->add_option("--task", a->options.task, "Task whose paths are planned")->capture_default_str();
  arguments::whole_number_within(command->add_option("--paths", a->options.paths, "Number of planned paths"), 1, 100000)
      ->capture_default_str();
  command->add_option("--force-model", a->force_model, "Force model: insertion, proxy or combined");
  arguments::seed_number(
      command->add_option("--seed", a->options.seed, "Random seed for the choice of paths and the motion"))
      ->capture_default_str();
  arguments::number_within(command->add_option("--seconds", a->options.seconds, "Measuring time of live servers"), 1.0,
                           86400.0, "s")
      ->capture_default_str();
  arguments::number_within(
      command->add_option("--rate", a->options.rates_hz, "Rate of the live servers; can be given several times"), 250.0,
      4000.0, "Hz")
      ->capture_default_str();
  command->add_option("--sequence", a->options.sequence, "Recorded ultrasound (.igs.mha) for the comparison of images");
  command->add_option("--out", a->options.out, "Folder to create for the benchmark's files");
  command->footer("Examples:\n  trocar bench slice --json\n  trocar bench paths --patient my_patient --paths 2000\n");
  command->callback([&action, a, command] {
    for (const char* option : kForSome)
      if (command->count(option) > 0) a->given.emplace_back(option);
    action = [a] { return run_benchmarks(*a); };
  });
}

}  // namespace trocar::cli
