// trocar-bench: the kernels' benchmarks. `trocar bench` starts it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/harness.h"
#include "cli/bench_arguments.h"
#include "cli/output.h"
#include "config/json.h"
#include "core/interruption.h"
#include "core/log.h"
#include "io/patient/patient_cache.h"
#include "program_end.h"

namespace trocar::bench {
namespace {

using cli::BenchArguments;

/// Options that only some benchmarks use.
constexpr const char* kForSome[] = {"--patient", "--patient-seed", "--task",    "--paths",     "--force-model",
                                    "--seed",    "--out",          "--seconds", "--rate",      "--sequence",
                                    "--motions", "--model",        "--only",    "--unlabelled"};

std::vector<std::string> given_options(const arguments::Command& command) {
  std::vector<std::string> given;
  for (const char* option : kForSome)
    if (command.option(option).is_given()) given.emplace_back(option);
  return given;
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

void print_table(std::string_view benchmark, const std::vector<CaseResult>& results) {
  std::size_t width = 34;
  for (const CaseResult& r : results) width = std::max(width, r.name.size());
  fmt::print("{}\n  {:<{}} {:>9} {:>9} {:>9} {:>9}  unit\n", benchmark, "case", width, "median", "p99", "p99.9", "max");
  for (const CaseResult& r : results) {
    fmt::print("  {:<{}} {:>9} {:>9} {:>9} {:>9}  {:<5}", r.name, width, cell(r.figures.median), cell(r.figures.p99),
               cell(r.figures.p999), cell(r.figures.max), r.unit);
    if (r.peer)
      fmt::print("  {:.2f} times as fast as {} ({:.4g} {})", r.peer->ratio, r.peer->name, r.peer->median, r.unit);
    fmt::print("{}{}\n", r.note.empty() ? "" : "  ", r.note);
  }
}

Result<std::vector<const Benchmark*>> choose(const std::vector<std::string>& names) {
  std::vector<const Benchmark*> chosen;
  const auto& all = all_benchmarks();
  if (names.empty()) {
    for (const Benchmark& benchmark : all) chosen.push_back(&benchmark);
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Benchmark& b) { return b.name == name; });
    if (found == all.end()) return fail_usage("unknown benchmark", name, "see trocar bench --list");
    chosen.push_back(&*found);
  }
  return chosen;
}

/// Every benchmark of the run must support a given option.
Status check_options(const std::vector<const Benchmark*>& chosen, bool is_all, const std::vector<std::string>& given) {
  for (const std::string& option : given) {
    for (const Benchmark* benchmark : chosen) {
      const auto& usable = benchmark->options;
      if (std::find(usable.begin(), usable.end(), option) != usable.end()) continue;
      if (is_all)
        return fail_usage("not every benchmark can use this option", option, "name those that take it: see --list");
      return fail_usage(
          fmt::format("the benchmark cannot use {}", option), std::string(benchmark->name),
          usable.empty() ? "it takes no options" : fmt::format("its options are {}", fmt::join(usable, ", ")));
    }
  }
  return {};
}

Status prepare(BenchArguments& arguments) {
  if (!arguments.force_model.empty()) {
    TROCAR_TRY(arguments.options.force_model, haptics::parse_force_model(arguments.force_model));
  }
  if (!arguments.options.out.empty()) TROCAR_TRY_STATUS(cli::check_new(arguments.options.out));
  if (!arguments.is_json) arguments.options.print = [](std::string_view text) { fmt::print("{}", text); };
  return {};
}

/// Cases whose criterion is not met.
void add_missed(std::vector<std::string>& missed, const std::vector<CaseResult>& results) {
  for (const CaseResult& result : results)
    if (result.is_missed) missed.push_back(result.name);
}

Result<std::vector<CaseResult>> run_one(const Benchmark& benchmark, const BenchArguments& arguments) {
  const cli::ProgressPrinter printer;
  Options options = arguments.options;
  options.progress = printer.callback();
  if (!arguments.source.folder_or_name.empty()) {
    TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient(arguments.source, printer.callback()));
    options.patient = std::make_shared<const anatomy::VirtualPatient>(std::move(patient));
  }
  return benchmark.run(options);
}

void list_benchmarks(bool is_json) {
  config::Json list = config::Json::array();
  for (const Benchmark& b : all_benchmarks()) {
    const std::string options = b.options.empty() ? "" : fmt::format(" [{}]", fmt::join(b.options, " "));
    if (!is_json) fmt::print("{:<16} {}{}\n", b.name, b.description, options);
    list.push_back({{"name", b.name}, {"description", b.description}, {"options", b.options}});
  }
  if (is_json) cli::print_json({{"benchmarks", list}});
}

Status run_benchmarks(BenchArguments& arguments, const std::vector<std::string>& given) {
  if (arguments.is_list) {
    list_benchmarks(arguments.is_json);
    return {};
  }
  TROCAR_TRY(const auto chosen, choose(arguments.names));
  TROCAR_TRY_STATUS(check_options(chosen, arguments.names.empty(), given));
  TROCAR_TRY_STATUS(prepare(arguments));
  config::Json all = config::Json::array();
  std::vector<std::string> missed;
  for (const Benchmark* benchmark : chosen) {
    TROCAR_TRY(const auto results, run_one(*benchmark, arguments));
    add_missed(missed, results);
    if (arguments.is_json) {
      all.push_back(to_json(benchmark->name, results));
    } else {
      print_table(benchmark->name, results);
    }
  }
  if (arguments.is_json) cli::print_json(all.size() == 1 ? all.front() : config::Json{{"benches", all}});
  if (!missed.empty())
    return fail("criteria are not met", fmt::format("{}", fmt::join(missed, ", ")), "see the notes of these cases");
  return {};
}

int run(int argc, char** argv) {
  arguments::Program program(
      "trocar-bench", "Measure speed, forces, energy and images, beside comparable libraries where they are installed");
  program.refuse_empty_texts();
  bool is_verbose = false;
  program.add_flag("-v,--verbose", is_verbose, "Print details to stderr");
  BenchArguments arguments;
  cli::add_bench_options(program, arguments);
  if (const std::optional<int> end = program.parse(argc, argv)) return *end;
  if (is_verbose) set_log_level(LogLevel::kInfo);
  const Status done = run_benchmarks(arguments, given_options(program));
  return done ? 0 : arguments::report_error(done.error());
}

}  // namespace
}  // namespace trocar::bench

int main(int argc, char** argv) {
  trocar::handle_interruptions("trocar bench");
  return trocar::arguments::run_program([&] { return trocar::bench::run(argc, argv); }, "trocar bench");
}
