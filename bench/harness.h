#pragma once

#include <array>
#include <chrono>
#include <concepts>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "bench/figures.h"
#include "config/json_fwd.h"
#include "core/progress.h"
#include "core/result.h"
#include "haptics/haptic_scene.h"

namespace trocar::bench {

inline constexpr int kRounds = 5;       ///< The best one counts, because machines are noisy.
inline constexpr double kDt_s = 0.001;  ///< Of a tick.
inline constexpr double kMsPerS = 1000.0;
inline constexpr std::array kForceModels{haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy,
                                         haptics::ForceModel::kCombined};

/// One line of `trocar bench`.
struct CaseResult {
  std::string name;  ///< "slice/512-oblique".
  std::string unit;  ///< us, ms, s, fps, mm, n, nmm (N mm), mj, mib, ratio, gray, points.
  Figures figures;
  struct Peer {
    std::string name;
    double median;
    double ratio;  ///< Times faster than the peer.
  };
  std::optional<Peer> peer;
  std::string note;
  /// Further figures of this case for programs (scripts/validation), under "values" in JSON: {"steady_n", 3.49}.
  std::vector<std::pair<std::string, double>> values{};
  bool is_missed = false;  ///< A criterion is not met: the exit status is 1.
};

/// Calls `work` `rounds` times after `warm_up` calls and returns the times in milliseconds.
Figures time_ms(int warm_up, int rounds, const std::function<void()>& work);
double seconds_since(std::chrono::steady_clock::time_point start);

/// Options of benchmarks. An option that is not in Benchmark::options is an error.
struct Options {
  std::shared_ptr<const anatomy::VirtualPatient> patient;  ///< Empty: the benchmark's default patient.
  std::string task = "liver-biopsy";
  int paths = 2000;
  bool is_unlabelled = false;  ///< Of the partly segmented patient: what is not segmented has no label.
  std::optional<haptics::ForceModel> force_model;
  std::uint64_t seed = 1;
  double seconds = 10.0;  ///< Duration of the measurement of live servers.
  std::vector<double> rates_hz{1000.0, 4000.0};
  int motions = 10000;             ///< Number of random motions.
  int only = -1;                   ///< Number of the only motion to run; -1: all.
  std::string model;               ///< Force model of a needle, or a face on the skin; empty: all.
  std::filesystem::path sequence;  ///< Tracked sequence for comparison; empty: none.
  std::filesystem::path out;       ///< Folder for files; empty: none are written.
  Progress progress;
  std::function<void(std::string_view)> print;  ///< Prints text in addition to the figures; empty with --json.
};

/// The patient of the options, else the embedded abdomen.
Result<std::shared_ptr<const anatomy::VirtualPatient>> patient_of(const Options& options);

/// The work of a benchmark: a function with options or without.
class Work {
 public:
  template <std::invocable Function>
  Work(Function function) : call_([function](const Options&) { return function(); }) {}
  template <std::invocable<const Options&> Function>
  Work(Function function) : call_(function) {}

  Result<std::vector<CaseResult>> operator()(const Options& options) const { return call_(options); }

 private:
  std::function<Result<std::vector<CaseResult>>(const Options&)> call_;
};

/// A benchmark: its name and its measurements. registry.cpp lists all benchmarks.
struct Benchmark {
  std::string_view name;  ///< "slice", "session".
  std::string_view description;
  Work run;
  std::vector<std::string_view> options{};  ///< Command-line options that it uses: "--patient".
};
const std::vector<Benchmark>& all_benchmarks();

/// The machine of the measurements: CPU, cores, compiler, build.
config::Json machine_json();
config::Json to_json(std::string_view bench, const std::vector<CaseResult>& results);

}  // namespace trocar::bench
