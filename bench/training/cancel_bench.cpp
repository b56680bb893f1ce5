// How long the work of opening a case goes on after it is cancelled, at moments spread over its whole duration: the
// trainee goes back from the briefing, or closes the window.

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "bench/harness.h"
#include "cases/open_case.h"
#include "core/files/folders.h"

namespace trocar::bench {
namespace {

constexpr int kMoments = 24;
constexpr auto kPoll = std::chrono::milliseconds(1);

cases::CaseChoice choice_of(const char* task, const char* patient, int seed) {
  cases::CaseChoice choice;
  choice.options.task = task;
  choice.patient_source = patient;
  choice.patient_seed = static_cast<std::uint64_t>(seed);  // one that is not in any cache
  return choice;
}

template <class Job>
double ms_until_done(Job& job, std::chrono::steady_clock::time_point cancelled) {
  while (!job.view().is_done) std::this_thread::sleep_for(kPoll);
  return kMsPerS * seconds_since(cancelled);
}

/// Opening, and the pictures that follow it.
Status measure(const char* task, const char* patient, std::vector<double>& opening_ms, std::vector<double>& later_ms,
               const Progress& progress) {
  auto begin = std::chrono::steady_clock::now();
  TROCAR_TRY(const auto whole, cases::make_open_case(choice_of(task, patient, 1), {}));
  const double opening_s = seconds_since(begin);
  begin = std::chrono::steady_clock::now();
  whole->later->wait();
  const double later_s = seconds_since(begin);
  TROCAR_TRY(const auto acoustics, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  for (int n = 0; n < kMoments; ++n) {
    core::report(progress, fmt::format("cancelling {}", patient), static_cast<double>(n) / kMoments);
    const double share = (n + 0.5) / kMoments;
    const TemporaryFolder cache;
    auto job = cases::open_case(choice_of(task, patient, 2 + n), cases::OpenOptions{nullptr, cache / "patients"});
    std::this_thread::sleep_for(std::chrono::duration<double>(share * opening_s));
    job.cancel();
    opening_ms.push_back(ms_until_done(job, std::chrono::steady_clock::now()));
    cases::LaterData later(whole->the_case.patient, acoustics, {patient, 1});
    std::this_thread::sleep_for(std::chrono::duration<double>(share * later_s));
    later.cancel();
    later_ms.push_back(ms_until_done(later, std::chrono::steady_clock::now()));
  }
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_cancel_benchmark(const Options& options) {
  std::vector<CaseResult> results;
  for (const auto& [task, patient] : {std::pair("liver-biopsy", "abdomen"), std::pair("ptcd", "ptcd-1")}) {
    std::vector<double> opening_ms, later_ms;
    TROCAR_TRY_STATUS(measure(task, patient, opening_ms, later_ms, options.progress));
    const std::string name = fmt::format("cancel/{}", patient);
    results.push_back({name + "/opening", "ms", figures_of(opening_ms), {}, "from the cancellation to the end"});
    results.push_back({name + "/later", "ms", figures_of(later_ms), {}, "the same for the pictures"});
  }
  return results;
}

}  // namespace trocar::bench
