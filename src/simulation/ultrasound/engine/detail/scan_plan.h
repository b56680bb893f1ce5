#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/engine/b_mode.h"
#include "ultrasound/tissue/acoustic_scene.h"

/// Data common to all frames of a scan. The engine uses three coordinates along a scanline, in samples: `rest`
/// (distance in the resting tissue, from where the undented skin would meet the face), `walk` (distance from the face
/// now) and `shown` (the echo's time of flight at the speed that scanners assume).
namespace trocar::ultrasound::detail {

inline constexpr int kPad = 96;    ///< Zero samples before and behind a scanline, for the length of the pulse.
inline constexpr int kCoarse = 8;  ///< Samples per step of slowly varying quantities.
inline constexpr int kLayering = 3 * kCoarse;  ///< The same for the layers of muscle, which vary over centimetres.
inline constexpr int kGroup = 32;              ///< Scanlines that one task handles.
inline constexpr int kMaxPlanes = 9;
inline constexpr int kTissues = 128;
inline constexpr std::uint8_t kNoData = 127;  ///< Tissue outside the volume.
inline constexpr float kBeamEdge = 2.2F;      ///< Limit in elevation, in sigmas; echoes beyond it are ignored.
inline constexpr float kOutermostPlane = 1.8F;
/// Outer planes are walked on every second scanline, the two outermost of five and more on every fourth, as sums of
/// shifts: tissue varies little over that distance, and their echoes are weak.
inline constexpr int kOuterShift = 1, kOutermostShift = 2;
inline constexpr int kMostStride = 1 << kOutermostShift;
inline constexpr int kLobeBlock = 16;  ///< Samples per value of lateral_reach_at and FrameState::loudest.

/// Properties of a tissue along a scanline, at the scan's frequency.
struct alignas(16) TissueRow {
  float log_z;  ///< Logarithm of the impedance.
  float loss;   ///< Two-way loss of amplitude, neper per sample.
  float log_b;  ///< Logarithm of the scatterers' amplitude.
  float delay;  ///< Delay of an echo in samples, per sample.
};

/// A sheet beside a border (AcousticWall), seen along a scanline.
struct WallRow {
  float thickness_mm = 0.0F;
  float log_b = 0.0F;      ///< As TissueRow::log_b.
  float even = 0.0F;       ///< Amplitude of its even part.
  bool is_behind = false;  ///< It lies behind the border, not in front of it.
};

struct ScanPlan {
  ScanGeometry geometry;
  Beam beam;
  Acquisition acquisition;
  int lines = 0, samples = 0, planes = 0;
  int stride = 0;  ///< Floats per padded scanline.
  float sample_mm = 0.0F;
  float plane_step = 0.0F;                       ///< Distance between planes, in sigmas of the beam's thickness.
  std::array<float, kMaxPlanes> plane_weight{};  ///< Weight of a plane in a surface's echo; the sum is 1.

  std::array<TissueRow, kTissues> rows{};
  /// The same with coupling gel in place of air: for a scanline before it enters the body.
  std::array<TissueRow, kTissues> entry_rows{};
  std::vector<WallRow> walls;
  std::vector<std::uint8_t> wall_at;       ///< Tissue before a border * kTissues + behind: 1 + index of its wall, or 0.
  std::array<float, kTissues> slowness{};  ///< c0 / c - 1.
  std::array<float, kTissues> loss_exponent{};  ///< Of the loss over frequency.
  std::array<std::uint8_t, kTissues> has_texture{};
  std::array<std::array<float, 256>, kTissues> texture_gain{};  ///< Neper, by texture step + 128.
  std::array<float, kTissues> fibre_gain{};                     ///< Neper.
  std::array<float, kTissues> roughness{};
  std::array<std::uint8_t, kTissues> share{};  ///< Class of its share of scatterers, index into kShares.

  // One value per sample of `walk` or `shown`; their difference is too small to matter here.
  std::vector<float> elevation_sigma_mm, inverse_elevation_sigma;
  /// Distance of adjacent scanlines every kCoarse samples, and its reciprocal. Those of a phased array start at one
  /// point: there it is at least 0.02 mm, because smaller distances contain no information about lateral differences.
  std::vector<float> coarse_spacing_mm, inverse_coarse_spacing;
  /// Mean power of liver's echoes without losses, before the point spread.
  std::vector<float> echo_power;
  static constexpr std::size_t kNoise = 32768;
  std::vector<float> noise;          ///< kNoise Gaussian numbers of variance 1.
  std::vector<float> speckle_scale;  ///< Scales fully developed speckle of unit scatterers to a root mean square of 1.
  std::vector<float> most_rank;  ///< Share of the scatterers that is sufficient there; resolution cells differ in size.
  /// Makes a plane reflector's echo independent of the number of scanlines that receive it.
  std::vector<float> surface_scale;

  std::vector<float> harmonic_level;  ///< See harmonic_levels(); empty for a fundamental beam.

  int steering_angles = 1;  ///< Number of angles of the compound: straight on, then pairs of angles to either side.
  int near_angles = 0, near_full = 0, near_samples = 0;  ///< See BasebandFrame.
  std::vector<float> lateral;  ///< (lateral_reach + 1) rows of `samples` weights, for the scanlines at distances 0, 1,
                               ///< 2 …; 16 more values at the end.
  int lateral_reach = 0;
  int main_lobe_reach = 0;
  std::vector<int> main_lobe_reach_at;
  /// For the steering angles to the sides: rows of `samples`, lateral weights times cosine and sine of the phase
  /// between scanlines.
  std::vector<float> side_cosine, side_sine;
  std::vector<int> lateral_reach_at;  ///< lateral_reach for each 16 samples; a fan's scanlines diverge with depth.
  std::vector<float> axial;           ///< axial_reach + 1 weights: half of the symmetric pulse.
  int axial_reach = 0;
  float band_scale = 1.0F;  ///< Equal samples along a scanline, times this, keep their amplitude behind the pulse.

  float cycles_per_sample = 0.0F;  ///< Phase of the echo.
  float brick_mm = 2.5F;           ///< Side of the cube that holds kBrickScatterers.

  int central() const noexcept { return planes / 2; }
  bool is_outermost(int plane) const noexcept { return planes >= 5 && (plane == 0 || plane == planes - 1); }
  /// A plane is walked on scanlines that are multiples of 1 << shift.
  int shift_of(int plane) const noexcept {
    if (plane == central()) return 0;
    return is_outermost(plane) ? kOutermostShift : kOuterShift;
  }
  int rows_of_shift(int shift) const noexcept { return (lines + (1 << shift) - 1) >> shift; }
  /// Number of planes besides the central and the outermost ones.
  int inner_planes() const noexcept { return planes >= 5 ? planes - 3 : planes - 1; }
  /// First row of the outermost planes: behind the central plane and the inner ones.
  int outermost_row() const noexcept { return lines + inner_planes() * rows_of_shift(kOuterShift); }
  /// Number of walks of a frame: all scanlines of the central plane, some of the others.
  int walked_rows() const noexcept { return outermost_row() + (planes >= 5 ? 2 * rows_of_shift(kOutermostShift) : 0); }
  /// Walk that a scanline of a plane uses, 0 <= row < walked_rows(): rows of borders and gains.
  int row_of(int plane, int line) const noexcept {
    if (plane == central()) return line;
    if (is_outermost(plane))
      return outermost_row() + (plane == 0 ? 0 : rows_of_shift(kOutermostShift)) + (line >> kOutermostShift);
    const int inner = plane - (planes >= 5 ? 1 : 0) - (plane > central() ? 1 : 0);
    return lines + inner * rows_of_shift(kOuterShift) + (line >> kOuterShift);
  }
  /// Scanline of that walk.
  int walked_line(int plane, int line) const noexcept { return line >> shift_of(plane) << shift_of(plane); }
  std::size_t lobe_blocks() const noexcept { return static_cast<std::size_t>(samples / kLobeBlock) + 1; }
  /// Offset in side_cosine and side_sine of the weights for scanlines at distance k, 1 <= k <= main_lobe_reach.
  std::size_t side_row(std::size_t side, int k) const noexcept {
    return (side * static_cast<std::size_t>(main_lobe_reach) + static_cast<std::size_t>(k - 1)) *
           static_cast<std::size_t>(samples);
  }
  /// Offset of a scanline's echoes among those of all. Zeros surround them, as wide as the point spread.
  std::size_t echo_row(int line) const noexcept {
    return static_cast<std::size_t>(line + lateral_reach) * static_cast<std::size_t>(stride) + kPad;
  }
  std::size_t layer_steps() const noexcept { return static_cast<std::size_t>((samples + kLayering - 1) / kLayering); }
  std::size_t coarse_samples() const noexcept { return static_cast<std::size_t>(samples / kCoarse) + 2; }
};

ScanPlan make_scan_plan(const AcousticScene& scene, const Transducer& transducer, const Acquisition& acquisition);

}  // namespace trocar::ultrasound::detail
