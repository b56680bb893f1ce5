#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/json.h"
#include "core/result.h"

namespace trocar::bench {

/// Figures of one case, in `unit`; a field that does not apply stays empty.
struct Figures {
  std::optional<double> median, p99, p999, max;
};

/// One line of `trocar bench`.
struct CaseResult {
  std::string name;  ///< "slice/512-oblique".
  std::string unit;  ///< us, ms, fps, mm, n, ratio.
  Figures figures;
  struct Peer {
    std::string name;
    double median;
    double ratio;  ///< Times faster than the peer.
  };
  std::optional<Peer> peer;
  std::string note;
};

/// Calls `work` `rounds` times after `warm_up` calls and returns the times in milliseconds.
Figures time_ms(int warm_up, int rounds, const std::function<void()>& work);
/// Median, p99, p99.9 and maximum of any numbers, by nearest rank. A tail is left empty where fewer values than
/// resolve it were taken: p99 below 100, p99.9 below 1000.
Figures figures_of(std::vector<double> values);

/// A benchmark: a name and what it measures. All of them are listed in registry.cpp.
struct Benchmark {
  std::string_view name;  ///< "slice", "session".
  std::string_view description;
  std::function<Result<std::vector<CaseResult>>()> run;
};
const std::vector<Benchmark>& all_benchmarks();

/// CPU, cores, compiler, build: what the figures were taken on.
Json machine_json();
Json to_json(std::string_view bench, const std::vector<CaseResult>& results);

}  // namespace trocar::bench
