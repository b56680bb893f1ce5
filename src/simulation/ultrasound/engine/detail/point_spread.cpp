#include "ultrasound/engine/detail/point_spread.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/engine/detail/point_spread.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;

void loudest(const ScanPlan& plan, FrameState& frame, int line) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const float* const re = frame.re.data() + plan.echo_row(line);
  const float* const im = frame.im.data() + plan.echo_row(line);
  const std::size_t row = static_cast<std::size_t>(plan.lines + 2 * plan.lateral_reach);
  float* to = frame.loudest.data() + plan.lateral_reach + line;
  for (int begin = 0; begin < plan.samples; begin += kLobeBlock, to += row) {
    VF most = hn::Zero(f);
    for (int s = begin; s < begin + kLobeBlock; s += lanes)
      most = hn::Max(most, hn::Max(hn::Abs(hn::LoadU(f, re + s)), hn::Abs(hn::LoadU(f, im + s))));
    *to = hn::GetLane(hn::MaxOfLanes(f, most));
  }
}

/// Whether the side lobes of neighbours contribute to a block of a scanline: a lobe is 40 dB below its main lobe, and
/// without a much louder neighbour its share is below 2 % of the scanline's own echoes.
HWY_INLINE bool lobes_show(const ScanPlan& plan, const FrameState& frame, int line, std::size_t block) {
  constexpr float kLouder = 5.0F;
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const std::size_t row = static_cast<std::size_t>(plan.lines + 2 * plan.lateral_reach);
  const float* const middle = frame.loudest.data() + block * row + plan.lateral_reach + line;
  const int reach = plan.lateral_reach_at[block], main_lobe = std::min(plan.main_lobe_reach_at[block], reach);
  const auto most_in = [&](int first, int last) {
    VF most = hn::Zero(f);
    for (int k = first; k <= last; k += lanes) {
      const auto n = static_cast<std::size_t>(std::min(lanes, last - k + 1));
      most = hn::Max(most, hn::MaskedLoad(hn::FirstN(f, n), f, middle + k));
    }
    return hn::GetLane(hn::MaxOfLanes(f, most));
  };
  return std::max(most_in(-reach, -main_lobe - 1), most_in(main_lobe + 1, reach)) >
         kLouder * most_in(-main_lobe, main_lobe);
}

/// The lateral point spread of samples of one scanline, for the central angle and `kSides` steering angles to each
/// side.
template <std::size_t kSides>
HWY_INLINE void spread_laterally(const ScanPlan& plan, const FrameState& frame, int line, int first, int last,
                                 SteeringRows& rows) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const std::ptrdiff_t stride = plan.stride, samples = plan.samples;
  for (int s = first; s < last; s += lanes) {
    const float* const at_re = frame.re.data() + plan.echo_row(line) + s;
    const float* const at_im = frame.im.data() + plan.echo_row(line) + s;
    const float* weights = plan.lateral.data() + s;
    VF re = hn::Mul(hn::LoadU(f, weights), hn::LoadU(f, at_re));
    VF im = hn::Mul(hn::LoadU(f, weights), hn::LoadU(f, at_im));
    // Steering angles to both sides: common part and difference.
    VF both_re[kSides + 1], both_im[kSides + 1], apart_re[kSides + 1], apart_im[kSides + 1];
    for (std::size_t side = 0; side < kSides; ++side) {
      both_re[side] = re;
      both_im[side] = im;
      apart_re[side] = apart_im[side] = hn::Zero(f);
    }
    const auto block = static_cast<std::size_t>(s) / 16;
    const int reach = plan.lateral_reach_at[block], main_lobe = std::min(plan.main_lobe_reach_at[block], reach);
    for (int k = 1; k <= main_lobe; ++k) {
      const VF left_re = hn::LoadU(f, at_re - k * stride), right_re = hn::LoadU(f, at_re + k * stride);
      const VF left_im = hn::LoadU(f, at_im - k * stride), right_im = hn::LoadU(f, at_im + k * stride);
      const VF sum_re = hn::Add(left_re, right_re), sum_im = hn::Add(left_im, right_im);
      const VF weight = hn::LoadU(f, weights + k * samples);
      re = hn::MulAdd(weight, sum_re, re);
      im = hn::MulAdd(weight, sum_im, im);
      const VF difference_re = hn::Sub(right_re, left_re), difference_im = hn::Sub(right_im, left_im);
      for (std::size_t side = 0; side < kSides; ++side) {
        const std::size_t row = plan.side_row(side, k) + static_cast<std::size_t>(s);
        const VF cosine = hn::LoadU(f, plan.side_cosine.data() + row), sine = hn::LoadU(f, plan.side_sine.data() + row);
        both_re[side] = hn::MulAdd(cosine, sum_re, both_re[side]);
        both_im[side] = hn::MulAdd(cosine, sum_im, both_im[side]);
        apart_re[side] = hn::NegMulAdd(sine, difference_im, apart_re[side]);
        apart_im[side] = hn::MulAdd(sine, difference_re, apart_im[side]);
      }
    }
    const bool has_lobes = reach > main_lobe && lobes_show(plan, frame, line, block);
    for (int k = main_lobe + 1; has_lobes && k <= reach; ++k) {
      const VF weight = hn::LoadU(f, weights + k * samples);
      re = hn::MulAdd(weight, hn::Add(hn::LoadU(f, at_re - k * stride), hn::LoadU(f, at_re + k * stride)), re);
      im = hn::MulAdd(weight, hn::Add(hn::LoadU(f, at_im - k * stride), hn::LoadU(f, at_im + k * stride)), im);
    }
    hn::StoreU(re, f, rows.re(0) + s);
    hn::StoreU(im, f, rows.im(0) + s);
    for (std::size_t side = 0; side < kSides; ++side) {
      hn::StoreU(hn::Add(both_re[side], apart_re[side]), f, rows.re(2 * side + 1) + s);
      hn::StoreU(hn::Add(both_im[side], apart_im[side]), f, rows.im(2 * side + 1) + s);
      hn::StoreU(hn::Sub(both_re[side], apart_re[side]), f, rows.re(2 * side + 2) + s);
      hn::StoreU(hn::Sub(both_im[side], apart_im[side]), f, rows.im(2 * side + 2) + s);
    }
  }
}

/// The pulse along one scanline; `from` is zero-padded at both ends.
HWY_INLINE void spread_axially(const ScanPlan& plan, const float* from, int samples, float* to) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  for (int s = 0; s < samples; s += lanes) {
    VF sum = hn::Mul(hn::Set(f, plan.axial[0]), hn::LoadU(f, from + s));
    for (int k = 1; k <= plan.axial_reach; ++k) {
      const VF sides = hn::Add(hn::LoadU(f, from + s - k), hn::LoadU(f, from + s + k));
      sum = hn::MulAdd(hn::Set(f, plan.axial[static_cast<std::size_t>(k)]), sides, sum);
    }
    const auto n = static_cast<std::size_t>(std::min(lanes, samples - s));
    if (n == static_cast<std::size_t>(lanes))
      hn::StoreU(sum, f, to + s);
    else
      hn::BlendedStore(sum, hn::FirstN(f, n), f, to + s);
  }
}

void spread(const ScanPlan& plan, const FrameState& frame, int line, SteeringRows& rows, BasebandFrame& out) {
  // Beyond near_samples the pulse still reaches back.
  const int near_end = plan.near_angles > 0 ? std::min(plan.near_samples + kPad, plan.samples) : 0;
  switch (plan.steering_angles / 2) {
    case 0:
      spread_laterally<0>(plan, frame, line, 0, plan.samples, rows);
      break;
    case 1:
      spread_laterally<2>(plan, frame, line, 0, near_end, rows);
      spread_laterally<1>(plan, frame, line, near_end, plan.samples, rows);
      break;
    default:
      spread_laterally<2>(plan, frame, line, 0, plan.samples, rows);
      break;
  }
  rows.clear_padding();
  for (int angle = 0; angle < plan.steering_angles + plan.near_angles; ++angle) {
    const std::size_t to = static_cast<std::size_t>(angle * plan.lines + line) * static_cast<std::size_t>(plan.samples);
    const int samples = angle < plan.steering_angles ? plan.samples : plan.near_samples;
    spread_axially(plan, rows.re(static_cast<std::size_t>(angle)), samples, out.re.data() + to);
    spread_axially(plan, rows.im(static_cast<std::size_t>(angle)), samples, out.im.data() + to);
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
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

HWY_EXPORT(spread);
HWY_EXPORT(gains);
HWY_EXPORT(loudest);

SteeringRows::SteeringRows(const ScanPlan& plan)
    : stride_(static_cast<std::size_t>(plan.stride)), samples_(static_cast<std::size_t>(plan.samples)) {
  // Steering angles come in pairs in addition to the central one.
  angles_ = static_cast<std::size_t>((plan.steering_angles + plan.near_angles) / 2 * 2 + 1);
  values_.assign(2 * angles_ * stride_, 0.0F);
}

void SteeringRows::clear_padding() noexcept {
  constexpr std::size_t kMostLanes = 16;
  for (std::size_t row = 0; row < 2 * angles_; ++row)
    std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(row * stride_ + kPad + samples_), kMostLanes, 0.0F);
}

void spread_echoes(const ScanPlan& plan, const FrameState& frame, int line, SteeringRows& rows,
                   BasebandFrame& out) noexcept {
  HWY_DYNAMIC_DISPATCH(spread)(plan, frame, line, rows, out);
}

void find_loudest(const ScanPlan& plan, FrameState& frame, int line) noexcept {
  HWY_DYNAMIC_DISPATCH(loudest)(plan, frame, line);
}

void to_gain(const float* log_gain, const float* added, int n, float* gain) noexcept {
  HWY_DYNAMIC_DISPATCH(gains)(log_gain, added, n, gain);
}

}  // namespace trocar::ultrasound::detail
#endif
