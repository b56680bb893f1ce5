#include "ultrasound/detail/point_spread.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/detail/point_spread.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;

void lateral(const ScanPlan& plan, FrameState& frame, int first, int last) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const std::ptrdiff_t stride = plan.stride;
  for (int line = first; line < last; ++line) {
    const std::ptrdiff_t row = line * stride + kPad;
    for (int s = 0; s < plan.samples; s += lanes) {
      const VF middle = hn::LoadU(f, plan.lateral.data() + s);
      VF re = hn::Mul(middle, hn::LoadU(f, frame.re.data() + row + s));
      VF im = hn::Mul(middle, hn::LoadU(f, frame.im.data() + row + s));
      const int reach = plan.lateral_reach_at[static_cast<std::size_t>(s) / 16];
      for (int k = 1; k <= reach; ++k) {
        const VF weight = hn::LoadU(f, plan.lateral.data() + static_cast<std::ptrdiff_t>(k) * plan.samples + s);
        if (line - k >= 0) {
          re = hn::MulAdd(weight, hn::LoadU(f, frame.re.data() + row - k * stride + s), re);
          im = hn::MulAdd(weight, hn::LoadU(f, frame.im.data() + row - k * stride + s), im);
        }
        if (line + k < plan.lines) {
          re = hn::MulAdd(weight, hn::LoadU(f, frame.re.data() + row + k * stride + s), re);
          im = hn::MulAdd(weight, hn::LoadU(f, frame.im.data() + row + k * stride + s), im);
        }
      }
      hn::StoreU(re, f, frame.wide_re.data() + row + s);
      hn::StoreU(im, f, frame.wide_im.data() + row + s);
    }
    // The last vector may have written beyond the scanline, where silence must stay.
    std::fill_n(frame.wide_re.begin() + row + plan.samples, 16, 0.0F);
    std::fill_n(frame.wide_im.begin() + row + plan.samples, 16, 0.0F);
  }
}

void axial(const ScanPlan& plan, const FrameState& frame, int first, int last, BasebandFrame& out) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  for (int line = first; line < last; ++line) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(line) * plan.stride + kPad;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(line) * plan.samples;
    for (int s = 0; s < plan.samples; s += lanes) {
      VF re = hn::Zero(f), im = hn::Zero(f);
      for (int k = -plan.axial_reach; k <= plan.axial_reach; ++k) {
        const VF weight = hn::Set(f, plan.axial[static_cast<std::size_t>(k + plan.axial_reach)]);
        re = hn::MulAdd(weight, hn::LoadU(f, frame.wide_re.data() + from + s + k), re);
        im = hn::MulAdd(weight, hn::LoadU(f, frame.wide_im.data() + from + s + k), im);
      }
      const auto n = static_cast<std::size_t>(std::min(lanes, plan.samples - s));
      if (n == static_cast<std::size_t>(lanes)) {
        hn::StoreU(re, f, out.re.data() + to + s);
        hn::StoreU(im, f, out.im.data() + to + s);
      } else {
        hn::BlendedStore(re, hn::FirstN(f, n), f, out.re.data() + to + s);
        hn::BlendedStore(im, hn::FirstN(f, n), f, out.im.data() + to + s);
      }
    }
  }
}

void gains(const float* log_gain, const float* added, int n, float* gain) {
  const F f;
  const VF floor = hn::Set(f, -80.0F);
  for (int s = 0; s < n; s += static_cast<int>(hn::Lanes(f))) {
    const VF sum = hn::Add(hn::LoadU(f, log_gain + s), hn::LoadU(f, added + s));
    const VF value =
        hn::IfThenZeroElse(hn::Lt(sum, floor), hn::Exp(f, hn::Min(hn::Max(sum, floor), hn::Set(f, 20.0F))));
    const auto left = static_cast<std::size_t>(n - s);
    if (left >= hn::Lanes(f))
      hn::StoreU(value, f, gain + s);
    else
      hn::BlendedStore(value, hn::FirstN(f, left), f, gain + s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::detail {

HWY_EXPORT(lateral);
HWY_EXPORT(axial);
HWY_EXPORT(gains);

void spread_laterally(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  HWY_DYNAMIC_DISPATCH(lateral)(plan, frame, first, last);
}

void spread_axially(const ScanPlan& plan, const FrameState& frame, int first, int last, BasebandFrame& out) noexcept {
  HWY_DYNAMIC_DISPATCH(axial)(plan, frame, first, last, out);
}

void to_gain(const float* log_gain, const float* added, int n, float* gain) noexcept {
  HWY_DYNAMIC_DISPATCH(gains)(log_gain, added, n, gain);
}

}  // namespace trocar::detail
#endif
