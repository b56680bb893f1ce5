#include "ultrasound/engine/detail/scan_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "ultrasound/engine/beam.h"
#include "ultrasound/engine/detail/scatterer_cell.h"
#include "ultrasound/engine/detail/scatterer_gain.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr double kNeperPerDb = std::numbers::ln10 / 20.0;
constexpr double kGelSpeed_m_per_s = 1540.0;
constexpr float kSilent = -60.0F;  // neper: below any signal

void fill_rows(ScanPlan& plan, const AcousticTable& table) {
  const double mhz = plan.beam.frequency_mhz;
  const double assumed_m_per_s = 1000.0 * kScannerSpeed_mm_per_us;
  plan.rows.fill({0.0F, 0.0F, kSilent, 0.0F});
  for (std::size_t t = 0; t < table.tissues.size(); ++t) {
    const AcousticTissue& tissue = table.tissues[t];
    const double loss_db_per_mm =
        plan.acquisition.artefacts.attenuation ? tissue.attenuation_db_per_cm(mhz) / 10.0 : 0.0;
    const double share = std::max(static_cast<double>(kShares[share_class(tissue.scatterer_share)]), 1.0 / 255.0);
    TissueRow& row = plan.rows[t];
    row.log_z = static_cast<float>(std::log(tissue.impedance_mrayl()));
    row.loss = static_cast<float>(2.0 * loss_db_per_mm * kNeperPerDb * plan.sample_mm);
    row.log_b = static_cast<float>(tissue.backscatter_db * kNeperPerDb - 0.5 * std::log(share));
    plan.slowness[t] = static_cast<float>(assumed_m_per_s / std::clamp(tissue.speed_m_per_s, 1300.0, 4500.0) - 1.0);
    plan.loss_exponent[t] = static_cast<float>(tissue.attenuation_exponent);
    row.delay = plan.acquisition.artefacts.range_distortion ? plan.slowness[t] : 0.0F;
    for (int step = -128; step < 128; ++step)
      plan.texture_gain[t][static_cast<std::size_t>(step + 128)] =
          static_cast<float>(tissue.texture_db(step * kTextureStep_hu) * kNeperPerDb);
    plan.has_texture[t] = tissue.texture_db_per_hu != 0.0 || tissue.texture_below_db_per_hu != 0.0 ? 1 : 0;
    plan.fibre_gain[t] = static_cast<float>(tissue.fibre_db * kNeperPerDb);
    plan.roughness[t] = static_cast<float>(tissue.roughness);
    plan.share[t] = share_class(tissue.scatterer_share);
  }
  plan.share[kNoData] = share_class(0.0);
  plan.entry_rows = plan.rows;
  const auto skin = table.find("skin");
  plan.entry_rows[0] = {skin ? plan.rows[*skin].log_z : static_cast<float>(std::log(1e-3 * kGelSpeed_m_per_s)), 0.0F,
                        kSilent, 0.0F};
}

void fill_walls(ScanPlan& plan, const AcousticTable& table) {
  plan.wall_at.assign(static_cast<std::size_t>(kTissues) * kTissues, 0);
  for (const AcousticWall& wall : table.walls) {
    const WallRow row{static_cast<float>(wall.thickness_mm), static_cast<float>(wall.backscatter_db * kNeperPerDb),
                      static_cast<float>(std::exp(wall.even_db * kNeperPerDb)), false};
    WallRow back = row;
    back.is_behind = true;
    plan.walls.push_back(row);
    plan.walls.push_back(back);
    const auto front_number = static_cast<std::uint8_t>(plan.walls.size() - 1);
    for (const std::uint8_t inside : wall.of) {
      for (const std::uint8_t outside : wall.against) {
        plan.wall_at[static_cast<std::size_t>(outside) * kTissues + inside] = front_number;
        plan.wall_at[static_cast<std::size_t>(inside) * kTissues + outside] =
            static_cast<std::uint8_t>(front_number + 1);
      }
    }
  }
}

void fill_planes(ScanPlan& plan) {
  plan.plane_step = plan.planes > 1 ? 2.0F * kOutermostPlane / static_cast<float>(plan.planes - 1) : 1.0F;
  float sum = 0.0F;
  for (int p = 0; p < plan.planes; ++p) {
    const float zeta = static_cast<float>(p - plan.planes / 2) * plan.plane_step;
    sum += plan.plane_weight[static_cast<std::size_t>(p)] = std::exp(-0.5F * zeta * zeta);
  }
  for (float& weight : plan.plane_weight) weight /= sum;
}

/// Scatterers are split between two scanlines, which widens the beam.
constexpr double kSharingVariance = 1.0 / 6.0;

/// Steered images overlap less with depth: near the face a compound of three has two more angles (assumed; the local
/// contrast of the recorded speckle of docs/validation.md grows from 35 to 65 mm).
void fill_near_angles(ScanPlan& plan) {
  constexpr double kFull_mm = 25.0, kEnd_mm = 45.0;
  if (plan.steering_angles != 3) return;
  const auto sample_at = [&](double mm) {
    const auto sample = static_cast<int>(mm / plan.geometry.sample_mm()) / 16 * 16;
    return sample + 16 > plan.samples ? plan.samples : sample;  // what is left is a vector or nothing
  };
  plan.near_angles = 2;
  plan.near_full = sample_at(kFull_mm);
  plan.near_samples = sample_at(kEnd_mm);
}

/// Compounding angles receive from the sides: the same beam on a tilted wave front. `sigma` of the beam, scanlines.
void fill_steering_angles(ScanPlan& plan, const std::vector<double>& sigma) {
  constexpr double kSteeringTurn = 1.7;  // rad per sigma: speckle correlation of 0.24 with the central angle
  constexpr double kMostTurn = 0.45 * std::numbers::pi;
  plan.steering_angles = plan.acquisition.steering_angles;
  plan.main_lobe_reach = *std::max_element(plan.main_lobe_reach_at.begin(), plan.main_lobe_reach_at.end());
  fill_near_angles(plan);
  const auto sides = static_cast<std::size_t>((plan.steering_angles + plan.near_angles) / 2);
  plan.side_cosine.assign(plan.side_row(sides, 1) + 16, 0.0F);
  plan.side_sine = plan.side_cosine;
  for (std::size_t side = 0; side < sides; ++side) {
    for (int k = 1; k <= plan.main_lobe_reach; ++k) {
      for (std::size_t s = 0; s < sigma.size(); ++s) {
        const double turn = static_cast<double>(side + 1) * k * std::min(kSteeringTurn / sigma[s], kMostTurn);
        const auto weight = static_cast<double>(plan.lateral[static_cast<std::size_t>(k) * sigma.size() + s]);
        plan.side_cosine[plan.side_row(side, k) + s] = static_cast<float>(weight * std::cos(turn));
        plan.side_sine[plan.side_row(side, k) + s] = static_cast<float>(weight * std::sin(turn));
      }
    }
  }
}

void fill_lateral(ScanPlan& plan) {
  const auto n = static_cast<std::size_t>(plan.samples);
  double widest = 0.0;
  std::vector<double> kernel_sigma(n), sigma(n);  // in scanlines
  for (std::size_t s = 0; s < n; ++s) {
    const double depth_mm = (static_cast<double>(s) + 0.5) * plan.sample_mm;
    sigma[s] = plan.beam.lateral_sigma_mm(depth_mm) / plan.geometry.line_spacing_mm(depth_mm);
    kernel_sigma[s] = std::sqrt(std::max(sigma[s] * sigma[s] - kSharingVariance, 0.1));
    widest = std::max(widest, kernel_sigma[s]);
  }
  // Side lobes: of an aperture with moderate apodisation, alternating in sign (docs/physics.md U6).
  constexpr double kFirstLobe_sigma = 3.6, kLastLobe_sigma = 10.0, kLobeSpacing_sigma = 1.7;
  const double lobe =
      plan.acquisition.artefacts.side_lobes ? std::pow(10.0, clutter_level_db(plan.beam, -40.0) / 20.0) : 0.0;
  const double reach_sigma = lobe > 0.0 ? kLastLobe_sigma : 3.3;
  plan.lateral_reach = std::clamp(static_cast<int>(std::ceil(reach_sigma * widest)), 1, std::min(48, plan.lines - 1));
  plan.lateral.assign((static_cast<std::size_t>(plan.lateral_reach) + 1) * n + 16, 0.0F);
  plan.surface_scale.assign(n, 0.0F);
  plan.lateral_reach_at.assign(n / 16 + 1, 0);
  plan.main_lobe_reach_at = plan.lateral_reach_at;
  for (std::size_t s = 0; s < n; ++s) {
    const double height = sigma[s] / kernel_sigma[s];
    double sum = 0.0;
    for (int k = 0; k <= plan.lateral_reach; ++k) {
      const double x = k / kernel_sigma[s];
      double weight = height * std::exp(-0.5 * x * x);
      if (x > kFirstLobe_sigma - 1.0 && x < kLastLobe_sigma)
        weight += lobe * std::sin(std::numbers::pi * x / kLobeSpacing_sigma) * std::sqrt(kFirstLobe_sigma / x) *
                  std::min(1.0, x - kFirstLobe_sigma + 1.0);
      plan.lateral[static_cast<std::size_t>(k) * n + s] = static_cast<float>(weight);
      sum += (k == 0 ? 1.0 : 2.0) * std::abs(height * std::exp(-0.5 * x * x));
    }
    plan.surface_scale[s] = static_cast<float>(1.0 / sum);
    const int narrow = std::clamp(static_cast<int>(std::ceil(3.0 * kernel_sigma[s])), 1, plan.lateral_reach);
    plan.main_lobe_reach_at[s / 16] = std::max(plan.main_lobe_reach_at[s / 16], narrow);
    const int reach = std::clamp(static_cast<int>(std::ceil(reach_sigma * kernel_sigma[s])), 1, plan.lateral_reach);
    plan.lateral_reach_at[s / 16] = std::max(plan.lateral_reach_at[s / 16], reach);
  }
  fill_steering_angles(plan, sigma);
}

void fill_axial(ScanPlan& plan) {
  const double sigma = plan.beam.axial_sigma_mm / plan.sample_mm;
  plan.axial_reach = std::clamp(static_cast<int>(std::ceil(3.5 * sigma)), 1, kPad);
  plan.axial.clear();
  double sum = -1.0;
  for (int k = 0; k <= plan.axial_reach; ++k) {
    const double weight = std::exp(-0.5 * k * k / (sigma * sigma));
    plan.axial.push_back(static_cast<float>(weight));
    sum += 2.0 * weight;
  }
  plan.band_scale = static_cast<float>(1.0 / sum);
}

/// Smallest product of the beam's three widths within the picture.
double smallest_cell_mm3(const Beam& beam, double depth_mm) noexcept {
  constexpr int kDepths = 1024;
  double smallest_mm3 = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kDepths; ++n) {
    const double at_mm = (n + 0.5) / kDepths * depth_mm;
    smallest_mm3 =
        std::min(smallest_mm3, beam.axial_sigma_mm * beam.lateral_sigma_mm(at_mm) * beam.elevation_sigma_mm(at_mm));
  }
  return smallest_mm3;
}

/// Length whose scatterers contribute to a sample along the pulse: integral of its square, as sampled; root of pi times
/// sigma for samples that are short enough.
double pulse_mm(const ScanPlan& plan) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < plan.axial.size(); ++k)
    sum += (k == 0 ? 1.0 : 2.0) * std::pow(static_cast<double>(plan.axial[k]), 2);
  return sum * plan.geometry.sample_mm();
}

/// The same across scanlines, for scatterers that are split between two of them.
double main_lobe_mm(const ScanPlan& plan, std::size_t sample) noexcept {
  const auto weight = [&](int k) {
    return k > plan.main_lobe_reach
               ? 0.0
               : static_cast<double>(
                     plan.lateral[static_cast<std::size_t>(k) * static_cast<std::size_t>(plan.samples) + sample]);
  };
  double squares = weight(0) * weight(0), neighbours = 0.0;
  for (int k = 1; k <= plan.main_lobe_reach; ++k) squares += 2.0 * weight(k) * weight(k);
  for (int k = 0; k <= plan.main_lobe_reach; ++k) neighbours += 2.0 * weight(k) * weight(k + 1);
  const double depth_mm = (static_cast<double>(sample) + 0.5) * plan.geometry.sample_mm();
  return plan.geometry.line_spacing_mm(depth_mm) * (2.0 / 3.0 * squares + 1.0 / 3.0 * neighbours);
}

/// Number of scatterers that the smallest resolution cell needs for fully developed speckle, and the factor that makes
/// its mean independent of the cell's size, scanlines and samples.
void fill_scatterers(ScanPlan& plan) {
  constexpr double kMostPerCell = 4.0;
  constexpr double kEffectiveVolume = 15.75;  // (2 pi)^1.5, of sx sy sz: (sum w^2)^2 / sum w^4
  const auto n = static_cast<std::size_t>(plan.samples);
  std::vector<double> volume_mm3(n);
  for (std::size_t s = 0; s < n; ++s) {
    const double depth_mm = (static_cast<double>(s) + 0.5) * plan.sample_mm;
    const double lateral_mm = plan.beam.lateral_sigma_mm(depth_mm);
    volume_mm3[s] = plan.beam.axial_sigma_mm * lateral_mm * plan.elevation_sigma_mm[s];
  }
  // The lattice of bricks depends on the beam alone, not on samples or scanlines: other details have the same pattern.
  const double smallest_mm3 = smallest_cell_mm3(plan.beam, plan.geometry.depth_mm);
  const double per_mm3 = kMostPerCell / (kEffectiveVolume * smallest_mm3);
  const double wanted = plan.acquisition.scatterers / kMostPerCell;
  plan.brick_mm = static_cast<float>(std::cbrt(kBrickScatterers / per_mm3));
  plan.speckle_scale.resize(n);
  plan.most_rank.resize(n);
  plan.echo_power.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    // A small part of a stratified brick is less uniform than the whole: fewer scatterers in larger resolution cells.
    const double share = wanted * std::clamp(1.6 * std::pow(smallest_mm3 / volume_mm3[s], 0.7), 0.1, 1.0);
    plan.most_rank[s] = static_cast<float>(share);
    const double heard_mm3 = pulse_mm(plan) * main_lobe_mm(plan, s) * std::sqrt(std::numbers::pi) *
                             static_cast<double>(plan.elevation_sigma_mm[s]);
    const double mean = share * per_mm3 * kMeanSquareScatterer * heard_mm3;
    plan.speckle_scale[s] = static_cast<float>(1.0 / std::sqrt(mean));
    // Two thirds: each is split between two scanlines.
    const double cell_mm2 =
        plan.geometry.sample_mm() * plan.geometry.line_spacing_mm((static_cast<double>(s) + 0.5) * plan.sample_mm);
    plan.echo_power[s] = static_cast<float>(2.0 / 3.0 * cell_mm2 / (pulse_mm(plan) * main_lobe_mm(plan, s)));
  }
}

void fill_noise(ScanPlan& plan) {
  constexpr std::uint64_t kSeed = 0x636c;
  Random random(kSeed);
  plan.noise.resize(ScanPlan::kNoise);
  for (float& value : plan.noise) value = static_cast<float>(random.normal());
}

}  // namespace

ScanPlan make_scan_plan(const AcousticScene& scene, const Transducer& transducer, const Acquisition& acquisition) {
  ScanPlan plan;
  plan.acquisition = acquisition;
  plan.geometry = make_scan_geometry(transducer, acquisition.depth_mm, acquisition.lines, acquisition.samples);
  const auto harmonic = acquisition.is_harmonic ? harmonic_mhz(transducer, acquisition.frequency_mhz) : std::nullopt;
  plan.beam = harmonic ? make_harmonic_beam(transducer, *harmonic, acquisition.focus_mm)
                       : make_beam(transducer, acquisition.frequency_mhz, acquisition.focus_mm);
  if (acquisition.artefacts.downshift && acquisition.artefacts.attenuation)
    plan.beam.downshift_per_mm = nominal_downshift_per_mm(plan.beam);
  plan.lines = acquisition.lines;
  plan.samples = acquisition.samples;
  plan.planes = acquisition.planes;
  plan.stride = (plan.samples + 15) / 16 * 16 + 2 * kPad;
  plan.sample_mm = static_cast<float>(plan.geometry.sample_mm());
  plan.cycles_per_sample = static_cast<float>(2.0 * plan.geometry.sample_mm() / plan.beam.wavelength_mm);

  const auto n = static_cast<std::size_t>(plan.samples);
  for (std::size_t s = 0; s < n; ++s) {
    const double depth_mm = (static_cast<double>(s) + 0.5) * plan.sample_mm;
    const double sigma_mm = plan.beam.elevation_sigma_mm(depth_mm);
    plan.elevation_sigma_mm.push_back(static_cast<float>(sigma_mm));
    plan.inverse_elevation_sigma.push_back(static_cast<float>(1.0 / sigma_mm));
  }
  for (std::size_t c = 0; c < plan.coarse_samples(); ++c) {
    constexpr double kLeast_mm = 0.02;
    const double depth_mm = static_cast<double>(c * kCoarse) * plan.geometry.sample_mm();
    const double spacing_mm = std::max(plan.geometry.line_spacing_mm(depth_mm), kLeast_mm);
    plan.coarse_spacing_mm.push_back(static_cast<float>(spacing_mm));
    plan.inverse_coarse_spacing.push_back(static_cast<float>(1.0 / spacing_mm));
  }
  // Padding, because kernels read whole vectors.
  plan.elevation_sigma_mm.resize(n + 16, plan.elevation_sigma_mm.back());
  fill_rows(plan, scene.table);
  fill_walls(plan, scene.table);
  fill_planes(plan);
  fill_lateral(plan);
  fill_axial(plan);
  fill_scatterers(plan);
  fill_noise(plan);
  if (plan.beam.is_harmonic) plan.harmonic_level = harmonic_levels(plan.beam, plan.geometry);
  return plan;
}

}  // namespace trocar::ultrasound::detail
