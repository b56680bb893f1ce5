#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/needle_echo.h"

/// Needles in the image (docs/physics.md U13): echo, comet tail, shadow, and the tissue that they drag along.
namespace trocar::ultrasound::detail {

/// Levels against liver's speckle (root mean square) without attenuation, of a shaft of kNeedleReference_mm in the
/// middle of the beam; all assumed, within the measured falls of visibility with the angle.
inline constexpr double kShaftSmooth_db = 38.0;     ///< Square to the beam. Range 30..48.
inline constexpr double kShaftTilt_rad = 0.25;      ///< 14 degrees: fall to exp(-1/2). Range 0.15..0.3.
inline constexpr double kShaftRough_db = 19.0;      ///< Times the cosine of the tilt. Range 8..22.
inline constexpr double kTipRough_db = 20.0;        ///< Of the tip's surface, from everywhere. Range 12..25.
inline constexpr double kTipPoint_db = 24.0;        ///< Of the point's edge. Range 15..28.
inline constexpr double kTipSmoothShare = 0.3;      ///< What the bevel leaves of the smooth shaft. Range 0..1.
inline constexpr double kNeedleReference_mm = 1.2;  ///< Echoes go with the root of the diameter.
inline constexpr double kRepeatShare = 0.45;  ///< Of an echo's amplitude, from one to the next: -7 dB. Range 0.3..0.6.
inline constexpr int kRepeats = 8;
/// Part of the covered sound that is missing behind; the rest bends round. Range 0.15..1.
inline constexpr double kShadowShare = 0.3;
inline constexpr float kDragReach_mm = 8.0F;  ///< Range 3..15.

/// Distance at which repeated echoes of a needle are shown: twice through its wall (steel, 5790 m/s), once through the
/// bore (1480 m/s), shown at the speed that scanners assume.
double repeat_spacing_mm(const NeedleEcho& needle) noexcept;

/// A short piece of a shaft's smooth surface.
struct ShaftPiece {
  float line, walk;
  float echo;              ///< Amplitude of its share in the shaft's echo, in phase with the others.
  float ring;              ///< What the tilt leaves of repeated echoes.
  float level;             ///< 1 where neighbouring pieces lie at one depth, 0 where at many.
  float half_lines;        ///< Half of its extent across scanlines.
  float miss2;             ///< Of the image plane, squared, in sigmas of the one-way beam.
  float line_sigmas;       ///< Between scanlines, in sigmas of the one-way beam.
  float strip_sigma2_mm2;  ///< Of the one-way beam across the shaft.
  float strip_lateral;     ///< How much of that is lateral, 0..1.
  float cover;             ///< 1; less where it is seen end-on.
};

/// A grain of its rough surface.
struct ShaftGrain {
  float line, walk;
  float echo, ring;
  float turn;  ///< Its own phase, cycles.
};

/// All needles of a frame, as the beam sees them.
struct NeedleImage {
  struct Part {
    std::size_t first_piece = 0, last_piece = 0, first_grain = 0, last_grain = 0;
    float diameter_mm = 0.0F;
    float repeat_samples = 0.0F;
  };
  static constexpr std::size_t kMostNeedles = 8;
  std::vector<ShaftPiece> pieces;  ///< Sized by make_needle_image; the parts tell how many count.
  std::vector<ShaftGrain> grains;
  std::array<Part, kMostNeedles> parts{};
  std::size_t count = 0;
  Vec3f low_T = Vec3f::Zero(), high_T = Vec3f::Zero();  ///< Box around all that is heard.
};

NeedleImage make_needle_image(const ScanPlan& plan);

/// Lays needles out along the scanlines and sets frame.drag. After refract_lines; allocates nothing.
void lay_out_needles(const ScanPlan& plan, FrameState& frame, std::span<const NeedleEcho> needles,
                     NeedleImage& image) noexcept;

/// Shadows and echoes on the scanlines [first, last), whose gains and surface echoes are there.
void add_needles(const ScanPlan& plan, FrameState& frame, const NeedleImage& image, int first, int last) noexcept;

}  // namespace trocar::ultrasound::detail
