// The live ultrasound of the trainer beside two live 1 kHz servers and a thread that draws without a pause, as the
// window does on a machine without a graphics card.
#include <fmt/format.h>

#include <array>
#include <thread>

#include "bench/benchmarks.h"
#include "bench/training/stations.h"
#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "ultrasound/live/live_scanner.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/sweep/freehand_sweep.h"

namespace trocar::bench {
namespace {

using namespace std::chrono_literals;

constexpr double kRate_hz = 1000.0;
constexpr double kRequests_hz = 30.0;  ///< Frames of the window.

/// Pictures of a moving transducer during a time.
struct Seen {
  std::vector<double> took_ms;
  std::array<int, ultrasound::kScanDetails> of_detail{};
  double seconds = 0.0;
};

Seen watch(ultrasound::LiveScanner& scanner, ultrasound::ScanRequest request, const Pose& X_PT, Stations& stations,
           double seconds) {
  Seen seen;
  std::uint64_t last = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto time_s = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  for (int n = 0; time_s() < seconds; ++n) {
    request.X_PT = ultrasound::sway(X_PT, n);
    request.time_s = time_s();
    scanner.request(request);
    for (Station& station : stations) {
      station.client.take_samples();
      station.client.frame_drawn();
    }
    std::this_thread::sleep_until(start + std::chrono::duration<double>((n + 1) / kRequests_hz));
    const auto picture = scanner.pictures().value();
    if (!picture || picture->number == last) continue;
    last = picture->number;
    seen.took_ms.push_back(picture->took_ms);
    ++seen.of_detail[static_cast<std::size_t>(picture->detail)];
  }
  seen.seconds = time_s();
  return seen;
}

void append(const Seen& seen, Stations& stations, std::vector<CaseResult>& results) {
  const auto count = [&](ultrasound::ScanDetail detail) { return seen.of_detail[static_cast<std::size_t>(detail)]; };
  results.push_back({"live/ultrasound",
                     "fps",
                     figure_of(static_cast<double>(seen.took_ms.size()) / seen.seconds),
                     {},
                     fmt::format("renewed pictures: {} fast, {} middle, {} full; requests at {:.0f} Hz",
                                 count(ultrasound::ScanDetail::kFast), count(ultrasound::ScanDetail::kMiddle),
                                 count(ultrasound::ScanDetail::kFull), kRequests_hz)});
  results.push_back({"live/ultrasound/picture", "ms", figures_of(seen.took_ms), {}, {}});
  for (Station& station : stations) {
    const realtime::LoopSummary loop = station.client.view().status.loop;
    const realtime::LatencySummary& lateness = loop.lateness;
    results.push_back({fmt::format("live/{}/lateness", station.tool),
                       "us",
                       {lateness.p50_us, lateness.p99_us, lateness.p999_us, lateness.max_us},
                       {},
                       fmt::format("{} of {} periods missed", loop.missed, loop.periods)});
  }
}

}  // namespace

Result<std::vector<CaseResult>> run_live_benchmark(const Options& options) {
  core::report(options.progress, "patient", 0.0);
  TROCAR_TRY(anatomy::VirtualPatient abdomen, phantom::generate_phantom("abdomen"));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(abdomen));
  TROCAR_TRY(const cases::Case the_case, cases::prepare_case(patient, {}));
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  TROCAR_TRY(const ultrasound::ProbeView view, ultrasound::choose_view(*patient, views, "liver-right-kidney"));
  TROCAR_TRY(const ultrasound::Transducer transducer,
             ultrasound::load_transducer(data_dir() / "transducers.toml", "C5-2"));
  TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(*patient, view, transducer));
  TROCAR_TRY(const auto scene, ultrasound::make_acoustic_scene(*patient, std::move(table)));

  const TemporaryFolder folder;
  TROCAR_TRY(Stations stations,
             start_stations(folder, the_case, kRate_hz, options.force_model.value_or(haptics::ForceModel::kProxy)));
  const MovingHands hands(stations, the_case);
  std::jthread drawing([&](const std::stop_token& stop) {
    volatile double shown = 0.0;
    while (!stop.stop_requested())
      shown = shown + draw_slices(patient->ct, the_case.plan.line_P.a, the_case.plan.line_P.direction());
  });
  ultrasound::LiveScanner scanner;
  scanner.open(scene, transducer);
  ultrasound::ScanRequest request;
  request.acquisition = ultrasound::default_acquisition(transducer);
  watch(scanner, request, placed.X_PT, stations, 3.0);  // past the safe start; the scanner learns its times
  for (Station& station : stations)
    TROCAR_TRY_STATUS(station.client.ask(link::ServerCommand::kRestartStatistics, kPatience));
  core::report(options.progress, "servers and ultrasound are running", 0.4);
  const Seen seen = watch(scanner, request, placed.X_PT, stations, options.seconds);
  std::vector<CaseResult> results;
  append(seen, stations, results);
  return results;
}

}  // namespace trocar::bench
