#include "volume/detail/weighted_rows.h"

#include "core/result.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/detail/weighted_rows.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::volume::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void add_rows(const float* const* sources, const float* weights, std::size_t taps, float* out, std::size_t count) {
  const hn::ScalableTag<float> f;
  const std::size_t lanes = hn::Lanes(f);
  std::size_t n = 0;
  for (; n + 4 * lanes <= count; n += 4 * lanes) {
    auto a = hn::Zero(f), b = a, c = a, d = a;
    for (std::size_t t = 0; t < taps; ++t) {
      const auto weight = hn::Set(f, weights[t]);
      const float* source = sources[t] + n;
      a = hn::MulAdd(weight, hn::LoadU(f, source), a);
      b = hn::MulAdd(weight, hn::LoadU(f, source + lanes), b);
      c = hn::MulAdd(weight, hn::LoadU(f, source + 2 * lanes), c);
      d = hn::MulAdd(weight, hn::LoadU(f, source + 3 * lanes), d);
    }
    hn::StoreU(a, f, out + n);
    hn::StoreU(b, f, out + n + lanes);
    hn::StoreU(c, f, out + n + 2 * lanes);
    hn::StoreU(d, f, out + n + 3 * lanes);
  }
  for (; n + lanes <= count; n += lanes) {
    auto sum = hn::Zero(f);
    for (std::size_t t = 0; t < taps; ++t) sum = hn::MulAdd(hn::Set(f, weights[t]), hn::LoadU(f, sources[t] + n), sum);
    hn::StoreU(sum, f, out + n);
  }
  for (; n < count; ++n) {
    float sum = 0.0F;
    for (std::size_t t = 0; t < taps; ++t) sum += weights[t] * sources[t][n];
    out[n] = sum;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::volume::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::volume::detail {
HWY_EXPORT(add_rows);

void add_weighted_rows(std::span<const float* const> sources, std::span<const float> weights, std::span<float> out) {
  TROCAR_CHECK(sources.size() == weights.size());
  HWY_DYNAMIC_DISPATCH(add_rows)(sources.data(), weights.data(), weights.size(), out.data(), out.size());
}

}  // namespace trocar::volume::detail
#endif
