// One haptic tick, call by call, in the embedded patient, interleaved with a fixed calculation that makes figures of
// noisy machines comparable.

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>

#include "bench/benchmarks.h"
#include "bench/calibration.h"
#include "cases/prepare_case.h"
#include "cases/scene_request.h"
#include "haptics/tick.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {

constexpr double kSpeed_mm_per_s = 10.0;

struct TickRound {
  std::vector<double> tick_us;
  std::vector<double> calibration_us;
};

/// In along the planned path and out again, with an offset and a tilt that bend the shaft; a calibration after each
/// tick.
TickRound measure_round(const haptics::HapticScene& scene, const Segment& path_P) {
  TickRound round;
  auto state = std::make_unique<haptics::HapticState>();  // some hundred kB
  const double length = path_P.length_mm();
  const auto count = static_cast<int>(2.0 * (length + 10.0) / (kSpeed_mm_per_s * kDt_s));
  const Vec3 across = path_P.direction().unitOrthogonal();
  volatile double sink = 0.5;
  for (int i = 0; i < count; ++i) {
    const double way = kSpeed_mm_per_s * kDt_s * i;
    const double depth = way < length + 10.0 ? way - 10.0 : 2.0 * length + 10.0 - way;
    const double sway = std::sin(0.002 * i);
    const Vec3 axis = (path_P.direction() + 0.03 * sway * across).normalized();
    const Pose X_PN = needle_pose(path_P.a + depth * path_P.direction() + 1.5 * sway * across, axis);
    const haptics::HapticInput input{i * kDt_s, kDt_s, telemetry::to_tool_pose(X_PN)};
    round.tick_us.push_back(time_us([&] { sink = sink + tick(*state, input, scene).total_W.force_n.x(); }));
    round.calibration_us.push_back(time_us([&] { sink = calibration_arithmetic(sink); }));
  }
  return round;
}

/// The best of the rounds, and its ratio to the calibration.
struct BestTicks {
  Figures tick, calibration;
  std::size_t calls = 0;
};
BestTicks measure(const haptics::HapticScene& scene, const Segment& path_P) {
  BestTicks best;
  for (int i = 0; i < kRounds; ++i) {
    TickRound round = measure_round(scene, path_P);
    best.calls = round.tick_us.size();
    const Figures ticks = figures_of(std::move(round.tick_us));
    if (i > 0 && *ticks.median >= *best.tick.median) continue;
    best.tick = ticks;
    best.calibration = figures_of(std::move(round.calibration_us));
  }
  return best;
}

void append_case(std::vector<CaseResult>& results, const std::string& name, const BestTicks& best) {
  if (results.empty())
    results.push_back({"calibration/arithmetic", "us", best.calibration, {}, "a fixed loop, after each tick"});
  results.push_back({name, "us", best.tick, {}, fmt::format("{} calls, best of {} rounds", best.calls, kRounds)});
  Figures ratio;
  ratio.median = *best.tick.median / *best.calibration.median;
  ratio.p99 = *best.tick.p99 / *best.calibration.p99;
  ratio.p999 = *best.tick.p999 / *best.calibration.p999;
  results.push_back({name + "-to-calibration", "ratio", ratio, {}, "median by median, tail by tail"});
}

}  // namespace

Result<std::vector<CaseResult>> run_haptics_benchmark() {
  phantom::PhantomResolution resolution;
  resolution.size = {512, 512, 119};
  TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom("abdomen", 1, resolution));
  TROCAR_TRY(const cases::Case the_case,
             cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(generated)), {}));
  const haptics::NeedleGeometry needle = cases::needle_geometry(the_case.needle);

  std::vector<CaseResult> results;
  constexpr std::array<std::pair<haptics::ForceModel, const char*>, 3> kCases{
      {{haptics::ForceModel::kProxy, "tick/needle16-bending"},
       {haptics::ForceModel::kCombined, "tick/combined16-bending"},
       {haptics::ForceModel::kInsertion, "tick/insertion"}}};
  for (const auto& [model, name] : kCases) {
    haptics::HapticOptions options;
    options.force_model = model;
    TROCAR_TRY(const auto scene, haptics::make_haptic_scene(the_case.patient, the_case.tissues, needle, {}, options));
    append_case(results, name, measure(*scene, the_case.plan.line_P));
  }
  return results;
}

}  // namespace trocar::bench
