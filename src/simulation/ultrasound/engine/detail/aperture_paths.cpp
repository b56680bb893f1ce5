#include "ultrasound/engine/detail/aperture_paths.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar::ultrasound::detail {
namespace {

/// Rays of a depth, on either side of the scanline's own.
constexpr int kSideRays = 4;
constexpr int kRays = 2 * kSideRays + 1;
/// Share of the receive aperture whose sound is coherent behind an obstacle (assumed, range 0.3..1).
constexpr double kCoherentShare = 0.5;
/// Width of a Gaussian that replaces a uniform aperture (docs/physics.md U3).
constexpr double kGaussianAperture = 0.2991;
constexpr float kOpaque = 60.0F;  // neper

using Row = Eigen::Map<Eigen::ArrayXf>;

/// Slope of the outermost ray: sideways over depth.
double steepest(const ScanPlan& plan) noexcept {
  return 0.5 * kCoherentShare / plan.beam.f_number;
}

/// Weights of the rays at a depth; the sum is 1. Beyond aperture * f-number the aperture no longer grows.
std::array<float, kRays> weights_at(const ScanPlan& plan, double depth_mm) noexcept {
  const double f_number = std::max(plan.beam.f_number, depth_mm / plan.beam.aperture_mm);
  const double sigma = kGaussianAperture * kCoherentShare / f_number;
  std::array<float, kRays> weights{};
  float sum = 0.0F;
  for (int ray = 0; ray < kRays; ++ray) {
    const double u = steepest(plan) * (ray - kSideRays) / kSideRays / sigma;
    sum += weights[static_cast<std::size_t>(ray)] = static_cast<float>(std::exp(-0.5 * u * u));
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

/// The losses of a ray one step before, `lines` scanlines aside: linear between them, the outermost beyond them.
void step_aside(Row from, float lines, Row to) noexcept {
  const auto n = from.size();
  const float whole = std::floor(lines);
  const float part = lines - whole;
  const auto shift = static_cast<Eigen::Index>(whole);
  const auto at = [&](Eigen::Index l) { return std::clamp<Eigen::Index>(l, 0, n - 1); };
  // The part of `to` whose two neighbours exist.
  const Eigen::Index low = std::clamp<Eigen::Index>(-shift, 0, n),
                     high = std::clamp<Eigen::Index>(n - 1 - shift, low, n);
  for (Eigen::Index l = 0; l < low; ++l) to[l] = from[at(l + shift)];
  to.segment(low, high - low) =
      (1.0F - part) * from.segment(low + shift, high - low) + part * from.segment(low + shift + 1, high - low);
  for (Eigen::Index l = high; l < n; ++l) to[l] = from[at(l + shift)];
}

}  // namespace

std::size_t aperture_floats(const ScanPlan& plan) noexcept {
  return static_cast<std::size_t>(kRays + 4) * static_cast<std::size_t>(plan.lines);
}

void open_aperture(const ScanPlan& plan, FrameState& frame, int first, int last, std::vector<float>& rows) noexcept {
  const auto coarse = plan.coarse_samples();
  const auto lines = static_cast<Eigen::Index>(plan.lines);
  const auto row = [&](int n) { return Row(rows.data() + n * lines, lines); };
  Row loss = row(kRays), last_way = row(kRays + 1), aside = row(kRays + 2), sum = row(kRays + 3);
  for (int ray = 0; ray < kRays; ++ray) row(ray).setZero();
  last_way.setZero();
  const float step_mm = kCoarse * plan.sample_mm;
  using Strided = Eigen::Map<Eigen::ArrayXf, 0, Eigen::InnerStride<>>;
  const auto column = [&](std::vector<float>& values, std::size_t c) {
    return Strided(values.data() + c, lines, Eigen::InnerStride<>(static_cast<Eigen::Index>(coarse)));
  };
  for (std::size_t c = 0; c < coarse; ++c) {
    const Strided way = column(frame.probed_way, c);
    loss = (last_way - way).max(0.0F);
    last_way = way;
    const auto weights = weights_at(plan, static_cast<double>(c) * static_cast<double>(step_mm));
    sum.setZero();
    for (int ray = 0; ray < kRays; ++ray) {
      const double slope = steepest(plan) * (ray - kSideRays) / kSideRays;
      const auto sideways = static_cast<float>(slope) * step_mm / plan.coarse_spacing_mm[c];
      Row ray_loss = row(ray);
      if (ray != kSideRays) {
        step_aside(ray_loss, sideways, aside);
        ray_loss = (aside + loss).min(kOpaque);
      } else {
        ray_loss = (ray_loss + loss).min(kOpaque);
      }
      // One way; the echo returns through the same aperture.
      sum += weights[static_cast<std::size_t>(ray)] * (-0.5F * ray_loss).exp();
    }
    sum = 2.0F * sum.max(1e-13F).log();
    column(frame.open_way, c).segment(first, last - first) = sum.segment(first, last - first);
  }
  for (int l = first; l < last; ++l) {
    const float* const open = frame.open_way.data() + static_cast<std::size_t>(l) * coarse;
    auto heard = static_cast<int>(coarse);
    while (heard > 0 && open[heard - 1] < kInaudible) --heard;
    const LineWalk& walk = frame.walks[static_cast<std::size_t>(l)];
    const bool is_mirrored = walk.mirror_depth_mm < static_cast<float>(heard + 1) * step_mm;
    frame.reach[static_cast<std::size_t>(l)] = is_mirrored ? plan.samples : std::min(heard * kCoarse, plan.samples);
  }
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
  float held = 0.0F, before = changed(0, walk.log_way[0]);
  int border = 0;
  for (int s = 0; s < plan.samples; s += kCoarse) {
    const auto c = static_cast<std::size_t>(s / kCoarse);
    // Behind a mirror the sound has the way to it.
    if (is_straight && static_cast<float>(s + kCoarse) >= mirror) {
      is_straight = false;
      held = opened(c, walk.log_way[static_cast<std::size_t>(s)]) + before;
    }
    for (; border < walk.border_count; ++border) {
      Border& next = walk.borders[static_cast<std::size_t>(border)];
      if (!(next.walk < static_cast<float>(s + kCoarse))) break;
      next.log_gain += is_straight ? opened(c, next.log_gain) + before : held;
    }
    const auto n = std::min(kCoarse, plan.samples - s);
    using Part = Eigen::Array<float, Eigen::Dynamic, 1, 0, kCoarse, 1>;
    Eigen::Map<Part> way(walk.log_way.data() + s, n), gain(walk.log_gain.data() + s, n);
    Part added = Part::Constant(n, held);
    if (is_straight) {
      const float after =
          changed(c + 1, walk.log_way[static_cast<std::size_t>(std::min(s + kCoarse, plan.samples - 1))]);
      added = Ends{open[c] - own[c], open[c + 1] - own[c + 1]}.between().head(n).min(
                  (Ends{open[c], open[c + 1]}.between().head(n) - way).max(0.0F)) +
              Ends{before, after}.between().head(n);
      before = after;
    }
    way += added;
    gain += added;
  }
}

}  // namespace trocar::ultrasound::detail
