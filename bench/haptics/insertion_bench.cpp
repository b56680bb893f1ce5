// Forces of an insertion into the embedded patient, for docs/validation.md: peaks by speed and profile, drop, second
// insertion.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/benchmarks.h"
#include "bench/harness.h"
#include "cases/prepare_case.h"
#include "cases/scene_request.h"
#include "haptics/tick.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {

constexpr double kBeyond_mm = 10.0;  ///< The device moves past the target: the tip lags it while a layer is loaded.

std::shared_ptr<const haptics::HapticScene> make_scene(const cases::Case& the_case) {
  const haptics::NeedleGeometry needle = cases::needle_geometry(the_case.needle);
  const auto scene = haptics::make_haptic_scene(the_case.patient, the_case.tissues, needle);
  return scene ? *scene : nullptr;
}

/// Drives the device along the planned path from one depth to another at constant speed.
std::vector<telemetry::TickSample> drive(haptics::HapticState& state, const haptics::HapticScene& scene,
                                         const Segment& path_P, double from_mm, double to_mm, double speed_mm_per_s) {
  std::vector<telemetry::TickSample> samples;
  const double step = std::copysign(speed_mm_per_s * kDt_s, to_mm - from_mm);
  const auto count = static_cast<int>(std::abs((to_mm - from_mm) / step));
  for (int i = 1; i <= count; ++i) {
    const Vec3 tip_P = path_P.a + path_P.direction() * (from_mm + step * i);
    samples.push_back(
        haptics::tick(state, {i * kDt_s, kDt_s, telemetry::to_tool_pose(needle_pose(tip_P, path_P.direction()))}, scene)
            .sample);
  }
  return samples;
}
/// Peak at each puncture, and the time in which the resistance loses half of its drop within the next 0.2 s.
void add_punctures(std::vector<CaseResult>& results, const anatomy::TissueTable& tissues,
                   const std::vector<telemetry::TickSample>& samples, const std::string& name) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const telemetry::TickEvent event = samples[i].events[0];
    if (event.kind != telemetry::EventKind::kPuncture) continue;
    const std::string layer = tissues.layers[event.id].name;
    Figures peak;
    peak.median = -samples[i].f_prepuncture_n;
    results.push_back({fmt::format("insertion/{}/{}-peak", name, layer),
                       "n",
                       peak,
                       {},
                       fmt::format("x {:.2f} mm, whole resistance {:.2f} N", samples[i].layer_displacement_mm,
                                   axial_resistance_n(samples[i])),
                       {{"x_mm", samples[i].layer_displacement_mm}}});
    const std::size_t end = std::min(samples.size() - 1, i + 200);
    double lowest = axial_resistance_n(samples[i]);
    for (std::size_t j = i; j <= end; ++j) lowest = std::min(lowest, axial_resistance_n(samples[j]));
    const double half = 0.5 * (axial_resistance_n(samples[i]) + lowest);
    std::size_t j = i;
    while (j < end && axial_resistance_n(samples[j]) > half) ++j;
    Figures drop;
    drop.median = static_cast<double>(j - i) * kDt_s * 1e3;
    results.push_back({fmt::format("insertion/{}/{}-half-drop", name, layer),
                       "ms",
                       drop,
                       {},
                       fmt::format("falls to {:.2f} N", lowest)});
  }
}

/// Force against displacement of the device before the skin is punctured: the slope of a straight line through the
/// first 5 mm, as in a test of indentation, and the mean slope up to the puncture.
void add_skin_slope(std::vector<CaseResult>& results, const std::vector<telemetry::TickSample>& samples, double step_mm,
                    const std::string& name) {
  constexpr double kFirst_mm = 5.0;
  double indentation_mm = 0.0;
  double square = 0.0;
  double product = 0.0;
  for (const telemetry::TickSample& sample : samples) {
    const double force_n = axial_resistance_n(sample);
    if (sample.phase != telemetry::InsertionPhase::kLoading && indentation_mm == 0.0) continue;
    indentation_mm += step_mm;
    if (indentation_mm <= kFirst_mm) {
      square += indentation_mm * indentation_mm;
      product += indentation_mm * force_n;
    }
    if (sample.events[0].kind != telemetry::EventKind::kPuncture) continue;
    results.push_back({fmt::format("insertion/{}/skin-slope", name),
                       "n_per_mm",
                       figure_of(product / square),
                       {},
                       fmt::format("over the first {:.0f} mm; up to the puncture, after {:.1f} mm, mean {:.3f} N/mm",
                                   kFirst_mm, indentation_mm, force_n / indentation_mm),
                       {{"puncture_mm", indentation_mm}, {"mean_n_per_mm", force_n / indentation_mm}}});
    return;
  }
}

double mean_resistance_n(const std::vector<telemetry::TickSample>& samples, double from_mm, double to_mm) {
  double sum = 0.0;
  int count = 0;
  for (const telemetry::TickSample& sample : samples) {
    if (sample.depth_mm < from_mm || sample.depth_mm > to_mm || sample.phase != telemetry::InsertionPhase::kInserted)
      continue;
    sum += axial_resistance_n(sample);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// Depth of the last puncture on a path.
double last_puncture_mm(const std::vector<telemetry::TickSample>& samples) {
  double depth = 0.0;
  for (const telemetry::TickSample& sample : samples) {
    if (sample.events[0].kind == telemetry::EventKind::kPuncture) depth = sample.depth_mm;
  }
  return depth;
}

/// The same path twice: mean resistance in the organ, after the relaxation of the coupling behind its surface.
void add_second_insertion(std::vector<CaseResult>& results, const cases::Case& the_case,
                          const haptics::HapticScene& scene) {
  haptics::HapticState state;
  const Segment& path = the_case.plan.line_P;
  const double length = path.length_mm() + kBeyond_mm;
  const auto first = drive(state, scene, path, -10.0, length, 10.0);
  drive(state, scene, path, length, -10.0, 20.0);
  const auto second = drive(state, scene, path, -10.0, length, 10.0);
  const double from = last_puncture_mm(first) + 4.0;
  const double to = first.back().depth_mm - 0.5;
  const double before = mean_resistance_n(first, from, to);
  const double after = mean_resistance_n(second, from, to);
  Figures difference;
  difference.median = before - after;
  results.push_back(
      {"insertion/second-in-same-channel",
       "n",
       difference,
       {},
       fmt::format("first {:.3f} N, second {:.3f} N, means from {:.0f} to {:.0f} mm deep", before, after, from, to),
       {{"first_n", before}, {"second_n", after}}});
}

}  // namespace

Result<std::vector<CaseResult>> run_insertion_benchmark(const Options& options) {
  std::shared_ptr<const anatomy::VirtualPatient> patient = options.patient;
  if (!patient) {
    TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom("abdomen"));
    patient = std::make_shared<const anatomy::VirtualPatient>(std::move(generated));
  }
  std::vector<CaseResult> results;
  for (const char* profile : {"paper-a", "tented"}) {
    cases::CaseOptions case_options;
    case_options.profile = profile;
    TROCAR_TRY(const cases::Case the_case, cases::prepare_case(patient, case_options));
    const auto scene = make_scene(the_case);
    if (!scene) return fail("the scene could not be built", "bench insertion", "check data/tissues.toml");
    for (const double speed : {2.0, 10.0, 50.0}) {
      haptics::HapticState state;
      const auto samples =
          drive(state, *scene, the_case.plan.line_P, -10.0, the_case.plan.length_mm + kBeyond_mm, speed);
      const std::string name = fmt::format("{}-{:.0f}mm_s", profile, speed);
      add_skin_slope(results, samples, speed * kDt_s, name);
      add_punctures(results, the_case.tissues, samples, name);
    }
    if (std::string_view(profile) == "paper-a") add_second_insertion(results, the_case, *scene);
  }
  return results;
}

}  // namespace trocar::bench
