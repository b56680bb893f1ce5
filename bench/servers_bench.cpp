// Two live servers (a needle with the full model, a transducer on the skin), a drawing client and one more busy
// process: timing of the servers' loops (docs/validation.md, Servers).

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>

#include "anatomy/phantom/phantom.h"
#include "attempt/tools/resting_transducer.h"
#include "bench/benchmarks.h"
#include "cases/scene_request.h"
#include "core/files/temporary_folder.h"
#include "link/client/haptic_client.h"
#include "link/client/server_process.h"
#include "realtime/periodic_loop.h"
#include "volume/sampling.h"

namespace trocar::bench {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 60s;
constexpr auto kFrame = 16ms;  // a client draws at most 60 frames per second
constexpr int kSlicePixels = 512;
constexpr double kSlice_mm = 200.0;

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

/// A server process and its client.
struct Station {
  std::string tool;
  link::ServerProcess process;
  link::HapticClient client;
  double resident_mib = 0.0;  ///< Time of the start of the measurement.
};

Result<Station> open_station(const std::filesystem::path& program, const TemporaryFolder& folder,
                             const std::string& tool, double rate_hz) {
  const std::string url = "ipc://" + (folder / tool).string();
  const std::vector<std::string> arguments{"--device",         "virtual:premium",
                                           "--tool",           tool,
                                           "--rate",           fmt::format("{:.0f}", rate_hz),
                                           "--endpoint",       url,
                                           "--flight-records", folder.path().string()};
  TROCAR_TRY(link::ServerProcess process, link::ServerProcess::start(program, arguments, folder / (tool + ".log")));
  link::ClientOptions options;
  options.endpoint = url;
  options.name = "trocar bench";
  options.has_window = true;
  TROCAR_TRY(link::HapticClient client, link::HapticClient::connect(options));
  TROCAR_TRY_STATUS(client.wait_connected(std::chrono::duration_cast<std::chrono::milliseconds>(kPatience)));
  return Station{tool, std::move(process), std::move(client), 0.0};
}

/// In and out along the path, 12 s per cycle, with a small tremor.
link::HandTarget needle_hand(const Segment& line_P, double time_s) {
  constexpr double kCycle_s = 12.0, kTremor_hz = 9.0, kTremor_mm = 0.1, kOutside_mm = 10.0;
  const double swing = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time_s / kCycle_s);
  const double way_mm = -kOutside_mm + (line_P.length_mm() + kOutside_mm) * swing;
  const Vec3 u = line_P.direction();
  const Vec3 side = u.unitOrthogonal() * kTremor_mm * std::sin(2.0 * std::numbers::pi * kTremor_hz * time_s);
  link::HandTarget hand;
  hand.X_PN = needle_pose(line_P.a + u * way_mm + side, u);
  hand.holds_tip = true;
  return hand;
}

/// Computes three slices through the tip, as in a window with slice viewers. Returns their sum, so that the compiler
/// keeps the work.
double draw_frame(const volume::CtGrid& ct, const Vec3& tip_P, const Vec3& axis_P) {
  const Vec3 across = axis_P.unitOrthogonal();
  const std::array<std::pair<Vec3, Vec3>, 3> planes{
      std::pair<Vec3, Vec3>{axis_P, across}, {axis_P, axis_P.cross(across)}, {across, axis_P.cross(across)}};
  double sum = 0.0;
  constexpr double kStep_mm = kSlice_mm / kSlicePixels;
  for (const auto& [a, b] : planes) {
    for (int row = 0; row < kSlicePixels; ++row) {
      const Vec3 start = tip_P + (row - kSlicePixels / 2) * kStep_mm * a - 0.5 * kSlice_mm * b;
      for (int column = 0; column < kSlicePixels; ++column)
        sum += volume::sample_linear(ct, Vec3(start + column * kStep_mm * b));
    }
  }
  return sum;
}

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

/// Draws and moves the hands until the end time; returns the number of frames.
int play(std::array<Station*, 2> stations, const cases::Case& the_case, double seconds, const Progress& progress) {
  const attempt::RestingTransducer probe(*the_case.patient, the_case.plan.line_P);
  const Segment& line_P = the_case.plan.line_P;
  const auto start = std::chrono::steady_clock::now();
  const auto time_s = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  // A separate thread moves the hands 200 times per second, as a scripted operator would.
  std::atomic<bool> is_done{false};
  std::thread hands([&] {
    while (!is_done) {
      const double now_s = time_s();
      for (Station* station : stations) {
        link::HandTarget hand = station->tool == "needle" ? needle_hand(line_P, now_s) : probe.at(now_s);
        station->client.set_hand(hand);
      }
      std::this_thread::sleep_for(5ms);
    }
  });
  int frames = 0;
  double shown = 0.0;
  for (double now_s = 0.0; now_s < seconds; now_s = time_s()) {
    const auto begun = std::chrono::steady_clock::now();
    const auto newest = stations[0]->client.newest();
    shown += draw_frame(the_case.patient->ct, newest ? newest->tip_mm : line_P.a,
                        newest ? newest->axis : line_P.direction());
    for (Station* station : stations) {
      station->client.take_samples();
      station->client.frame_drawn();
    }
    ++frames;
    report(progress, "servers are running", now_s / seconds);
    std::this_thread::sleep_until(begun + kFrame);
  }
  is_done = true;
  hands.join();
  return frames;
}

Status measure(const cases::Case& the_case, const Options& options, double rate_hz, std::vector<CaseResult>& results) {
  results.push_back(machine_holes(rate_hz));
  TROCAR_TRY(const std::filesystem::path program, link::find_server_program());
  const TemporaryFolder folder;
  TROCAR_TRY(Station needle, open_station(program, folder, "needle", rate_hz));
  TROCAR_TRY(Station probe_station, open_station(program, folder, "probe", rate_hz));
  const attempt::RestingTransducer probe(*the_case.patient, the_case.plan.line_P);
  const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(kPatience);
  for (Station* station : {&needle, &probe_station}) {
    cases::SceneChoice choice;
    choice.tool = station->tool;
    choice.force_model = to_string(options.force_model.value_or(haptics::ForceModel::kProxy));
    choice.patient_source = "abdomen";
    link::LoadScene request = cases::scene_request(the_case, choice);
    request.patient_hash.clear();
    if (station->tool == "probe") request.X_PW = attempt::transducer_room(request.X_PW, probe.X_PT_room());
    TROCAR_TRY_STATUS(station->client.ask(request, patience));
    link::HandTarget hand = station->tool == "needle" ? needle_hand(the_case.plan.line_P, 0.0) : probe.at(0.0);
    hand.is_placed = true;
    station->client.set_hand(hand);
    TROCAR_TRY_STATUS(station->client.ask(link::ServerCommand::kStart, patience));
  }
  const BusyProcess busy;
  std::this_thread::sleep_for(1s);  // past the safe start
  for (Station* station : {&needle, &probe_station}) {
    TROCAR_TRY_STATUS(station->client.ask(link::ServerCommand::kRestartStatistics, patience));
    station->resident_mib = resident_mib(station->process.pid());
  }
  const int frames = play({&needle, &probe_station}, the_case, options.seconds, options.progress);
  for (Station* station : {&needle, &probe_station}) add_results(*station, rate_hz, results);
  results.push_back(number_case(fmt::format("servers/client-{:.0f}hz/frames", rate_hz), "fps", frames / options.seconds,
                                "three 512 x 512 slices a frame, at most 60"));
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_servers_benchmark(const Options& options) {
  TROCAR_TRY(anatomy::VirtualPatient abdomen, anatomy::generate_phantom("abdomen"));
  TROCAR_TRY(const cases::Case the_case,
             cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(abdomen)), {}));
  std::vector<CaseResult> results;
  for (const double rate_hz : options.rates_hz) {
    TROCAR_TRY_STATUS(measure(the_case, options, rate_hz, results));
  }
  return results;
}

}  // namespace trocar::bench
