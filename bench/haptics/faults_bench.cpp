// Loops of 1 to 1000 ms on every simulated device while a hand moves it in tissue: time until the force is zero, its
// maximum, motion of the stylus. docs/validation.md, Slow loops.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/benchmarks.h"
#include "bench/haptics/flat_scene.h"
#include "core/files/folders.h"
#include "lab/server/slow_loop_trial.h"
#include "server/scene_builder.h"

namespace trocar::bench {
namespace {

constexpr std::array kSlow_ms{1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 50.0, 100.0, 200.0, 240.0, 400.0, 1000.0};

Result<std::shared_ptr<const anatomy::VirtualPatient>> open_flat(const std::string&, std::uint64_t, const Progress&) {
  return make_flat_patient({{0.0, "adipose"}, {12.0, "muscle"}, {24.0, "liver"}});
}

std::string in_ms(double seconds) {
  return std::isfinite(seconds) ? fmt::format("{:.0f}", 1e3 * seconds) : "-";
}

void print_row(const Options& options, const std::string& device, double slow_ms, const server::SlowLoopOutcome& slow) {
  if (!options.print) return;
  options.print(fmt::format("{:<10} {:>6} {:>8} {:>7.3f} {:<13} {:>6} {:>6} {:>8.2f} {:>8.1f}\n", device,
                            slow_ms > 0.0 ? fmt::format("{:.0f}", slow_ms) : "healthy", in_ms(slow.longest_period_s),
                            slow.least_share, to_string(slow.fault),
                            slow.fault == telemetry::GateFault::kNone ? "-" : in_ms(slow.latch_s), in_ms(slow.zero_s),
                            slow.after_n, slow.travel_mm));
}

/// The worst slow loop of a device.
void add_results(std::vector<CaseResult>& results, const std::string& device,
                 const std::vector<server::SlowLoopOutcome>& outcomes, const server::SlowLoopOutcome& healthy) {
  const auto add = [&](const char* what, const char* unit, auto&& value, std::string note) {
    std::vector<double> values;
    for (const server::SlowLoopOutcome& outcome : outcomes) {
      if (std::isfinite(value(outcome))) values.push_back(value(outcome));
    }
    if (values.empty()) return;
    results.push_back({fmt::format("faults/{}/{}", device, what), unit, figures_of(values), {}, std::move(note)});
  };
  const auto latched = std::count_if(outcomes.begin(), outcomes.end(), [](const server::SlowLoopOutcome& o) {
    return o.fault != telemetry::GateFault::kNone;
  });
  add(
      "zero", "ms", [](const server::SlowLoopOutcome& o) { return 1e3 * o.zero_s; },
      fmt::format("to zero force; {} of {} loops latch a fault", latched, outcomes.size()));
  add(
      "force", "n", [](const server::SlowLoopOutcome& o) { return o.after_n; },
      fmt::format("largest; {:.2f} in a healthy loop", healthy.after_n));
  add(
      "travel", "mm", [](const server::SlowLoopOutcome& o) { return o.travel_mm; },
      fmt::format("peak to peak; {:.1f} in a healthy loop", healthy.travel_mm));
}

/// One reading time of a device, for programs: the text has a row of it.
void add_row(std::vector<CaseResult>& results, const std::string& device, double slow_ms,
             const server::SlowLoopOutcome& slow) {
  const bool has_fault = slow.fault != telemetry::GateFault::kNone;
  std::vector<std::pair<std::string, double>> values{
      {"share", slow.least_share}, {"force_n", slow.after_n}, {"travel_mm", slow.travel_mm}};
  if (has_fault) values.emplace_back("latch_ms", kMsPerS * slow.latch_s);
  if (std::isfinite(slow.zero_s)) values.emplace_back("zero_ms", kMsPerS * slow.zero_s);
  results.push_back({fmt::format("faults/{}/reading-{:.0f}ms", device, slow_ms),
                     "ms",
                     figure_of(slow_ms),
                     {},
                     has_fault ? to_string(slow.fault) : "none",
                     std::move(values)});
}

Status measure(const stylus::DevicePreset& preset, const std::filesystem::path& tissues, const Options& options,
               std::vector<CaseResult>& results) {
  server::SceneBuilder builder(open_flat, tissues, preset);
  TROCAR_TRY(const server::ServoScene scene, builder.load(flat_request()));
  const server::SlowLoopOutcome healthy = server::run_slow_loop_trial(scene, preset, {});
  print_row(options, preset.name, 0.0, healthy);
  if (!options.print) add_row(results, preset.name, 0.0, healthy);
  std::vector<server::SlowLoopOutcome> outcomes;
  for (const double slow_ms : kSlow_ms) {
    server::SlowLoopTrial trial;
    trial.slow_ms = slow_ms;
    outcomes.push_back(server::run_slow_loop_trial(scene, preset, trial));
    print_row(options, preset.name, slow_ms, outcomes.back());
    if (!options.print) add_row(results, preset.name, slow_ms, outcomes.back());
  }
  add_results(results, preset.name, outcomes, healthy);
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_faults_benchmark(const Options& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const auto presets, stylus::load_device_presets(data / "devices.toml"));
  if (options.print)
    options.print(fmt::format("{:<10} {:>6} {:>8} {:>7} {:<13} {:>6} {:>6} {:>8} {:>8}\n", "device", "read", "period",
                              "share", "fault", "latch", "zero", "force", "travel") +
                  fmt::format("{:<10} {:>6} {:>8} {:>7} {:<13} {:>6} {:>6} {:>8} {:>8}\n", "", "ms", "ms", "least", "",
                              "ms", "ms", "N", "mm"));
  std::vector<CaseResult> results;
  for (const stylus::DevicePreset& preset : presets)
    TROCAR_TRY_STATUS(measure(preset, data / "tissues.toml", options, results));
  return results;
}

}  // namespace trocar::bench
