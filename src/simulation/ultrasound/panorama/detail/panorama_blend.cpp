#include "ultrasound/panorama/detail/panorama_blend.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/panorama/detail/panorama_blend.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that this header compiles for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The lanes of a vector that lie before `left`; stores only those.
template <class D, class V>
HWY_INLINE void store(V value, D d, int left, float* to) {
  if (left >= static_cast<int>(hn::Lanes(d)))
    hn::StoreU(value, d, to);
  else
    hn::BlendedStore(value, hn::FirstN(d, static_cast<std::size_t>(left)), d, to);
}
template <class D>
HWY_INLINE hn::Vec<D> load(D d, int left, const float* from) {
  return left >= static_cast<int>(hn::Lanes(d))
             ? hn::LoadU(d, from)
             : hn::MaskedLoad(hn::FirstN(d, static_cast<std::size_t>(left)), d, from);
}

void blend_line(const BlendLine& line) {
  const hn::ScalableTag<float> f;
  const auto one = hn::Set(f, 1.0F), least = hn::Set(f, 1e-30F);
  for (int s = 0; s < line.samples; s += static_cast<int>(hn::Lanes(f))) {
    const int left = line.samples - s;
    const auto amplitude = load(f, left, line.amplitude + s);
    const auto needle_re = load(f, left, line.re + s), needle_im = load(f, left, line.im + s);
    if (line.cast_re == nullptr) {
      store(hn::MulAdd(amplitude, load(f, left, line.phase_re + s), needle_re), f, left, line.re + s);
      store(hn::MulAdd(amplitude, load(f, left, line.phase_im + s), needle_im), f, left, line.im + s);
      continue;
    }
    const auto weight = load(f, left, line.weight + s);
    const auto re = load(f, left, line.cast_re + s), im = load(f, left, line.cast_im + s);
    const auto square = hn::MulAdd(re, re, hn::Mul(im, im));
    const auto has_phase = hn::Gt(square, least);
    const auto turn = hn::Div(amplitude, hn::Sqrt(hn::Max(square, least)));
    const auto own_re = hn::Add(needle_re, hn::IfThenElseZero(has_phase, hn::Mul(re, turn)));
    const auto own_im = hn::Add(needle_im, hn::IfThenElse(has_phase, hn::Mul(im, turn), amplitude));
    const auto rest = hn::Sub(one, weight);
    store(hn::MulAdd(rest, re, hn::Mul(weight, own_re)), f, left, line.re + s);
    store(hn::MulAdd(rest, im, hn::Mul(weight, own_im)), f, left, line.im + s);
  }
}

void amplitudes(const float* power, const float* gain, float coupling, int samples, float* amplitude, float* weight) {
  const hn::ScalableTag<float> f;
  const auto whole = hn::Set(f, kWholeWeight);
  for (int s = 0; s < samples; s += static_cast<int>(hn::Lanes(f))) {
    const int left = samples - s;
    store(hn::Mul(hn::Sqrt(load(f, left, power + s)), load(f, left, gain + s)), f, left, amplitude + s);
    const auto part = hn::Mul(load(f, left, weight + s), hn::Set(f, coupling));
    store(hn::IfThenElse(hn::Ge(part, whole), hn::Set(f, 1.0F), part), f, left, weight + s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

HWY_EXPORT(blend_line);
HWY_EXPORT(amplitudes);

void blend(const BlendLine& line) noexcept {
  HWY_DYNAMIC_DISPATCH(blend_line)(line);
}

void to_amplitude(const float* power, const float* gain, float coupling, int samples, float* amplitude,
                  float* weight) noexcept {
  HWY_DYNAMIC_DISPATCH(amplitudes)(power, gain, coupling, samples, amplitude, weight);
}

}  // namespace trocar::ultrasound::detail
#endif
