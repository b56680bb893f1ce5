// A complete attempt faster than real time: the closed loop with recording, and the whole process.

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "attempt/offline/run_session.h"
#include "bench/harness.h"
#include "bench/real_data.h"
#include "core/files/folders.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {
namespace fs = std::filesystem;

constexpr double kSimulated_s = 30.0;
constexpr double kOutsideSkin_mm = 10.0;  // start and end of make_constant_velocity

/// Times work that can fail, in ms.
Result<Figures> time_fallible_ms(int rounds, const std::function<Status()>& work) {
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) {
    const auto start = std::chrono::steady_clock::now();
    TROCAR_TRY_STATUS(work());
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return figures_of(std::move(times));
}

}  // namespace

Result<std::vector<CaseResult>> run_session_benchmark() {
  const TemporaryFolder folder;
  TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom("abdomen"));
  const fs::path patient_folder = folder.path() / "patient";
  TROCAR_TRY_STATUS(io::save_patient(generated, {}, patient_folder));
  TROCAR_TRY(const cases::Case the_case,
             cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(generated)), {}));

  // In and out along the path in exactly 30 simulated seconds.
  const double speed = 2.0 * (the_case.plan.line_P.length_mm() + kOutsideSkin_mm) / kSimulated_s;
  attempt::RunOptions options;
  options.operator_name = fmt::format("constant-velocity:{:.6f}", speed);
  int round = 0;
  std::size_t ticks = 0;
  TROCAR_TRY(const Figures loop, time_fallible_ms(7, [&]() -> Status {
               options.session = folder.path() / fmt::format("loop{}.trocar", ++round);
               TROCAR_TRY(const attempt::RunResult result, attempt::run_session(the_case, options));
               ticks = result.ticks;
               return {};
             }));
  TROCAR_TRY(const Figures process, time_fallible_ms(5, [&]() -> Status {
               const fs::path session = folder.path() / fmt::format("process{}.trocar", ++round);
               return run_trocar({"run", "liver-biopsy", "--patient", patient_folder.string(), "--operator",
                                  options.operator_name, "--out", session.string()});
             }));
  CaseResult loop_result{"session/loop", "ms", loop, {}, fmt::format("{} ticks at 1 kHz, recorded and scored", ticks)};
  CaseResult process_result{"session/process", "ms", process, {}, "trocar run: start, patient load, plan, loop, score"};
  return std::vector<CaseResult>{loop_result, process_result};
}

}  // namespace trocar::bench
