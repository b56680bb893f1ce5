#pragma once

#include <cstddef>
#include <cstdint>

/// The steps of the scanner's back end that run over every sample and every pixel (docs/physics.md U11). Compiled
/// for every instruction set and chosen at run time. Real-time safe.
namespace trocar::ultrasound::detail {

/// Level of an echo as it is kept: steps of kLevelStep_db above kLevelFloor_db, against liver's speckle; 256 fine
/// levels are one step. What is no number (NaN, infinite) is level 0. The 127 dB hold what gain and dynamic range can
/// show.
inline constexpr double kLevelFloor_db = -80.0;
inline constexpr double kLevelStep_db = 0.5;
inline constexpr double kFineLevels_per_db = 256.0 / kLevelStep_db;

/// Kernels work on at most that many values at a time; a scanline has at least as many samples.
inline constexpr std::size_t kMostLanes = 16;

/// A stretch of a scanline on its way to the detector; n >= kMostLanes.
struct ReceivedLine {
  const float* re;
  const float* im;
  const float* noise_re;
  const float* noise_im;
  float noise;              ///< Amplitude the noise is added with.
  const float* clutter_re;  ///< Null without clutter.
  const float* clutter_im;
  std::size_t steering_angles;  ///< Of a compound; their powers are averaged.
  std::size_t angle_step;       ///< Floats of re and im from angle to angle.
  std::size_t noise_step;       ///< The same of the noise.
  const float* offset;          ///< TGC of each sample less the floor, fine levels.
  std::size_t n;
};

/// Level after TGC: mean of |echo + noise + clutter|^2 over the steering_angles, in fine levels.
void detect(const ReceivedLine& line, std::uint16_t* level) noexcept;

/// state += (fresh - state) * (1 - kept). Works on n rounded up to a multiple of kMostLanes.
void persist(const std::uint16_t* fresh, float kept, std::size_t n, std::uint16_t* state) noexcept;

/// Where pixels lie among the samples, in blocks of kMostLanes.
struct PixelSources {
  const std::int32_t* sample;        ///< First of the four samples around.
  const std::uint8_t* along_line;    ///< Weight of the next sample, of 255.
  const std::uint8_t* across_lines;  ///< Weight of the next line, of 255.
  std::int32_t line_stride;          ///< Samples from line to line.
};

/// Bilinear values of `blocks` blocks of pixels, `block_start[b]` the first pixel of each. Reads two bytes beyond the
/// last of the four samples.
void interpolate_pixels(const PixelSources& sources, const std::uint8_t* samples, const std::int32_t* block_start,
                        std::size_t blocks, std::uint8_t* pixels) noexcept;

}  // namespace trocar::ultrasound::detail
