// Opening a case in the trainer, from the start page until an attempt can begin: the first time, when the embedded
// patient is generated, and again, when it is read from the cache.

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <map>

#include "bench/harness.h"
#include "cases/open_case.h"
#include "core/files/folders.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {

constexpr int kFirstRounds = 3;
constexpr int kAgainRounds = 5;
/// A torso at 1 mm.
constexpr std::array<std::int64_t, 3> kTorsoSize{360, 300, 470};

struct Opening {
  std::string name;  ///< "first", "again".
  std::string note;
  std::vector<double> seconds, peak_mib;
  std::map<std::string, std::vector<double>> parts;
};

/// Sets the recorded peak of this process' memory to the present value (Linux 4.0).
void reset_peak() {
  std::ofstream("/proc/self/clear_refs") << '5';
}

/// The recorded peak of this process' memory; 0: the system does not report it.
double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    double kib = 0.0;
    if (key == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

/// Until an attempt can begin, and until all pictures are there ("later data").
Status open_once(const cases::OpenOptions& options, Opening& opening) {
  reset_peak();
  const auto begin = std::chrono::steady_clock::now();
  TROCAR_TRY(const auto opened, cases::make_open_case({}, options));
  opening.seconds.push_back(opened->seconds);
  for (const cases::OpenPart& part : opened->parts) opening.parts[part.name].push_back(part.seconds);
  opened->later->wait();
  opening.parts["later data"].push_back(seconds_since(begin) - opened->seconds);
  opening.peak_mib.push_back(peak_mib());
  return {};
}

void add_results(const Opening& opening, std::vector<CaseResult>& results) {
  const std::string name = "open/" + opening.name;
  results.push_back({name, "s", figures_of(opening.seconds), {}, opening.note});
  for (const auto& [part, seconds] : opening.parts)
    results.push_back({name + "/" + part, "s", figures_of(seconds), {}, {}});
  results.push_back({name + "/memory", "mib", figures_of(opening.peak_mib), {}, "peak of this process"});
}

Result<anatomy::VirtualPatient> torso_sized(const io::PatientSource& source, const Progress& progress) {
  TROCAR_TRY(anatomy::VirtualPatient patient,
             phantom::generate_phantom(source.folder_or_name, source.seed, {kTorsoSize}, progress));
  io::round_as_saved(patient);
  return patient;
}

}  // namespace

Result<std::vector<CaseResult>> run_open_benchmark(const Options& options) {
  std::vector<CaseResult> results;
  for (const bool is_torso : {false, true}) {
    const std::string size = is_torso ? "-50m" : "";
    Opening first{"first" + size, "generated until an attempt can begin", {}, {}, {}};
    Opening again{"again" + size, "the same from the cache", {}, {}, {}};
    cases::OpenOptions opening;
    if (is_torso) opening.load = torso_sized;
    for (int round = 0; round < kFirstRounds; ++round) {
      core::report(options.progress, "opening " + first.name, static_cast<double>(round) / kFirstRounds);
      const TemporaryFolder folder;
      opening.cache_folder = folder / "patients";
      TROCAR_TRY_STATUS(open_once(opening, first));
      for (int repeat = 0; repeat < kAgainRounds; ++repeat) TROCAR_TRY_STATUS(open_once(opening, again));
    }
    add_results(first, results);
    add_results(again, results);
  }
  return results;
}

}  // namespace trocar::bench
