// One haptic tick, call by call, on its way through the embedded patient; a fixed piece of arithmetic interleaved, so
// that figures of noisy machines can be held against it.

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "anatomy/phantom/phantom.h"
#include "bench/benchmarks.h"
#include "haptics/tick.h"
#include "headless/needle_geometry.h"
#include "headless/prepare_case.h"

namespace trocar::bench {
namespace {

constexpr double kDt_s = 0.001;
constexpr double kSpeed_mm_per_s = 10.0;
constexpr int kRounds = 5;

template <class Work>
double time_us(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// A chain of multiplications and additions that nothing can shorten: about 8 us, the same on every call.
double calibration_arithmetic(double x) noexcept {
  constexpr int kSteps = 5000;
  for (int i = 0; i < kSteps; ++i) x = x * 0.999 + 0.001;
  return x;
}

struct Round {
  std::vector<double> tick_us;
  std::vector<double> calibration_us;
};

/// In along the planned path and out again, a calibration after each tick.
Round measure_round(const HapticScene& scene, const Segment& path_P) {
  Round round;
  auto state = std::make_unique<HapticState>();  // some tens of kB
  const double length = path_P.length_mm();
  const auto count = static_cast<int>(2.0 * (length + 10.0) / (kSpeed_mm_per_s * kDt_s));
  volatile double sink = 0.5;
  for (int i = 0; i < count; ++i) {
    const double way = kSpeed_mm_per_s * kDt_s * i;
    const double depth = way < length + 10.0 ? way - 10.0 : 2.0 * length + 10.0 - way;
    const Pose X_PN = needle_pose(path_P.a + depth * path_P.direction(), path_P.direction());
    const HapticInput input{i * kDt_s, kDt_s, scene.X_PD.inverse() * X_PN * scene.X_SN.inverse()};
    round.tick_us.push_back(time_us([&] { sink = sink + tick(*state, input, scene).f_D.x(); }));
    round.calibration_us.push_back(time_us([&] { sink = calibration_arithmetic(sink); }));
  }
  return round;
}

}  // namespace

Result<std::vector<CaseResult>> run_haptics_benchmark() {
  TROCAR_TRY(VirtualPatient generated, generate_phantom("abdomen"));
  TROCAR_TRY(const Case the_case, prepare_case(std::make_shared<const VirtualPatient>(std::move(generated)), {}));
  const NeedleGeometry needle = needle_geometry(the_case.needle);
  TROCAR_TRY(const auto scene, make_haptic_scene(the_case.patient, the_case.tissues, needle));

  Figures tick;
  Figures calibration;
  std::size_t calls = 0;
  for (int i = 0; i < kRounds; ++i) {
    Round round = measure_round(*scene, the_case.plan.line_P);
    calls = round.tick_us.size();
    const Figures ticks = figures_of(std::move(round.tick_us));
    if (i > 0 && *ticks.median >= *tick.median) continue;
    tick = ticks;
    calibration = figures_of(std::move(round.calibration_us));
  }
  Figures ratio;
  ratio.median = *tick.median / *calibration.median;
  const std::string note = fmt::format("{} calls, best of {} rounds", calls, kRounds);
  return std::vector<CaseResult>{{"calibration/arithmetic", "us", calibration, {}, "a fixed loop, after each tick"},
                                 {"tick/insertion", "us", tick, {}, note},
                                 {"tick/insertion-to-calibration", "ratio", ratio, {}, "of the medians"}};
}

}  // namespace trocar::bench
