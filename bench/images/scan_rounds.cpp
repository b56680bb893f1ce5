#include "bench/images/scan_rounds.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>

#include "bench/allocation_count.h"
#include "bench/calibration.h"
#include "bench/processor_time.h"
#include "ultrasound/scanner/scanner.h"
#include "ultrasound/sweep/freehand_sweep.h"

namespace trocar::bench {
namespace {

constexpr int kFrames = 120;
constexpr int kWarmUp = 5;
constexpr int kPictureColumns = 640, kPictureRows = 480;

struct ScanRound {
  std::vector<double> frame_ms, engine_ms, scanner_ms, calibration_us;
  double allocations_a_frame = 0.0;
  double cpu_ms_a_frame = 0.0;  ///< Of all threads.
};

/// Scanlines of picture n of a rolling acquisition.
ultrasound::LineRange lines_of(int n, int lines, double share) {
  if (share >= 1.0) return {};
  const int count = static_cast<int>(share * lines), pictures = lines / count,
            part = ((n % pictures) + pictures) % pictures;
  return {part * count, (part + 1) * count};
}

ScanRound measure_round(ultrasound::EchoEngine& engine, ultrasound::Scanner& scanner, const Pose& X_PT,
                        std::span<const ultrasound::NeedleEcho> needles, double renewed_share, int first_frame) {
  ScanRound round;
  for (auto* list : {&round.frame_ms, &round.engine_ms, &round.scanner_ms, &round.calibration_us})
    list->reserve(kFrames);
  volatile double sink = 0.5;
  const AllocationCount allocations;
  const double cpu_before_ms = processor_time_ms();
  for (int n = first_frame; n < first_frame + kFrames; ++n) {
    const Pose X_PT_now = ultrasound::sway(X_PT, n);
    const ultrasound::BasebandFrame* echoes = nullptr;
    const double engine_us = time_us([&] {
      echoes = &engine.render({X_PT_now, needles, n / 60.0, lines_of(n, engine.geometry().lines, renewed_share)});
    });
    const double scanner_us = time_us([&] { scanner.show(*echoes, static_cast<std::uint64_t>(n)); });
    round.calibration_us.push_back(time_us([&] { sink = calibration_arithmetic(sink); }));
    round.engine_ms.push_back(engine_us / kMsPerS);
    round.scanner_ms.push_back(scanner_us / kMsPerS);
    round.frame_ms.push_back((engine_us + scanner_us) / kMsPerS);
  }
  round.allocations_a_frame = static_cast<double>(allocations.count()) / kFrames;
  round.cpu_ms_a_frame = (processor_time_ms() - cpu_before_ms) / kFrames;
  return round;
}

std::string load_note() {
  double load = 0.0;
  return ::getloadavg(&load, 1) == 1 ? fmt::format("load {:.1f}", load) : std::string("load unknown");
}

/// Frames per second; the tail value is reached by 99 of 100 frames.
Figures frames_per_s(const Figures& frame_ms) {
  Figures figures;
  figures.median = kMsPerS / *frame_ms.median;
  if (frame_ms.p99) figures.p99 = kMsPerS / *frame_ms.p99;
  return figures;
}

}  // namespace

ScanBest measure_scan(ultrasound::EchoEngine& engine, const Pose& X_PT, std::span<const ultrasound::NeedleEcho> needles,
                      double renewed_share) {
  ultrasound::Scanner scanner(kPictureColumns, kPictureRows);
  for (int n = 0; n < kWarmUp; ++n) scanner.show(engine.render({ultrasound::sway(X_PT, -n), needles, 0.0}), 1);
  ScanBest best;
  for (int round = 0; round < kRounds; ++round) {
    ScanRound taken = measure_round(engine, scanner, X_PT, needles, renewed_share, round * kFrames);
    best.allocations_a_frame = std::max(best.allocations_a_frame, taken.allocations_a_frame);
    best.cpu_ms_a_frame = round == 0 ? taken.cpu_ms_a_frame : std::min(best.cpu_ms_a_frame, taken.cpu_ms_a_frame);
    const Figures frame = figures_of(std::move(taken.frame_ms));
    if (round > 0 && *frame.median >= *best.frame.median) continue;
    best.frame = frame;
    best.engine = figures_of(std::move(taken.engine_ms));
    best.scanner = figures_of(std::move(taken.scanner_ms));
    best.calibration = figures_of(std::move(taken.calibration_us));
  }
  return best;
}

void append_scan(const std::string& name, const ScanBest& best, std::vector<CaseResult>& results) {
  results.push_back(
      {name,
       "fps",
       frames_per_s(best.frame),
       {},
       fmt::format("moving transducer, 640x480, best of {} rounds of {} frames; {}", kRounds, kFrames, load_note())});
  results.push_back({name + "/frame", "ms", best.frame, {}, {}});
  results.push_back({name + "/engine", "ms", best.engine, {}, {}});
  results.push_back({name + "/scanner", "ms", best.scanner, {}, {}});
  Figures cpu;
  cpu.median = best.cpu_ms_a_frame;
  results.push_back({name + "/cpu", "ms", cpu, {}, "processor time a frame, all threads, mean of the best round"});
  Figures allocations;
  allocations.median = best.allocations_a_frame;
  results.push_back({name + "/allocations", "n", allocations, {}, "a frame, operator new of all threads, worst round"});
  Figures ratio;
  ratio.median = *best.frame.median * kMsPerS / *best.calibration.median;
  results.push_back({name + "-to-calibration", "ratio", ratio, {}, "a frame to the fixed loop after it, medians"});
}

}  // namespace trocar::bench
