// Cost of a B-mode frame against scanlines, depth, planes, threads and the levels of detail of a live image.
#include <fmt/format.h>

#include <optional>

#include "bench/benchmarks.h"
#include "bench/calibration.h"
#include "bench/processor_time.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "phantom/phantom.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/live/scan_picture.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/sweep/freehand_sweep.h"

namespace trocar::bench {
namespace {

constexpr int kCostFrames = 40;
constexpr int kCostWarmUp = 4;
constexpr int kCostRounds = 3;  ///< The best median counts.

struct CostSubject {
  std::shared_ptr<const ultrasound::AcousticScene> scene;
  ultrasound::Transducer transducer;
  Pose X_PT;
  ultrasound::Acquisition usual;
};

void add_case(const CostSubject& subject, const std::string& name, const ultrasound::Acquisition& acquisition,
              int threads, std::vector<CaseResult>& results) {
  std::optional<Figures> best;
  double cpu_ms = 0.0;
  run_on_threads(threads, [&] {
    ultrasound::BMode engine(subject.scene, subject.transducer, acquisition);
    for (int n = 0; n < kCostWarmUp; ++n) engine.render({ultrasound::sway(subject.X_PT, n), {}, 0.0});
    for (int round = 0; round < kCostRounds; ++round) {
      std::vector<double> frame_ms;
      const double cpu_before_ms = processor_time_ms();
      for (int n = 0; n < kCostFrames; ++n)
        frame_ms.push_back(time_us([&] { engine.render({ultrasound::sway(subject.X_PT, n), {}, 0.0}); }) / kMsPerS);
      const double took_ms = (processor_time_ms() - cpu_before_ms) / kCostFrames;
      const Figures figures = figures_of(std::move(frame_ms));
      if (best && *figures.median >= *best->median) continue;
      best = figures;
      cpu_ms = took_ms;
    }
  });
  results.push_back({"ultrasound-cost/" + name, "ms", *best, {}, fmt::format("{:.1f} ms of processor time", cpu_ms)});
}

void vary_size(const CostSubject& subject, std::vector<CaseResult>& results) {
  constexpr int kThreads = 2;
  for (const int lines : {128, 256, 512}) {
    ultrasound::Acquisition a = subject.usual;
    a.lines = lines;
    add_case(subject, fmt::format("lines-{}", lines), a, kThreads, results);
  }
  for (const double depth_mm : {80.0, 120.0, 160.0, 240.0}) {
    ultrasound::Acquisition a = subject.usual;
    a.depth_mm = depth_mm;
    add_case(subject, fmt::format("depth-{:.0f}mm", depth_mm), a, kThreads, results);
  }
  for (const int planes : {3, 5, 9}) {
    ultrasound::Acquisition a = subject.usual;
    a.planes = planes;
    add_case(subject, fmt::format("planes-{}", planes), a, kThreads, results);
  }
  for (const double scatterers : {4.0, 2.0}) {
    ultrasound::Acquisition a = subject.usual;
    a.scatterers = scatterers;
    add_case(subject, fmt::format("scatterers-{:.0f}", scatterers), a, kThreads, results);
  }
}

}  // namespace

Result<std::vector<CaseResult>> run_ultrasound_cost_benchmark(const Options& options) {
  core::report(options.progress, "patient", 0.0);
  TROCAR_TRY(const anatomy::VirtualPatient patient, phantom::generate_phantom("abdomen", 1, {{512, 512, 119}}));
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  TROCAR_TRY(const ultrasound::ProbeView view, ultrasound::choose_view(patient, views, "liver-right-kidney"));
  CostSubject subject;
  TROCAR_TRY(subject.scene, ultrasound::make_acoustic_scene(patient, std::move(table)));
  TROCAR_TRY(subject.transducer, ultrasound::load_transducer(data_dir() / "transducers.toml", "C5-2"));
  TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(patient, view, subject.transducer));
  subject.X_PT = placed.X_PT;
  subject.usual = ultrasound::default_acquisition(subject.transducer);

  std::vector<CaseResult> results;
  core::report(options.progress, "scanlines, depth, planes", 0.2);
  vary_size(subject, results);
  core::report(options.progress, "threads", 0.6);
  for (const int threads : {1, 2, 4, 8})
    add_case(subject, fmt::format("threads-{}", threads), subject.usual, threads, results);
  core::report(options.progress, "levels of detail", 0.8);
  const std::pair<const char*, ultrasound::ScanDetail> levels[] = {{"fast", ultrasound::ScanDetail::kFast},
                                                                   {"middle", ultrasound::ScanDetail::kMiddle},
                                                                   {"full", ultrasound::ScanDetail::kFull}};
  for (const auto& [name, level] : levels)
    add_case(subject, fmt::format("level-{}", name), ultrasound::with_detail(subject.usual, level), 1, results);
  return results;
}

}  // namespace trocar::bench
