#include "ultrasound/doppler/doppler_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ultrasound/engine/beam.h"

namespace trocar::ultrasound {
namespace {

constexpr double kSpeed_cm_per_s = kScannerSpeed_mm_per_us * 1e5;
constexpr double kSpeed_mm_per_s = kScannerSpeed_mm_per_us * 1e6;
constexpr double kHz_per_MHz = 1e6;
constexpr double kLeastCosine = 0.0175;  // 89 degrees

struct Control {
  const char* name;
  double DopplerSettings::*value;
  double low, high;
};
constexpr Control kControls[] = {{"scale", &DopplerSettings::scale_cm_per_s, 2.0, 200.0},
                                 {"frequency", &DopplerSettings::frequency_mhz, 1.0, 15.0},
                                 {"wall filter", &DopplerSettings::wall_filter, 0.0, 0.6},
                                 {"colour gain", &DopplerSettings::gain_db, -40.0, 40.0},
                                 {"persistence", &DopplerSettings::persistence, 0.0, 0.95},
                                 {"baseline", &DopplerSettings::baseline, -0.9, 0.9}};

bool is_box(const DopplerBox& box) noexcept {
  return box.first_line >= 0.0 && box.first_line < box.last_line && box.last_line <= 1.0 && box.near >= 0.0 &&
         box.near < box.far && box.far <= 1.0;  // false for NaN
}

}  // namespace

Status check(const DopplerSettings& settings) {
  for (const Control& control : kControls) {
    const double value = settings.*control.value;
    if (value >= control.low && value <= control.high) continue;
    return fail_usage(fmt::format("the Doppler {} is {}", control.name, value), "settings",
                      fmt::format("give {} to {}", control.low, control.high));
  }
  if (settings.write_priority < 0 || settings.write_priority > 255)
    return fail_usage(fmt::format("the write priority is {}", settings.write_priority), "settings", "give 0 to 255");
  if (settings.ensemble < 3 || settings.ensemble > 32)
    return fail_usage(fmt::format("the ensemble is {}", settings.ensemble), "settings", "give 3 to 32");
  if (!is_box(settings.box))
    return fail_usage("the colour box is empty or reaches beyond the picture", "settings",
                      "give shares of width and depth: first < last, near < far, 0 to 1");
  return {};
}

DopplerSettings within_ranges(const DopplerSettings& settings) noexcept {
  DopplerSettings held = settings;
  const DopplerSettings defaults;
  for (const Control& control : kControls) {
    double& value = held.*control.value;
    value = std::isnan(value) ? defaults.*control.value : std::clamp(value, control.low, control.high);
  }
  held.write_priority = std::clamp(held.write_priority, 0, 255);
  held.ensemble = std::clamp(held.ensemble, 3, 32);
  if (!is_box(held.box)) held.box = defaults.box;
  return held;
}

double nyquist_cm_per_s(double prf_hz, double frequency_mhz) noexcept {
  return kSpeed_cm_per_s * prf_hz / (4.0 * frequency_mhz * kHz_per_MHz);
}

double prf_hz(double nyquist_cm_per_s, double frequency_mhz) noexcept {
  return 4.0 * frequency_mhz * kHz_per_MHz * nyquist_cm_per_s / kSpeed_cm_per_s;
}

double usable_scale_cm_per_s(const DopplerSettings& settings, double deepest_mm) noexcept {
  const double highest_prf_hz = kSpeed_mm_per_s / (2.0 * deepest_mm);
  return std::min(settings.scale_cm_per_s, nyquist_cm_per_s(highest_prf_hz, settings.frequency_mhz));
}

double doppler_shift_hz(double velocity_cm_per_s, double angle_rad, double frequency_mhz) noexcept {
  return 2.0 * frequency_mhz * kHz_per_MHz * velocity_cm_per_s * std::cos(angle_rad) / kSpeed_cm_per_s;
}

double FlowCaliper::angle_rad(const ScanGeometry& scan) const noexcept {
  const Vec2 beam = scan.line_direction(scan.to_polar(p_T).line);
  const double length = along_T.norm();
  const double cosine = length > 0.0 ? std::abs(beam.dot(along_T)) / length : 0.0;
  return std::acos(std::min(cosine, 1.0));
}

double FlowCaliper::corrected_cm_per_s(double along_beam_cm_per_s, const ScanGeometry& scan) const noexcept {
  const double cosine = std::cos(angle_rad(scan));
  return cosine >= kLeastCosine ? along_beam_cm_per_s / cosine : 0.0;
}

}  // namespace trocar::ultrasound
