#include "ultrasound/scanner/detail/scanner_kernels.h"

#include <bit>

// Compiled for each instruction set by foreach_target.h; selected at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/scanner/detail/scanner_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that this header compiles for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kMostLanes>;
using I = hn::RebindToSigned<F>;
using U16 = hn::Rebind<std::uint16_t, F>;
using U8 = hn::Rebind<std::uint8_t, F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

/// Logarithm to base 2 of positive normal numbers, to 1.2e-4 (0.0004 dB of power): the exponent, and for the mantissa
/// 1 + m the polynomial m + m (1 - m) (a + b m + c m^2), which joins without a step (fitted for least greatest error).
HWY_INLINE VF log2_of(VF x) {
  const F f;
  const I d;
  const VI bits = hn::BitCast(d, x);
  const VF exponent = hn::ConvertTo(f, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(d, 127)));
  const VI mantissa = hn::Or(hn::And(bits, hn::Set(d, 0x7fffff)), hn::Set(d, 0x3f800000));
  const VF m = hn::Sub(hn::BitCast(f, mantissa), hn::Set(f, 1.0F));
  const VF slope = hn::MulAdd(hn::Set(f, 0.08212954F), m, hn::Set(f, -0.23905703F));
  const VF inner = hn::MulAdd(slope, m, hn::Set(f, 0.43872548F));
  const VF bend = hn::Mul(m, hn::Sub(hn::Set(f, 1.0F), m));
  return hn::Add(exponent, hn::MulAdd(bend, inner, m));
}

/// Sum of the powers of some angles.
template <bool kWithClutter>
HWY_INLINE VF power_of(const ReceivedLine& line, std::size_t s, std::size_t first, std::size_t last) {
  const F f;
  const VF noise = hn::Set(f, line.noise);
  VF power = hn::Zero(f);
  for (std::size_t angle = first; angle < last; ++angle) {
    const std::size_t at = s + angle * line.angle_step, noise_at = s + angle * line.noise_step;
    VF re = hn::MulAdd(noise, hn::LoadU(f, line.noise_re + noise_at), hn::LoadU(f, line.re + at));
    VF im = hn::MulAdd(noise, hn::LoadU(f, line.noise_im + noise_at), hn::LoadU(f, line.im + at));
    if constexpr (kWithClutter) {
      re = hn::Add(re, hn::LoadU(f, line.clutter_re + s));
      im = hn::Add(im, hn::LoadU(f, line.clutter_im + s));
    }
    power = hn::MulAdd(re, re, hn::MulAdd(im, im, power));
  }
  return power;
}

template <bool kWithClutter, bool kWithNear>
HWY_INLINE void detect_at(const ReceivedLine& line, std::size_t s, std::uint16_t* HWY_RESTRICT level) {
  const F f;
  VF power = power_of<kWithClutter>(line, s, 0, line.steering_angles);
  if constexpr (kWithNear) {
    const std::size_t all = line.steering_angles + line.near_angles;
    const VF share = hn::LoadU(f, line.near_share + s);
    const VF weights = hn::MulAdd(share, hn::Set(f, static_cast<float>(line.near_angles)),
                                  hn::Set(f, static_cast<float>(line.steering_angles)));
    power = hn::Div(hn::MulAdd(share, power_of<kWithClutter>(line, s, line.steering_angles, all), power), weights);
  } else {
    power = hn::Mul(power, hn::Set(f, 1.0F / static_cast<float>(line.steering_angles)));
  }
  // Far outside the displayed range; the comparison is false for NaN.
  const VF least = hn::Set(f, 1e-30F);
  const VF clean = hn::Max(hn::IfThenElse(hn::Lt(power, hn::Set(f, 1e38F)), power, least), least);
  constexpr auto kScale = static_cast<float>(3.01029995663981 * kFineLevels_per_db);
  const VF fine = hn::MulAdd(log2_of(clean), hn::Set(f, kScale), hn::LoadU(f, line.offset + s));
  const VF shown = hn::Min(hn::Max(fine, hn::Zero(f)), hn::Set(f, 65535.0F));
  hn::StoreU(hn::DemoteTo(U16(), hn::NearestInt(shown)), U16(), level + s);
}

template <bool kWithClutter, bool kWithNear>
HWY_INLINE void detect_all(const ReceivedLine& line, std::uint16_t* HWY_RESTRICT level) {
  const std::size_t lanes = hn::Lanes(F());
  std::size_t s = 0;
  for (; s + lanes <= line.n; s += lanes) detect_at<kWithClutter, kWithNear>(line, s, level);
  if (s < line.n) detect_at<kWithClutter, kWithNear>(line, line.n - lanes, level);
}

void detect(const ReceivedLine& line, std::uint16_t* HWY_RESTRICT level) {
  const bool has_near = line.near_share != nullptr;
  if (line.clutter_re != nullptr) {
    has_near ? detect_all<true, true>(line, level) : detect_all<true, false>(line, level);
  } else {
    has_near ? detect_all<false, true>(line, level) : detect_all<false, false>(line, level);
  }
}

HWY_INLINE VF load_levels(const std::uint16_t* levels) {
  return hn::ConvertTo(F(), hn::PromoteTo(I(), hn::LoadU(U16(), levels)));
}

void persist(const std::uint16_t* HWY_RESTRICT fresh, float kept, std::size_t n, std::uint16_t* HWY_RESTRICT state) {
  const F f;
  const VF part = hn::Set(f, kept);
  for (std::size_t s = 0; s < n; s += hn::Lanes(f)) {
    const VF now = load_levels(fresh + s);
    const VF mixed = hn::MulAdd(hn::Sub(load_levels(state + s), now), part, now);
    hn::StoreU(hn::DemoteTo(U16(), hn::NearestInt(mixed)), U16(), state + s);
  }
}

HWY_INLINE VF load_weights(const std::uint8_t* weights) {
  const F f;
  return hn::Mul(hn::ConvertTo(f, hn::PromoteTo(I(), hn::LoadU(U8(), weights))), hn::Set(f, 1.0F / 255.0F));
}

/// Interpolates between a sample (lowest byte) and the next on its line.
HWY_INLINE VF between_samples(VI four, VF weight) {
  const F f;
  const VI byte = hn::Set(I(), 0xff);
  const VF first = hn::ConvertTo(f, hn::And(four, byte));
  const VF second = hn::ConvertTo(f, hn::And(hn::ShiftRight<8>(four), byte));
  return hn::MulAdd(hn::Sub(second, first), weight, first);
}

void interpolate_pixels(const PixelSources& sources, const std::uint8_t* HWY_RESTRICT samples,
                        const std::int32_t* HWY_RESTRICT block_start, std::size_t blocks,
                        std::uint8_t* HWY_RESTRICT pixels) {
  const F f;
  const auto* base = reinterpret_cast<const std::int32_t*>(samples);
  const VI stride = hn::Set(I(), sources.line_stride);
  for (std::size_t b = 0; b < blocks; ++b) {
    std::uint8_t* const target = pixels + block_start[b];
    for (std::size_t i = 0; i < kMostLanes; i += hn::Lanes(f)) {
      const std::size_t entry = b * kMostLanes + i;
      const VI sample = hn::LoadU(I(), sources.sample + entry);
      const VF along = load_weights(sources.along_line + entry);
      const VF near = between_samples(hn::GatherOffset(I(), base, sample), along);
      const VF far = between_samples(hn::GatherOffset(I(), base, hn::Add(sample, stride)), along);
      const VF value = hn::MulAdd(hn::Sub(far, near), load_weights(sources.across_lines + entry), near);
      hn::StoreU(hn::DemoteTo(U8(), hn::NearestInt(value)), U8(), target + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

static_assert(std::endian::native == std::endian::little,
              "the lowest byte of a gathered word must be its first sample");

HWY_EXPORT(detect);
HWY_EXPORT(persist);
HWY_EXPORT(interpolate_pixels);

void detect(const ReceivedLine& line, std::uint16_t* level) noexcept {
  HWY_DYNAMIC_DISPATCH(detect)(line, level);
}

void persist(const std::uint16_t* fresh, float kept, std::size_t n, std::uint16_t* state) noexcept {
  HWY_DYNAMIC_DISPATCH(persist)(fresh, kept, n, state);
}

void interpolate_pixels(const PixelSources& sources, const std::uint8_t* samples, const std::int32_t* block_start,
                        std::size_t blocks, std::uint8_t* pixels) noexcept {
  HWY_DYNAMIC_DISPATCH(interpolate_pixels)(sources, samples, block_start, blocks, pixels);
}

}  // namespace trocar::ultrasound::detail
#endif
