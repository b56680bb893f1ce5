#include "xray/physics/detail/beam_sum.h"

#include <algorithm>

// Compiled for each instruction set by foreach_target.h; selected at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "xray/physics/detail/beam_sum.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::xray::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;
constexpr std::size_t kLongest = HWY_MAX_BYTES / sizeof(float);  ///< Lanes of the widest vector.

/// Two vectors of pixels at a time: the chain of one exponential leaves the processor idle.
struct Masses {
  VF a[kBases], b[kBases];
};

template <bool kHasAgent>
HWY_INLINE void sum_two(const BeamTerms& terms, const Masses& masses, VF& a, VF& b) {
  const F f;
  a = b = hn::Zero(f);
  for (std::size_t n = 0; n < terms.weight.size(); ++n) {
    VF x = hn::Zero(f), y = hn::Zero(f);
    for (std::size_t m = 0; m < (kHasAgent ? kBases : 2); ++m) {
      const VF c = hn::Set(f, terms.cm2_per_g[m][n]);
      x = hn::NegMulAdd(c, masses.a[m], x);
      y = hn::NegMulAdd(c, masses.b[m], y);
    }
    const VF w = hn::Set(f, terms.weight[n]);
    a = hn::MulAdd(w, hn::Exp(f, x), a);
    b = hn::MulAdd(w, hn::Exp(f, y), b);
  }
}

HWY_INLINE bool has_agent(const Masses& masses) {
  const F f;
  VF most = hn::Zero(f);
  for (std::size_t m = 2; m < kBases; ++m) most = hn::Max(most, hn::Max(hn::Abs(masses.a[m]), hn::Abs(masses.b[m])));
  return !hn::AllTrue(f, hn::Eq(most, hn::Zero(f)));
}

HWY_INLINE Masses load(const std::array<const float*, kBases>& g_per_cm2, std::size_t at) {
  const F f;
  Masses masses;
  for (std::size_t m = 0; m < kBases; ++m) {
    masses.a[m] = g_per_cm2[m] == nullptr ? hn::Zero(f) : hn::LoadU(f, g_per_cm2[m] + at);
    masses.b[m] = g_per_cm2[m] == nullptr ? hn::Zero(f) : hn::LoadU(f, g_per_cm2[m] + at + hn::Lanes(f));
  }
  return masses;
}

void sum_two_at(const BeamTerms& terms, const std::array<const float*, kBases>& g_per_cm2, std::size_t at,
                float* HWY_RESTRICT signal) {
  const F f;
  const Masses masses = load(g_per_cm2, at);
  VF a, b;
  if (has_agent(masses))
    sum_two<true>(terms, masses, a, b);
  else
    sum_two<false>(terms, masses, a, b);
  hn::StoreU(a, f, signal);
  hn::StoreU(b, f, signal + hn::Lanes(f));
}

void sum_pixels(const BeamTerms& terms, const std::array<const float*, kBases>& g_per_cm2, std::size_t count,
                float* HWY_RESTRICT signal) {
  const F f;
  const std::size_t lanes = 2 * hn::Lanes(f);
  std::size_t n = 0;
  for (; n + lanes <= count; n += lanes) sum_two_at(terms, g_per_cm2, n, signal + n);
  if (n == count) return;
  // The rest as a whole vector, from copies.
  float copies[kBases][2 * kLongest] = {}, rest[2 * kLongest];
  std::array<const float*, kBases> pointers{};
  for (std::size_t m = 0; m < kBases; ++m) {
    if (g_per_cm2[m] == nullptr) continue;
    std::copy(g_per_cm2[m] + n, g_per_cm2[m] + count, copies[m]);
    pointers[m] = copies[m];
  }
  sum_two_at(terms, pointers, 0, rest);
  std::copy(rest, rest + (count - n), signal + n);
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::xray::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::xray::detail {

HWY_EXPORT(sum_pixels);

void sum_terms(const BeamTerms& terms, const std::array<const float*, kBases>& g_per_cm2, std::size_t count,
               float* signal) noexcept {
  HWY_DYNAMIC_DISPATCH(sum_pixels)(terms, g_per_cm2, count, signal);
}

}  // namespace trocar::xray::detail
#endif
