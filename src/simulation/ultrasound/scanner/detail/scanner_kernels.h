#pragma once

#include <cstddef>
#include <cstdint>

/// Steps of the scanner's back end that process every sample and every pixel (docs/physics.md U11). Compiled for every
/// instruction set and chosen at run time. Real-time safe.
namespace trocar::ultrasound::detail {

/// Stored level of an echo: steps of kLevelStep_db above kLevelFloor_db, relative to liver's speckle; 256 fine levels
/// are one step. Non-finite values (NaN, infinite) are level 0. The range of 127 dB covers what gain and dynamic range
/// can display.
inline constexpr double kLevelFloor_db = -80.0;
inline constexpr double kLevelStep_db = 0.5;
inline constexpr double kFineLevels_per_db = 256.0 / kLevelStep_db;

/// Kernels process at most this many values at a time; a scanline has at least as many samples.
inline constexpr std::size_t kMostLanes = 16;

/// Input of the detector: a section of a scanline; n >= kMostLanes.
struct ReceivedLine {
  const float* re;
  const float* im;
  const float* noise_re;
  const float* noise_im;
  float noise;              ///< Amplitude factor of the noise.
  const float* clutter_re;  ///< nullptr without clutter.
  const float* clutter_im;
  std::size_t steering_angles;  ///< Steering angles of a compound; their powers are averaged.
  std::size_t angle_step;       ///< Floats of re and im between angles.
  std::size_t noise_step;       ///< Floats of the noise between angles.
  std::size_t near_angles;      ///< Further angles behind them,
  const float* near_share;      ///< with this weight per sample; nullptr: none here.
  const float* offset;          ///< TGC of each sample minus the floor, fine levels.
  std::size_t n;
};

/// Level after TGC: mean of |echo + noise + clutter|^2 over the steering angles, in fine levels.
void detect(const ReceivedLine& line, std::uint16_t* level) noexcept;

/// state += (fresh - state) * (1 - kept). Processes n values, rounded up to a multiple of kMostLanes.
void persist(const std::uint16_t* fresh, float kept, std::size_t n, std::uint16_t* state) noexcept;

/// Sources of pixels among the samples, in blocks of kMostLanes.
struct PixelSources {
  const std::int32_t* sample;        ///< First of the four surrounding samples.
  const std::uint8_t* along_line;    ///< Weight of the next sample, in 1/255.
  const std::uint8_t* across_lines;  ///< Weight of the next line, in 1/255.
  std::int32_t line_stride;          ///< Samples between lines.
};

/// Bilinear values of `blocks` blocks of pixels; `block_start[b]` is the first pixel of each. Reads two bytes beyond
/// the last of the four samples.
void interpolate_pixels(const PixelSources& sources, const std::uint8_t* samples, const std::int32_t* block_start,
                        std::size_t blocks, std::uint8_t* pixels) noexcept;

}  // namespace trocar::ultrasound::detail
