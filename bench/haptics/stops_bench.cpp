// Stops behind a flood of starts, on a haptic server in this process: none may be lost. Time from the receipt of a stop
// to the tick that sees it, and from that tick to zero force. docs/validation.md, Stops.

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "bench/benchmarks.h"
#include "bench/haptics/flat_scene.h"
#include "core/files/folders.h"
#include "link/client/haptic_client.h"
#include "server/haptic_server.h"

namespace trocar::bench {
namespace {

using link::ServerCommand;

constexpr int kStops = 10'000;      ///< Stops by the client in control.
constexpr int kPasses = 200;        ///< Clients that say goodbye behind a flood.
constexpr int kStartsBefore = 150;  ///< The queue of the real-time thread holds 64.
constexpr int kFullEvery = 50;      ///< Every so many stops, the forces have risen fully before.
constexpr double kSomeForce_n = 0.005;
constexpr double kFullForce_n = 0.49;         ///< The device carries the weight of its stylus, 0.5 N.
constexpr std::uint64_t kMostPeriods = 1000;  ///< Without zero force after this many periods, a stop is lost.
constexpr std::uint64_t kPeriodsAfter = 30;   ///< The force stays zero: more periods than a full queue takes.
constexpr std::chrono::seconds kReplyPatience{30};

/// A device whose tool stays above the skin: the only force is the weight of its stylus, scaled by the gate.
class WeightDevice final : public devices::HapticDevice {
 public:
  /// Values that the real-time thread writes.
  struct Log {
    std::atomic<std::uint64_t> writes{0};
    std::atomic<double> force_n{0.0};
    std::atomic<double> fall_s{0.0};  ///< From the last write before the newest fall to zero to the first zero.
  };
  WeightDevice(stylus::DevicePreset preset, Log& log) : preset_(std::move(preset)), log_(log) {}
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "weight"; }
  devices::DeviceReading read(double now_s) noexcept override {
    constexpr double kAbove_mm = 30.0;
    now_s_ = now_s;
    devices::DeviceReading reading;
    reading.X_DS = Pose(rotation_between(Vec3::UnitZ(), -Vec3::UnitZ()), {0.0, 0.0, kAbove_mm});
    return reading;
  }
  bool write(const Wrench& wrench_D) noexcept override {
    const double force_n = wrench_D.force_n.norm();
    if (force_n > 0.0 && force_n >= last_n_) highest_s_ = now_s_;
    if (force_n == 0.0 && last_n_ > 0.0) log_.fall_s = now_s_ - highest_s_;
    last_n_ = force_n;
    log_.force_n = force_n;
    log_.writes.fetch_add(1, std::memory_order_release);
    return true;
  }
  Status reconnect() override { return {}; }

 private:
  stylus::DevicePreset preset_;
  Log& log_;
  double now_s_ = 0.0, last_n_ = 0.0, highest_s_ = 0.0;
};

/// Counts of all tries.
struct StopCounts {
  int tries = 0, lost = 0, faults = 0;
  std::uint64_t starts_refused = 0;  ///< Starts that found the queue full.
  std::vector<double> falls_ms, full_falls_ms;
};

void pause() {
  std::this_thread::sleep_for(std::chrono::microseconds(200));
}

/// Waits for the reply to `request`; counts the refused commands before it. False: it was refused, or none came.
bool wait_for_reply(link::HapticClient& client, std::uint32_t request, StopCounts& counts) {
  const auto end = std::chrono::steady_clock::now() + kReplyPatience;
  while (std::chrono::steady_clock::now() < end) {
    for (const link::Reply& reply : client.take_replies()) {
      if (reply.request == request) return reply.is_done;
      counts.starts_refused += reply.text.find("too many commands") != std::string::npos ? 1 : 0;
    }
    pause();
  }
  return false;
}

/// Forces on, up to this force. A loop that was too slow on a busy machine has latched a fault: it is reset.
Status start_to(link::HapticClient& client, const WeightDevice::Log& log, double force_n, StopCounts& counts) {
  const auto end = std::chrono::steady_clock::now() + kReplyPatience;
  TROCAR_TRY_STATUS(client.ask(ServerCommand::kStart, kReplyPatience));
  while (log.force_n < force_n) {
    if (client.view().status.fault != telemetry::GateFault::kNone) {
      ++counts.faults;
      TROCAR_TRY_STATUS(client.ask(ServerCommand::kResetFault, kReplyPatience));
      std::this_thread::sleep_for(std::chrono::milliseconds(100));  // a status without the fault
    }
    if (std::chrono::steady_clock::now() > end) return fail("no force after a start", "stops", "run it again");
    pause();
  }
  return {};
}

/// The force becomes zero within kMostPeriods and stays so for kPeriodsAfter.
bool becomes_zero(const WeightDevice::Log& log) {
  const std::uint64_t begin = log.writes;
  while (log.force_n > 0.0) {
    if (log.writes > begin + kMostPeriods) return false;
    pause();
  }
  for (const std::uint64_t zero = log.writes; log.writes < zero + kPeriodsAfter; pause()) {
    if (log.force_n > 0.0) return false;
  }
  return true;
}

void flood(link::HapticClient& client) {
  for (int i = 0; i < kStartsBefore; ++i) client.send(ServerCommand::kStart);
}

Status try_stop(link::HapticClient& client, const WeightDevice::Log& log, StopCounts& counts) {
  const bool is_full = counts.tries % kFullEvery == 0;
  const int faults_before = counts.faults;
  TROCAR_TRY_STATUS(start_to(client, log, is_full ? kFullForce_n : kSomeForce_n, counts));
  flood(client);
  const bool is_done = wait_for_reply(client, client.send(ServerCommand::kStop), counts);
  const bool is_zero = becomes_zero(log);
  counts.lost += is_done && is_zero ? 0 : 1;
  ++counts.tries;
  if (!is_zero || counts.faults != faults_before) return {};
  counts.falls_ms.push_back(kMsPerS * log.fall_s);
  if (is_full) counts.full_falls_ms.push_back(kMsPerS * log.fall_s);
  return {};
}

Result<link::HapticClient> connect_to(const server::HapticServer& server) {
  link::ClientOptions options;
  options.endpoint = server.url();
  TROCAR_TRY(link::HapticClient client, link::HapticClient::connect(options));
  TROCAR_TRY_STATUS(client.wait_connected(kReplyPatience));
  return client;
}

/// The client in control floods and leaves; the next one, which has started nothing, has no force.
Result<link::HapticClient> try_pass(const server::HapticServer& server, link::HapticClient client,
                                    const WeightDevice::Log& log, StopCounts& counts) {
  TROCAR_TRY(link::HapticClient next, connect_to(server));
  TROCAR_TRY_STATUS(start_to(client, log, kSomeForce_n, counts));
  flood(client);
  wait_for_reply(client, client.send(ServerCommand::kRestartStatistics), counts);
  { const link::HapticClient leaves = std::move(client); }
  const auto end = std::chrono::steady_clock::now() + kReplyPatience;
  while (!next.view().welcome.has_control) {
    if (std::chrono::steady_clock::now() > end) return fail("the next client gets no control", "stops", "run it again");
    pause();
  }
  counts.lost += becomes_zero(log) ? 0 : 1;
  ++counts.tries;
  return next;
}

CaseResult wait_case(const char* name, const realtime::LatencySummary& s, std::string note) {
  CaseResult result;
  result.name = name;
  result.unit = "us";
  result.figures = {s.p50_us, s.p99_us, s.p999_us, s.max_us};
  result.note = std::move(note);
  return result;
}

std::vector<CaseResult> stop_results(const StopCounts& stops, const StopCounts& passes,
                                     const realtime::LoopSummary& loop, const server::ServerReport& report) {
  constexpr double kUsPerNs = 1e-3;
  return {
      wait_case("stops/seen-after", realtime::summarise(report.stops.waits),
                fmt::format("{} stops, 0 lost; {} starts found the queue full", stops.tries, stops.starts_refused)),
      {"stops/seen-after-on-time",
       "us",
       figure_of(kUsPerNs * static_cast<double>(report.stops.longest_on_time_ns)),
       {},
       "the largest, without the lateness of the tick that saw it"},
      wait_case("stops/lateness", loop.lateness,
                fmt::format("of the loop meanwhile; {} of {} periods missed", loop.missed, loop.periods)),
      {"stops/zero-after", "ms", figures_of(stops.falls_ms), {}, "from the tick that saw the stop"},
      {"stops/zero-after-full-force",
       "ms",
       figures_of(stops.full_falls_ms),
       {},
       fmt::format("{} stops of a full force", stops.full_falls_ms.size())},
      {"stops/control-passed",
       "n",
       figure_of(passes.tries),
       {},
       fmt::format("clients that left behind a flood, 0 kept forces; {} starts found the queue full; {} faults of a "
                   "slow loop in all",
                   passes.starts_refused, stops.faults + passes.faults)}};
}

}  // namespace

Result<std::vector<CaseResult>> run_stops_benchmark(const Options& options) {
  const TemporaryFolder folder;
  server::ServerOptions server_options;
  TROCAR_TRY(server_options.endpoint, link::parse_endpoint("ipc://" + (folder / "needle").string()));
  server_options.tissues_file = data_dir() / "tissues.toml";
  TROCAR_TRY(stylus::DevicePreset preset, stylus::load_device_preset(data_dir() / "devices.toml", "premium"));
  WeightDevice::Log log;
  const auto opener = [](const std::string&, std::uint64_t, const Progress&) {
    return make_flat_patient({{0.0, "adipose"}, {12.0, "muscle"}, {24.0, "liver"}});
  };
  TROCAR_TRY(
      server::HapticServer server,
      server::HapticServer::start(server_options, std::make_unique<WeightDevice>(std::move(preset), log), opener));
  TROCAR_TRY(link::HapticClient client, connect_to(server));
  TROCAR_TRY_STATUS(client.ask(flat_request(), kReplyPatience));
  StopCounts stops, passes;
  while (stops.tries < kStops) {
    TROCAR_TRY_STATUS(try_stop(client, log, stops));
    if (options.progress) options.progress("stops", static_cast<double>(stops.tries) / kStops);
  }
  const realtime::LoopSummary loop = client.view().status.loop;
  while (passes.tries < kPasses) {
    TROCAR_TRY(client, try_pass(server, std::move(client), log, passes));
  }
  const server::ServerReport report = server.stop();
  if (stops.lost + passes.lost > 0)
    return fail(fmt::format("{} of {} stops were lost, and {} of {} clients left their forces on", stops.lost,
                            stops.tries, passes.lost, passes.tries),
                "stops", "this is a fault of the server");
  return stop_results(stops, passes, loop, report);
}

}  // namespace trocar::bench
