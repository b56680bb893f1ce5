// Ultrasound frames of the embedded patient with a moving transducer: time and allocations of engine and scanner.
#include "bench/benchmarks.h"
#include "bench/calibration.h"
#include "bench/images/scan_rounds.h"
#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/probe/probe_placement.h"

namespace trocar::bench {
namespace {

/// A scan to time.
struct Setting {
  std::string name;
  std::string transducer;
  int steering_angles = 3;
  double renewed_share = 1.0;  ///< Share of the scanlines that a picture renews.
  bool is_harmonic = false;
};

}  // namespace

Result<std::vector<CaseResult>> run_ultrasound_benchmark(const Options& options) {
  core::report(options.progress, "patient", 0.0);
  TROCAR_TRY(const anatomy::VirtualPatient patient, phantom::generate_phantom("abdomen", 1, {{512, 512, 119}}));
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  TROCAR_TRY(const ultrasound::ProbeView view, ultrasound::choose_view(patient, views, "liver-right-kidney"));

  std::vector<CaseResult> results;
  std::shared_ptr<const ultrasound::AcousticScene> scene;
  const double scene_us = time_us([&] {
    if (auto made = ultrasound::make_acoustic_scene(patient, std::move(table))) scene = *std::move(made);
  });
  if (scene == nullptr)
    return fail("the embedded patient has no acoustic scene", "bench ultrasound", "check data/acoustics.toml");
  Figures scene_ms;
  scene_ms.median = scene_us / kMsPerS;
  results.push_back({"raycast/scene", "ms", scene_ms, {}, "once for a patient of 512x512x119 voxels"});

  const Setting settings[] = {{"raycast/256x1024x5", "C5-2", 3},
                              {"raycast/256x1024x5-one-look", "C5-2", 1},
                              {"raycast/liver-sweep", "liver-sweep", 3},
                              {"raycast/linear", "L14-5", 3},
                              {"raycast/rolling-quarter", "C5-2", 3, 0.25},
                              {"raycast/rolling-eighth", "C5-2", 3, 0.125},
                              {"raycast/harmonic", "C5-2", 3, 1.0, true}};
  double fraction = 0.2;
  for (const Setting& setting : settings) {
    core::report(options.progress, setting.name, fraction);
    fraction += 0.8 / static_cast<double>(std::size(settings));
    TROCAR_TRY(const ultrasound::Transducer transducer,
               ultrasound::load_transducer(data_dir() / "transducers.toml", setting.transducer));
    TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(patient, view, transducer));
    ultrasound::Acquisition acquisition = ultrasound::default_acquisition(transducer);
    acquisition.steering_angles = setting.steering_angles;
    acquisition.is_harmonic = setting.is_harmonic;
    ultrasound::BMode engine(scene, transducer, acquisition);
    const ScanBest best = measure_scan(engine, placed.X_PT, {}, setting.renewed_share);
    if (&setting == settings)
      results.push_back({"calibration/arithmetic", "us", best.calibration, {}, "a fixed loop, after each frame"});
    append_scan(setting.name, best, results);
    Figures lines;
    lines.median = setting.renewed_share * acquisition.lines * kMsPerS / *best.frame.median;
    results.push_back({setting.name + "/lines", "1/s", lines, {}, "renewed scanlines"});
  }
  return results;
}

}  // namespace trocar::bench
