// Two live servers (a needle with the full model, a transducer on the skin), a drawing client and one more busy
// process: timing of the servers' loops (docs/validation.md, Servers).

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "bench/benchmarks.h"
#include "bench/training/stations.h"
#include "phantom/phantom.h"
#include "realtime/periodic_loop.h"

namespace trocar::bench {
namespace {

using namespace std::chrono_literals;

constexpr auto kFrame = 16ms;  // a client draws at most 60 frames per second

/// A process that only calculates until it is ended.
class BusyProcess {
 public:
  BusyProcess() : pid_(::fork()) {
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    volatile double sum = 1.0;
    for (;;) sum = sum * 1.0000001 + 1e-9;
  }
  ~BusyProcess() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  BusyProcess(const BusyProcess&) = delete;
  BusyProcess& operator=(const BusyProcess&) = delete;

 private:
  pid_t pid_;
};

/// Resident memory of a process, MiB; 0 if it cannot be read.
double resident_mib(int pid) {
  std::ifstream status(fmt::format("/proc/{}/statm", pid));
  std::uint64_t size = 0, resident = 0;
  status >> size >> resident;
  constexpr double kMiB = 1024.0 * 1024.0;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMiB;
}

CaseResult latency_case(const std::string& name, const realtime::LatencySummary& s, std::string note = {}) {
  CaseResult result;
  result.name = name;
  result.unit = "us";
  result.figures = {s.p50_us, s.p99_us, s.p999_us, s.max_us};
  result.note = std::move(note);
  return result;
}
CaseResult number_case(const std::string& name, const char* unit, double value, std::string note = {}) {
  CaseResult result;
  result.name = name;
  result.unit = unit;
  result.figures.median = value;
  result.note = std::move(note);
  return result;
}

void add_results(Station& station, double rate_hz, std::vector<CaseResult>& results) {
  const link::ClientView view = station.client.view();
  const realtime::LoopSummary& loop = view.status.loop;
  const std::string name = fmt::format("servers/{}-{:.0f}hz/", station.tool, rate_hz);
  results.push_back(number_case(name + "achieved-hz", "n", loop.achieved_hz, view.status.grant));
  results.push_back(
      number_case(name + "served", "ratio", loop.served(),
                  fmt::format("{} of {} periods missed, {} skipped", loop.missed, loop.periods, loop.skipped)));
  results.push_back(latency_case(name + "lateness", loop.lateness));
  results.push_back(latency_case(name + "tick", loop.tick));
  results.push_back(number_case(
      name + "ticks-missing", "n", static_cast<double>(view.ticks_missing),
      fmt::format("{} received, {} dropped by the server", view.ticks_received, view.status.ticks_dropped)));
  const double now_mib = resident_mib(station.process.pid());
  results.push_back(number_case(name + "memory-growth", "mib", now_mib - station.resident_mib,
                                fmt::format("{:.1f} MiB at the end", now_mib)));
}

/// Longest interruption of a spinning thread.
struct Holes {
  realtime::LatencyHistogram histogram;
  std::int64_t lost_ns = 0;
};
constexpr std::int64_t kWatch_ns = 3'000'000'000;
constexpr std::int64_t kHole_ns = 50'000;  // longer than any tick or interrupt

Holes spin() {
  Holes holes;
  const std::int64_t begin_ns = realtime::now_ns();
  for (std::int64_t last_ns = begin_ns, at_ns = begin_ns; at_ns - begin_ns < kWatch_ns; last_ns = at_ns) {
    at_ns = realtime::now_ns();
    if (at_ns - last_ns < kHole_ns) continue;
    holes.histogram.add(at_ns - last_ns);
    holes.lost_ns += at_ns - last_ns;
  }
  return holes;
}

/// Measures the interruptions of a thread that never waits while two cores are busy: a lower bound for every loop.
CaseResult machine_holes(double rate_hz) {
  std::thread other([] { spin(); });
  const Holes holes = spin();
  other.join();
  CaseResult result =
      latency_case(fmt::format("servers/machine-{:.0f}hz/holes", rate_hz), realtime::summarise(holes.histogram));
  result.note = fmt::format("before it began: {:.0f} holes a second of 50 us and more, {:.2f} percent of the time",
                            static_cast<double>(holes.histogram.count()) / realtime::seconds(kWatch_ns),
                            100.0 * static_cast<double>(holes.lost_ns) / static_cast<double>(kWatch_ns));
  return result;
}

/// Draws until the end time; returns the number of frames.
int play(Stations& stations, const cases::Case& the_case, double seconds, const Progress& progress) {
  const Segment& line_P = the_case.plan.line_P;
  const auto start = std::chrono::steady_clock::now();
  const MovingHands hands(stations, the_case);
  int frames = 0;
  volatile double shown = 0.0;
  for (double now_s = 0.0; now_s < seconds;
       now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()) {
    const auto begun = std::chrono::steady_clock::now();
    const auto newest = stations[0].client.newest();
    shown = shown + draw_slices(the_case.patient->ct, newest ? newest->tip_mm : line_P.a,
                                newest ? newest->axis : line_P.direction());
    for (Station& station : stations) {
      station.client.take_samples();
      station.client.frame_drawn();
    }
    ++frames;
    core::report(progress, "servers are running", now_s / seconds);
    std::this_thread::sleep_until(begun + kFrame);
  }
  return frames;
}

Status measure(const cases::Case& the_case, const Options& options, double rate_hz, std::vector<CaseResult>& results) {
  results.push_back(machine_holes(rate_hz));
  const TemporaryFolder folder;
  TROCAR_TRY(Stations stations,
             start_stations(folder, the_case, rate_hz, options.force_model.value_or(haptics::ForceModel::kProxy)));
  Station &needle = stations[0], &probe_station = stations[1];
  const BusyProcess busy;
  std::this_thread::sleep_for(1s);  // past the safe start
  for (Station* station : {&needle, &probe_station}) {
    TROCAR_TRY_STATUS(station->client.ask(link::ServerCommand::kRestartStatistics, kPatience));
    station->resident_mib = resident_mib(station->process.pid());
  }
  const int frames = play(stations, the_case, options.seconds, options.progress);
  for (Station* station : {&needle, &probe_station}) add_results(*station, rate_hz, results);
  results.push_back(number_case(fmt::format("servers/client-{:.0f}hz/frames", rate_hz), "fps", frames / options.seconds,
                                "three 512 x 512 slices a frame, at most 60"));
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_servers_benchmark(const Options& options) {
  TROCAR_TRY(anatomy::VirtualPatient abdomen, phantom::generate_phantom("abdomen"));
  TROCAR_TRY(const cases::Case the_case,
             cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(abdomen)), {}));
  std::vector<CaseResult> results;
  for (const double rate_hz : options.rates_hz) {
    TROCAR_TRY_STATUS(measure(the_case, options, rate_hz, results));
  }
  return results;
}

}  // namespace trocar::bench
