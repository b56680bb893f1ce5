#pragma once

#include <string>
#include <vector>

#include "bench/harness.h"
#include "cli/action.h"
#include "io/patient/patient_folder.h"

namespace trocar::cli {

/// Arguments of `trocar bench`, which checks them, and of trocar-bench, which measures.
struct BenchArguments {
  std::vector<std::string> names;  ///< Of the benchmarks; none: all.
  bool is_json = false;
  bool is_list = false;
  io::PatientSource source;
  std::string force_model;
  bench::Options options;  ///< Those that are plain values.
};

/// Adds options and examples; `arguments` must outlive the command.
void add_bench_options(Command& command, BenchArguments& arguments);

}  // namespace trocar::cli
