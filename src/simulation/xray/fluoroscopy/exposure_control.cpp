#include "xray/fluoroscopy/exposure_control.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace trocar::xray {
namespace {

constexpr int kMeters = 12;  ///< Rays along each edge of the metering field.
/// Body (g/cm²) behind which more than half of the beam arrives: direct radiation, and the edge of the body.
constexpr double kThinBody = 3.0;
constexpr std::size_t kFewRays = kMeters * kMeters / 20;  ///< As for the display's window.
constexpr double kStep_kv = 2.0;
constexpr double kRise_kv = 10.0;  ///< If the current does not suffice.
constexpr double kNgy_per_mgy = 1e6;
constexpr double kSeconds_per_min = 60.0;

using RayMasses = std::vector<std::array<double, kBases>>;

/// Masses on rays in the middle half of the collimated field.
RayMasses metering_rays(const MassImage& patient, const CArm& arm) {
  RayMasses rays;
  if (patient.size() == 0) return RayMasses(1);
  for (int v = 0; v < kMeters; ++v)
    for (int u = 0; u < kMeters; ++u) {
      const auto pixel = [](int n, double share, int pixels) {
        const double place = 0.5 + 0.5 * share * ((n + 0.5) / kMeters - 0.5);
        return std::min(static_cast<std::size_t>(place * pixels), static_cast<std::size_t>(pixels - 1));
      };
      const std::size_t n = pixel(v, arm.collimation[1], patient.rows) * static_cast<std::size_t>(patient.columns) +
                            pixel(u, arm.collimation[0], patient.columns);
      std::array<double, kBases> masses{};
      for (std::size_t basis = 0; basis < kBases; ++basis)
        if (!patient.g_per_cm2[basis].empty()) masses[basis] = patient.g_per_cm2[basis][n];
      rays.push_back(masses);
    }
  return rays;
}

double body_of(const std::array<double, kBases>& masses) noexcept {
  return masses[0] + masses[1];
}

/// The rays that are measured: those behind the body. Where it covers next to nothing of the field, all.
RayMasses rays_behind_body(RayMasses rays) {
  for (const double least : {kThinBody, 0.0}) {
    RayMasses behind;
    std::copy_if(rays.begin(), rays.end(), std::back_inserter(behind),
                 [&](const auto& masses) { return body_of(masses) > least; });
    if (behind.size() > kFewRays) return behind;
  }
  return rays;
}

double mean_body(const RayMasses& rays) {
  double sum = 0.0;
  for (const auto& masses : rays) sum += body_of(masses);
  return sum / static_cast<double>(rays.size());
}

double mean_signal(const RayMasses& rays, const Beam& beam) {
  double sum = 0.0;
  for (const auto& masses : rays) sum += beam.signal(masses);
  return sum / static_cast<double>(rays.size());
}

double wanted_ngy(DoseMode mode, const CArm& arm, const ExposureLimits& limits) noexcept {
  constexpr double kMost = 3.0;
  const double magnified = std::clamp(limits.field_mm / arm.field_mm, 1.0 / kMost, kMost);
  if (mode == DoseMode::kAcquisition) return magnified * limits.acquisition_ngy;
  return magnified * limits.detector_ngy * (mode == DoseMode::kLow ? 0.5 : mode == DoseMode::kHigh ? 2.0 : 1.0);
}

/// Most mAs of a pulse.
double most_mas(DoseMode mode, double kerma_mgy_per_mas, double pulses_per_s, const ExposureLimits& limits) noexcept {
  if (mode == DoseMode::kAcquisition) return limits.most_acquisition_mas;
  const double by_rate = limits.most_mgy_per_min / (kSeconds_per_min * pulses_per_s * kerma_mgy_per_mas);
  return std::max(limits.least_mas, std::min(limits.most_mas, by_rate));
}

}  // namespace

Result<Beam> BeamCache::beam(const Tube& tube) {
  const std::array<double, 3> key{tube.kv, tube.aluminium_mm, tube.copper_mm};
  if (const auto found = beams_.find(key); found != beams_.end()) return found->second;
  TROCAR_TRY(const Spectrum spectrum, tube_spectrum(tube));
  TROCAR_TRY(Beam beam, Beam::make(spectrum, scintillator_mm_));
  return beams_.emplace(key, std::move(beam)).first->second;
}

double kv_of_body(double g_per_cm2, const ExposureLimits& limits) noexcept {
  constexpr double kBase_kv = 60.0, kThin = 8.0, kSlope = 2.5;
  const double kv = kBase_kv + kSlope * std::max(0.0, g_per_cm2 - kThin);
  return std::clamp(kStep_kv * std::round(kv / kStep_kv), limits.least_kv, limits.most_kv);
}

Result<Exposure> control_exposure(const MassImage& patient, const CArm& arm, const Tube& filters, DoseMode mode,
                                  double pulses_per_s, const ExposureLimits& limits, BeamCache& beams) {
  const RayMasses rays = rays_behind_body(metering_rays(patient, arm));
  Exposure exposure{filters, 0.0, false};
  exposure.tube.kv = kv_of_body(mean_body(rays), limits);
  for (;;) {
    TROCAR_TRY(const Beam beam, beams.beam(exposure.tube));
    const double kerma_mgy = beam.air_kerma_mgy();
    const double per_mas_ngy = kNgy_per_mgy * at_distance(kerma_mgy, arm.source_detector_mm) * mean_signal(rays, beam);
    const double wanted = wanted_ngy(mode, arm, limits) / std::max(per_mas_ngy, 1e-12);
    const double most = most_mas(mode, at_distance(kerma_mgy, reference_distance_mm(arm)), pulses_per_s, limits);
    exposure.mas = std::clamp(wanted, limits.least_mas, most);
    exposure.is_limited = wanted > most;
    if (!exposure.is_limited || exposure.tube.kv >= limits.most_kv) return exposure;
    exposure.tube.kv = std::min(limits.most_kv, exposure.tube.kv + kRise_kv);
  }
}

namespace {

constexpr double kReference_mm = 150.0;  ///< From the isocentre towards the source, IEC 60601-2-43.
constexpr double kMetre_mm = 1000.0;
constexpr double kCm2_per_mm2 = 0.01;

}  // namespace

double at_distance(double at_1_m, double distance_mm) noexcept {
  const double ratio = kMetre_mm / distance_mm;
  return at_1_m * ratio * ratio;
}

double reference_distance_mm(const CArm& arm) noexcept {
  return arm.source_isocentre_mm - kReference_mm;
}

double irradiated_area_cm2(const CArm& arm, double distance_mm) noexcept {
  const double edge_mm = arm.field_mm * distance_mm / arm.source_detector_mm;
  return kCm2_per_mm2 * edge_mm * edge_mm * arm.collimation[0] * arm.collimation[1];
}

void add_pulses(int pulses, double mas, double kerma_mgy_per_mas, const CArm& arm, Dose& dose) noexcept {
  const double distance_mm = reference_distance_mm(arm);
  const double kerma_mgy = pulses * mas * at_distance(kerma_mgy_per_mas, distance_mm);
  dose.pulses += pulses;
  dose.air_kerma_mgy += kerma_mgy;
  dose.area_product_mgy_cm2 += kerma_mgy * irradiated_area_cm2(arm, distance_mm);
}

}  // namespace trocar::xray
