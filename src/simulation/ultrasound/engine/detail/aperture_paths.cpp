#include "ultrasound/engine/detail/aperture_paths.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/engine/detail/aperture_paths.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#ifndef TROCAR_ULTRASOUND_APERTURE_TYPES
#define TROCAR_ULTRASOUND_APERTURE_TYPES
namespace trocar::ultrasound::detail {

/// Rays of a depth, on either side of the scanline's own.
inline constexpr int kSideRays = 4;
inline constexpr int kRays = 2 * kSideRays + 1;
inline constexpr int kMargin = 16;       ///< Values beside a row of scanlines, equal to the outermost.
inline constexpr int kDepths = 16;       ///< Coarse depths that are transposed together.
inline constexpr float kOpaque = 60.0F;  // neper

/// Rows of a value per scanline, with margins.
class LineRows {
 public:
  LineRows(std::vector<float>& floats, int lines) noexcept
      : first_(floats.data()), width_((lines + kMargin + 15) / 16 * 16 + kMargin) {}
  float* row(int n) const noexcept { return first_ + n * width_ + kMargin; }
  static constexpr int kRowCount = 2 * kRays + 2 * kDepths + 1;
  static std::size_t floats(int lines) noexcept {
    return static_cast<std::size_t>(kRowCount) * static_cast<std::size_t>((lines + kMargin + 15) / 16 * 16 + kMargin) +
           kMargin;
  }

 private:
  float* first_;
  int width_;
};

/// Where the losses of a ray come from: scanlines aside at the depth before.
struct RayStep {
  int shift = 0;
  float part = 0.0F;    ///< 0..1, between scanlines `shift` and `shift + 1` aside.
  float weight = 0.0F;  ///< Of the ray at that depth.
};

}  // namespace trocar::ultrasound::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The sound that reaches one depth of each scanline. `from`: losses of a ray up to the depth before; `to`: up to this.
void add_ray(const float* from, const float* loss, const RayStep& step, int lines, float* to, float* sum) {
  const hn::ScalableTag<float> f;
  const auto part = hn::Set(f, step.part), weight = hn::Set(f, step.weight);
  for (int l = 0; l < lines; l += static_cast<int>(hn::Lanes(f))) {
    const auto left = hn::LoadU(f, from + l + step.shift), right = hn::LoadU(f, from + l + step.shift + 1);
    const auto aside = hn::MulAdd(part, hn::Sub(right, left), left);
    const auto whole = hn::Min(hn::Add(aside, hn::LoadU(f, loss + l)), hn::Set(f, kOpaque));
    hn::StoreU(whole, f, to + l);
    // One way; the echo returns through the same aperture.
    const auto passed = hn::Exp(f, hn::Mul(whole, hn::Set(f, -0.5F)));
    hn::StoreU(hn::MulAdd(weight, passed, hn::LoadU(f, sum + l)), f, sum + l);
  }
}

/// Both ways, neper.
void to_log(int lines, float* sum) {
  const hn::ScalableTag<float> f;
  for (int l = 0; l < lines; l += static_cast<int>(hn::Lanes(f))) {
    const auto least = hn::Set(f, 1e-13F);
    const auto log = hn::Log(f, hn::Max(hn::LoadU(f, sum + l), least));
    hn::StoreU(hn::Add(log, log), f, sum + l);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

HWY_EXPORT(add_ray);
HWY_EXPORT(to_log);

namespace {

/// Share of the receive aperture whose sound is coherent behind an obstacle (assumed, range 0.3..1).
constexpr double kCoherentShare = 0.5;

/// The rays of a depth. Beyond aperture * f-number the aperture no longer grows. The sum of the weights is 1.
std::array<RayStep, kRays> rays_at(const ScanPlan& plan, std::size_t c) noexcept {
  const double step_mm = kCoarse * static_cast<double>(plan.sample_mm);
  const double f_number = std::max(plan.beam.f_number, static_cast<double>(c) * step_mm / plan.beam.aperture_mm);
  const double sigma = kGaussianAperture * kCoherentShare / f_number;
  const double steepest = 0.5 * kCoherentShare / plan.beam.f_number;  // sideways over depth
  std::array<RayStep, kRays> rays{};
  float sum = 0.0F;
  for (int n = 0; n < kRays; ++n) {
    const double slope = steepest * (n - kSideRays) / kSideRays;
    const double lines =
        std::clamp(slope * step_mm / static_cast<double>(plan.coarse_spacing_mm[c]), 1.0 - kMargin, kMargin - 2.0);
    RayStep& ray = rays[static_cast<std::size_t>(n)];
    ray.shift = static_cast<int>(std::floor(lines));
    ray.part = static_cast<float>(lines - ray.shift);
    ray.weight = static_cast<float>(std::exp(-0.5 * std::pow(slope / sigma, 2)));
    sum += ray.weight;
  }
  for (RayStep& ray : rays) ray.weight /= sum;
  return rays;
}

void extend(float* row, int lines) noexcept {
  std::fill_n(row - kMargin, kMargin, row[0]);
  std::fill_n(row + lines, kMargin, row[lines - 1]);
}

/// Samples from which no sound returns, per scanline.
void note_reach(const ScanPlan& plan, FrameState& frame, int line) noexcept {
  const auto coarse = plan.coarse_samples();
  const float* const open = frame.open_way.data() + static_cast<std::size_t>(line) * coarse;
  auto reached = static_cast<int>(coarse);
  while (reached > 0 && open[reached - 1] < kInaudible) --reached;
  const float reached_mm = static_cast<float>((reached + 1) * kCoarse) * plan.sample_mm;
  const bool is_mirrored = frame.walks[static_cast<std::size_t>(line)].mirror_depth_mm < reached_mm;
  frame.reach[static_cast<std::size_t>(line)] = is_mirrored ? plan.samples : std::min(reached * kCoarse, plan.samples);
}

}  // namespace

std::size_t aperture_floats(const ScanPlan& plan) noexcept {
  return LineRows::floats(plan.lines);
}

void open_aperture(const ScanPlan& plan, FrameState& frame, int first, int last, std::vector<float>& floats) noexcept {
  const auto coarse = plan.coarse_samples();
  const LineRows rows(floats, plan.lines);
  const auto ways = [&](int depth) { return rows.row(2 * kRays + depth); };
  const auto opened = [&](int depth) { return rows.row(2 * kRays + kDepths + depth); };
  float* const loss = rows.row(2 * kRays + 2 * kDepths);
  std::array<float*, kRays> now{}, next{};
  for (int ray = 0; ray < kRays; ++ray) {
    now[static_cast<std::size_t>(ray)] = rows.row(ray);
    next[static_cast<std::size_t>(ray)] = rows.row(kRays + ray);
    std::fill_n(now[static_cast<std::size_t>(ray)] - kMargin, plan.lines + 2 * kMargin, 0.0F);
  }
  std::fill_n(ways(kDepths - 1), plan.lines, 0.0F);
  for (std::size_t begin = 0; begin < coarse; begin += kDepths) {
    const auto depths = static_cast<int>(std::min<std::size_t>(kDepths, coarse - begin));
    std::copy_n(ways(kDepths - 1), plan.lines, loss);  // the depth before, until its difference is taken
    for (int l = 0; l < plan.lines; ++l)
      for (int d = 0; d < depths; ++d)
        ways(d)[l] = frame.probed_way[static_cast<std::size_t>(l) * coarse + begin + static_cast<std::size_t>(d)];
    for (int d = 0; d < depths; ++d) {
      const float* const before = d == 0 ? loss : ways(d - 1);
      for (int l = 0; l < plan.lines; ++l) loss[l] = std::max(before[l] - ways(d)[l], 0.0F);
      std::fill_n(opened(d), plan.lines, 0.0F);
      const auto rays = rays_at(plan, begin + static_cast<std::size_t>(d));
      for (std::size_t ray = 0; ray < kRays; ++ray) {
        HWY_DYNAMIC_DISPATCH(add_ray)(now[ray], loss, rays[ray], plan.lines, next[ray], opened(d));
        extend(next[ray], plan.lines);
      }
      std::swap(now, next);
      HWY_DYNAMIC_DISPATCH(to_log)(plan.lines, opened(d));
    }
    for (int l = first; l < last; ++l)
      for (int d = 0; d < depths; ++d)
        frame.open_way[static_cast<std::size_t>(l) * coarse + begin + static_cast<std::size_t>(d)] = opened(d)[l];
  }
  for (int l = first; l < last; ++l) note_reach(plan, frame, l);
}

namespace {

/// Values at the coarse steps around a block of samples.
struct Ends {
  float from, to;
  auto between() const noexcept {
    using Samples = Eigen::Array<float, kCoarse, 1>;
    static const Samples parts = Samples::LinSpaced(kCoarse, 0.0F, kCoarse - 1.0F) / static_cast<float>(kCoarse);
    return from + (to - from) * parts;
  }
};

/// Attenuation takes the high frequencies first: the spectrum's centre falls by s^2 D, and an echo is louder by
/// s^2 D^2 / 2 than at the former centre (s standard deviation of the spectrum, D derivative of the loss by frequency).
struct Spectrum {
  explicit Spectrum(const ScanPlan& plan) noexcept {
    if (!plan.acquisition.artefacts.downshift) return;
    share = static_cast<float>(plan.beam.spectrum_sigma() * plan.beam.spectrum_sigma());
    most_bent = static_cast<float>(kMostDownshift) / share;
  }
  /// `loss`: frequency times D, neper.
  float gain(float loss) const noexcept {
    const float bent = std::clamp(loss, 0.0F, most_bent);  // beyond the largest shift the gain grows linearly
    return share * bent * (loss - 0.5F * bent);
  }

  float share = 0.0F;  ///< (s / frequency)^2; 0: no downshift.
  float most_bent = 0.0F;
};

/// Where the way of a scanline to its mirror ends; infinite: no mirror. The fitted mirror may lie beside the border.
float mirror_sample(const ScanPlan& plan, const FrameState& frame, int line) noexcept {
  const auto at = static_cast<std::size_t>(line);
  if (!frame.walks[at].has_mirror()) return std::numeric_limits<float>::infinity();
  return std::min(frame.walks[at].mirror_depth_mm / plan.sample_mm, frame.gas[at].border.walk) - kCoarse;
}

}  // namespace

void apply_paths(const ScanPlan& plan, const FrameState& frame, int line, WalkResult& walk) noexcept {
  const auto row = static_cast<std::size_t>(line) * plan.coarse_samples();
  const float *open = frame.open_way.data() + row, *own = frame.probed_way.data() + row,
              *path = frame.path_log.data() + row, *absorbed = frame.absorbed.data() + row;
  // A plane beside the image is at most as bright as the central one in its shadow, or as it is by itself.
  const auto opened = [&](std::size_t c, float way) {
    return std::min(open[c] - own[c], std::max(0.0F, open[c] - way));
  };
  const Spectrum spectrum(plan);
  const auto changed = [&](std::size_t c, float way) {
    return path[c] + spectrum.gain(std::min(absorbed[c], -way - opened(c, way)));
  };
  const float mirror = mirror_sample(plan, frame, line);
  bool is_straight = true;
  float held = 0.0F, before = changed(0, walk.path_loss[0]);
  int border = 0;
  for (int s = 0; s < plan.samples; s += kCoarse) {
    const auto c = static_cast<std::size_t>(s / kCoarse);
    // Behind a mirror the sound has the way to it.
    if (is_straight && static_cast<float>(s + kCoarse) >= mirror) {
      is_straight = false;
      held = opened(c, walk.path_loss[static_cast<std::size_t>(s)]) + before;
    }
    for (; border < walk.border_count; ++border) {
      Border& next = walk.borders[static_cast<std::size_t>(border)];
      if (!(next.walk < static_cast<float>(s + kCoarse))) break;
      next.log_gain += is_straight ? opened(c, next.log_gain) + changed(c, next.log_gain) : held;
    }
    using Part = Eigen::Array<float, kCoarse, 1>;  // the last one may end behind the samples
    Eigen::Map<Part> way(walk.path_loss.data() + s), gain(walk.log_gain.data() + s);
    Part added = Part::Constant(held);
    if (is_straight) {
      const float after =
          changed(c + 1, walk.path_loss[static_cast<std::size_t>(std::min(s + kCoarse, plan.samples - 1))]);
      added = Ends{open[c] - own[c], open[c + 1] - own[c + 1]}.between().min(
                  (Ends{open[c], open[c + 1]}.between() - way).max(0.0F)) +
              Ends{before, after}.between();
      before = after;
    }
    way += added;
    gain += added;
  }
}

}  // namespace trocar::ultrasound::detail
#endif
