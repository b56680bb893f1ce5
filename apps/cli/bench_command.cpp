// trocar bench: the kernels' benchmarks.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "bench/harness.h"
#include "commands.h"

namespace trocar::cli {
namespace {

struct Arguments {
  std::vector<std::string> names;
  bool is_json = false;
  bool is_list = false;
};

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

void print_table(std::string_view bench, const std::vector<bench::CaseResult>& results) {
  fmt::print("{}\n  {:<34} {:>9} {:>9} {:>9} {:>9}  unit\n", bench, "case", "median", "p99", "p99.9", "max");
  for (const bench::CaseResult& r : results) {
    fmt::print("  {:<34} {:>9} {:>9} {:>9} {:>9}  {}", r.name, cell(r.figures.median), cell(r.figures.p99),
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
    if (found == all.end()) return fail_usage("there is no benchmark of that name", name, "see trocar bench --list");
    chosen.push_back(&*found);
  }
  return chosen;
}

Status run_benchmarks(const Arguments& arguments) {
  if (arguments.is_list) {
    for (const bench::Benchmark& b : bench::all_benchmarks()) fmt::print("{:<12} {}\n", b.name, b.description);
    return {};
  }
  TROCAR_TRY(const auto chosen, choose(arguments.names));
  Json all = Json::array();
  for (const bench::Benchmark* benchmark : chosen) {
    TROCAR_TRY(const auto results, benchmark->run());
    if (arguments.is_json) {
      all.push_back(bench::to_json(benchmark->name, results));
    } else {
      print_table(benchmark->name, results);
    }
  }
  if (arguments.is_json) print_json(all.size() == 1 ? all.front() : Json{{"benches", all}});
  return {};
}

}  // namespace

void add_bench_command(CLI::App& program, Action& action) {
  const auto a = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("bench", "Measure the kernels, peers beside them where installed");
  command->add_option("NAME", a->names, "Benchmarks to run; all when left out");
  command->add_flag("--list", a->is_list, "List the benchmarks");
  command->add_flag("--json", a->is_json, "Print one JSON object; with several benchmarks a list under \"benches\"");
  command->footer("Example:\n  trocar bench slice --json\n");
  command->callback([&action, a] { action = [a] { return run_benchmarks(*a); }; });
}

}  // namespace trocar::cli
