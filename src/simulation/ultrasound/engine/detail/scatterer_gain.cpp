#include "ultrasound/engine/detail/scatterer_gain.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/engine/detail/scatterer_gain.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that this header compiles for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void pack(const float* log_gain, const float* added, const std::uint8_t* share_classes, int n, ScattererGain* gains) {
  const hn::ScalableTag<float> f;
  const hn::RebindToSigned<decltype(f)> d;
  const hn::Rebind<std::uint8_t, decltype(f)> bytes;
  const hn::Rebind<std::uint16_t, decltype(f)> words;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  for (int s = 0; s < n; s += lanes) {
    const auto sum = hn::Add(hn::LoadU(f, log_gain + s), hn::LoadU(f, added + s));
    const auto steps = hn::Mul(hn::Sub(sum, hn::Set(f, kLeastLogGain)), hn::Set(f, 1.0F / kLogGainStep));
    const auto level = hn::NearestInt(hn::Min(hn::Max(steps, hn::Zero(f)), hn::Set(f, 8191.0F)));
    const auto share = hn::PromoteTo(d, hn::LoadU(bytes, share_classes + s));
    const auto packed = hn::DemoteTo(words, hn::Or(hn::ShiftLeft<kShareBits>(level), share));
    if (n - s >= lanes)
      hn::StoreU(packed, words, gains + s);
    else
      hn::BlendedStore(packed, hn::FirstN(words, static_cast<std::size_t>(n - s)), words, gains + s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

HWY_EXPORT(pack);

void pack_gains(const float* log_gain, const float* added, const std::uint8_t* share_classes, int n,
                ScattererGain* gains) noexcept {
  HWY_DYNAMIC_DISPATCH(pack)(log_gain, added, share_classes, n, gains);
}

std::uint8_t share_class(double share) noexcept {
  std::size_t best = 0;
  for (std::size_t c = 1; c < kShares.size(); ++c)
    if (std::abs(static_cast<double>(kShares[c]) - share) < std::abs(static_cast<double>(kShares[best]) - share))
      best = c;
  return static_cast<std::uint8_t>(best);
}

}  // namespace trocar::ultrasound::detail
#endif
