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

/// One look of scanlines [first, last): `turn` times the plan's phase a scanline is put on the echoes before they are
/// added.
void lateral(const ScanPlan& plan, FrameState& frame, int look, float turn, int first, int last) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const std::ptrdiff_t stride = plan.stride;
  const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(look) * plan.lines * stride;
  const bool is_turned = turn != 0.0F;
  const std::vector<int>& reaches = is_turned ? plan.main_lobe_reach_at : plan.lateral_reach_at;
  for (int line = first; line < last; ++line) {
    const std::ptrdiff_t row = line * stride + kPad;
    for (int s = 0; s < plan.samples; s += lanes) {
      const VF middle = hn::LoadU(f, plan.lateral.data() + s);
      VF re = hn::Mul(middle, hn::LoadU(f, frame.re.data() + row + s));
      VF im = hn::Mul(middle, hn::LoadU(f, frame.im.data() + row + s));
      const int reach = reaches[static_cast<std::size_t>(s) / 16];
      // The phase goes on by the same turn from scanline to scanline.
      const VF phase = hn::Mul(hn::Set(f, turn), hn::LoadU(f, plan.look_turn.data() + s));
      const VF turn_re = is_turned ? hn::Cos(f, phase) : hn::Set(f, 1.0F);
      const VF turn_im = is_turned ? hn::Sin(f, phase) : hn::Zero(f);
      VF c = turn_re, d = turn_im;
      for (int k = 1; k <= reach; ++k) {
        const VF weight = hn::LoadU(f, plan.lateral.data() + static_cast<std::ptrdiff_t>(k) * plan.samples + s);
        VF left_re = hn::Zero(f), left_im = hn::Zero(f), right_re = hn::Zero(f), right_im = hn::Zero(f);
        if (line - k >= 0) {
          left_re = hn::LoadU(f, frame.re.data() + row - k * stride + s);
          left_im = hn::LoadU(f, frame.im.data() + row - k * stride + s);
        }
        if (line + k < plan.lines) {
          right_re = hn::LoadU(f, frame.re.data() + row + k * stride + s);
          right_im = hn::LoadU(f, frame.im.data() + row + k * stride + s);
        }
        const VF sum_re = hn::Add(left_re, right_re), sum_im = hn::Add(left_im, right_im);
        if (!is_turned) {
          re = hn::MulAdd(weight, sum_re, re);
          im = hn::MulAdd(weight, sum_im, im);
          continue;
        }
        // right * (c + jd) + left * (c - jd)
        const VF apart_re = hn::Sub(right_re, left_re), apart_im = hn::Sub(right_im, left_im);
        re = hn::MulAdd(weight, hn::NegMulAdd(d, apart_im, hn::Mul(c, sum_re)), re);
        im = hn::MulAdd(weight, hn::MulAdd(d, apart_re, hn::Mul(c, sum_im)), im);
        const VF next = hn::NegMulAdd(d, turn_im, hn::Mul(c, turn_re));
        d = hn::MulAdd(c, turn_im, hn::Mul(d, turn_re));
        c = next;
      }
      hn::StoreU(re, f, frame.wide_re.data() + to + row + s);
      hn::StoreU(im, f, frame.wide_im.data() + to + row + s);
    }
    // The last vector may have written beyond the scanline, where silence must stay.
    std::fill_n(frame.wide_re.begin() + to + row + plan.samples, 16, 0.0F);
    std::fill_n(frame.wide_im.begin() + to + row + plan.samples, 16, 0.0F);
  }
}

void axial(const ScanPlan& plan, const FrameState& frame, int look, int first, int last, BasebandFrame& out) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  for (int line = first; line < last; ++line) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(look) * plan.lines + line;
    const std::ptrdiff_t from = at * plan.stride + kPad, to = at * plan.samples;
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
  for (int look = 0; look < plan.looks; ++look) {
    const int side = look == 0 ? 0 : (look % 2 == 1 ? (look + 1) / 2 : -look / 2);
    HWY_DYNAMIC_DISPATCH(lateral)(plan, frame, look, static_cast<float>(side), first, last);
  }
}

void spread_axially(const ScanPlan& plan, const FrameState& frame, int first, int last, BasebandFrame& out) noexcept {
  for (int look = 0; look < plan.looks; ++look) HWY_DYNAMIC_DISPATCH(axial)(plan, frame, look, first, last, out);
}

void to_gain(const float* log_gain, const float* added, int n, float* gain) noexcept {
  HWY_DYNAMIC_DISPATCH(gains)(log_gain, added, n, gain);
}

}  // namespace trocar::detail
#endif
