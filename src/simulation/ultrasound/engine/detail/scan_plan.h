#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/engine/b_mode.h"
#include "ultrasound/tissue/acoustic_scene.h"

/// What all frames of a scan share. The engine knows three ways along a scanline, in samples: `rest` (distance in the
/// resting tissue, from where the undented skin would meet the face), `walk` (distance from the face now) and `shown`
/// (the echo's time of flight at the speed that scanners assume).
namespace trocar::ultrasound::detail {

inline constexpr int kPad = 96;    ///< Zero samples before and behind a scanline, for the pulse to reach into.
inline constexpr int kCoarse = 8;  ///< Samples to a step of what varies slowly.
inline constexpr int kGroup = 32;  ///< Scanlines that one task handles.
inline constexpr int kMaxPlanes = 9;
inline constexpr int kTissues = 128;
inline constexpr std::uint8_t kNoData = 127;  ///< Tissue beyond the volume.
inline constexpr float kBeamEdge = 2.2F;      ///< Sigmas in elevation, beyond which nothing is heard.
inline constexpr float kOutermostPlane = 1.8F;

/// A tissue as a scanline meets it, at the scan's frequency.
struct alignas(16) TissueRow {
  float log_z;  ///< Logarithm of the impedance.
  float loss;   ///< Amplitude lost there and back, neper a sample.
  float log_b;  ///< Logarithm of the scatterers' amplitude.
  float delay;  ///< Samples by which an echo comes later, a sample.
};

struct ScanPlan {
  ScanGeometry geometry;
  Beam beam;
  Acquisition acquisition;
  int lines = 0, samples = 0, planes = 0;
  int stride = 0;  ///< Floats a padded scanline.
  float sample_mm = 0.0F;
  float plane_step = 0.0F;                       ///< Between planes, in sigmas of the beam's thickness.
  std::array<float, kMaxPlanes> plane_weight{};  ///< Of a plane in a surface's echo; sums to 1.

  std::array<TissueRow, kTissues> rows{};
  std::array<TissueRow, kTissues> entry_rows{};  ///< The same with coupling gel for air: before a line is in the body.
  std::array<float, kTissues> slowness{};        ///< c0 / c - 1.
  std::array<std::uint8_t, kTissues> has_texture{};
  std::array<std::array<float, 256>, kTissues> texture_gain{};  ///< Neper, by texture step + 128.
  std::array<float, kTissues> fibre_gain{};                     ///< Neper.
  std::array<float, kTissues> roughness{};
  std::array<std::uint8_t, kTissues> share{};  ///< Class of its share of scatterers, into kShares.

  // A value a sample of `walk` or `shown`, which differ by too little to matter here.
  std::vector<float> elevation_sigma_mm, inverse_elevation_sigma;
  std::vector<float> speckle_scale;  ///< Makes fully developed speckle of unit scatterers 1 root mean square.
  std::vector<float> most_rank;  ///< Share of the scatterers that are enough there: resolution cells differ in size.
  std::vector<float> surface_scale;  ///< Makes a plane reflector independent of how many scanlines see it.

  int steering_angles = 1;     ///< Of the compound: straight on, then pairs from angles to either side.
  std::vector<float> lateral;  ///< (lateral_reach + 1) rows of `samples` weights: of scanlines 0, 1, 2 … away; 16 more.
  int lateral_reach = 0;
  int main_lobe_reach = 0;
  std::vector<int> main_lobe_reach_at;
  /// Of steering angles to the sides: rows of `samples`, lateral weights times cosine and sine of the phase between
  /// scanlines.
  std::vector<float> side_cosine, side_sine;
  std::vector<int> lateral_reach_at;  ///< The same for each 16 samples: the fan's scanlines part with depth.
  std::vector<float> axial;           ///< axial_reach + 1 weights: half of the symmetric pulse.
  int axial_reach = 0;

  float cycles_per_sample = 0.0F;  ///< Of the echo's phase.
  float brick_mm = 2.5F;           ///< Side of the cube that holds kBrickScatterers.

  /// Where side_cosine and side_sine have the weights of scanlines k away, 1 <= k <= main_lobe_reach.
  std::size_t side_row(std::size_t side, int k) const noexcept {
    return (side * static_cast<std::size_t>(main_lobe_reach) + static_cast<std::size_t>(k - 1)) *
           static_cast<std::size_t>(samples);
  }
  /// Where a scanline's echoes begin among those of all. Silence surrounds them, as wide as the point spread reaches.
  std::size_t echo_row(int line) const noexcept {
    return static_cast<std::size_t>(line + lateral_reach) * static_cast<std::size_t>(stride) + kPad;
  }
  std::size_t coarse_samples() const noexcept { return static_cast<std::size_t>(samples / kCoarse) + 2; }
};

ScanPlan make_scan_plan(const AcousticScene& scene, const Transducer& transducer, const Acquisition& acquisition);

}  // namespace trocar::ultrasound::detail
