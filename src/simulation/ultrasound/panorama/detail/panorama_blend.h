#pragma once

/// Joins the echoes of a panorama with those of the ray-cast engine (docs/physics.md U18).
namespace trocar::ultrasound::detail {

/// Echoes of one scanline at one steering angle, `samples` values each.
struct BlendLine {
  const float* amplitude = nullptr;  ///< Of the panorama.
  const float* weight = nullptr;     ///< Of the panorama, 0..1.
  const float* phase_re = nullptr;   ///< Phase of the panorama's echoes, of modulus 1.
  const float* phase_im = nullptr;
  const float* cast_re = nullptr;  ///< Of the ray-cast engine; nullptr: the panorama alone.
  const float* cast_im = nullptr;
  float* re = nullptr;  ///< Needles in the panorama; receives the result.
  float* im = nullptr;
  int samples = 0;
};

/// (1 - w) b + w (a u + n): b ray-cast echo, u its phase (b / |b|), a amplitude of the panorama, n needle. Without a
/// ray-cast echo w = 1 and u is the phase of the line.
void blend(const BlendLine& line) noexcept;

/// amplitude[s] = sqrt(power[s]) * gain[s]; weight[s] *= coupling, and 1 from kWholeWeight on.
void to_amplitude(const float* power, const float* gain, float coupling, int samples, float* amplitude,
                  float* weight) noexcept;
/// Share of the panorama that counts as all of it, so that no scanline is ray cast for a difference nobody sees.
inline constexpr float kWholeWeight = 0.98F;

}  // namespace trocar::ultrasound::detail
