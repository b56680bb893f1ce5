#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/echo_engine.h"

/// Needles in the image (docs/physics.md U13): echo, comet tail, shadow, and the tissue that they displace.
namespace trocar::ultrasound::detail {

/// Levels relative to liver's speckle (root mean square) without attenuation, for a shaft of kNeedleReference_mm in the
/// middle of the beam. All are assumed, within the measured decreases of visibility with the angle.
inline constexpr double kShaftSmooth_db = 38.0;  ///< Perpendicular to the beam. Range 30..48.
inline constexpr double kShaftTilt_rad = 0.25;   ///< 14 degrees: decrease to exp(-1/2). Range 0.15..0.3.
inline constexpr double kShaftRough_db = 19.0;   ///< Times the cosine of the tilt. Range 8..22.
inline constexpr double kTipRough_db = 20.0;     ///< Level of the tip's surface, for all directions. Range 12..25.
inline constexpr double kTipPoint_db = 24.0;     ///< Level of the point's edge. Range 15..28.
inline constexpr double kTipSmoothShare = 0.3;  ///< Share of the smooth shaft's echo that the bevel leaves. Range 0..1.
inline constexpr double kNeedleReference_mm = 1.2;  ///< Echo amplitude is proportional to the root of the diameter.
/// Ratio of the amplitudes of successive repeated echoes: -7 dB. Range 0.3..0.6.
inline constexpr double kRepeatShare = 0.45;
inline constexpr int kRepeats = 8;
/// Share of the covered sound that is missing behind the needle; the rest passes around it. Range 0.15..1.
inline constexpr double kShadowShare = 0.3;
inline constexpr float kDragReach_mm = 8.0F;  ///< Range 3..15.

/// Displayed spacing of repeated echoes of a needle: twice through its wall (steel, 5790 m/s) and once through the bore
/// (1480 m/s), converted with the speed of sound that scanners assume.
double repeat_spacing_mm(const NeedleEcho& needle) noexcept;

/// A short piece of a shaft's smooth surface.
struct ShaftPiece {
  float line, walk;
  float echo;              ///< Amplitude of its share in the shaft's echo, in phase with the others.
  float ring;              ///< Factor of repeated echoes from the tilt.
  float level;             ///< 1: neighbouring pieces lie at one depth; 0: at many depths.
  float half_lines;        ///< Half of its extent across scanlines.
  float miss2;             ///< Squared distance from the image plane, in sigmas of the one-way beam.
  float line_sigmas;       ///< Distance between scanlines, in sigmas of the one-way beam.
  float strip_sigma2_mm2;  ///< Variance of the one-way beam across the shaft.
  float strip_lateral;     ///< Lateral share of that variance, 0..1.
  float cover;             ///< 1; less if the shaft points along the beam.
};

/// A grain of the shaft's rough surface.
struct ShaftGrain {
  float line, walk;
  float echo, ring;
  float turn;  ///< Phase of the grain, cycles.
};

/// All needles of a frame, in scanline coordinates.
struct NeedleImage {
  struct Part {
    std::size_t first_piece = 0, last_piece = 0, first_grain = 0, last_grain = 0;
    float diameter_mm = 0.0F;
    float repeat_samples = 0.0F;
  };
  static constexpr std::size_t kMostNeedles = 8;
  std::vector<ShaftPiece> pieces;  ///< Sized by make_needle_image; `parts` holds the ranges in use.
  std::vector<ShaftGrain> grains;
  std::array<Part, kMostNeedles> parts{};
  std::size_t count = 0;
  Vec3f low_T = Vec3f::Zero(), high_T = Vec3f::Zero();  ///< Box around all parts that cause echoes.
};

NeedleImage make_needle_image(const ScanPlan& plan);

/// Computes the pieces and grains of needles along the scanlines and sets frame.drag. Call after refract_lines;
/// allocates nothing.
void lay_out_needles(const ScanPlan& plan, FrameState& frame, std::span<const NeedleEcho> needles,
                     NeedleImage& image) noexcept;

/// Adds shadows and echoes on the scanlines [first, last), whose gains and surface echoes must be complete.
void add_needles(const ScanPlan& plan, FrameState& frame, const NeedleImage& image, int first, int last) noexcept;

}  // namespace trocar::ultrasound::detail
