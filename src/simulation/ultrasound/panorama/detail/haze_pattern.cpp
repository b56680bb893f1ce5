#include "ultrasound/panorama/detail/haze_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr std::uint64_t kHazePatternSeed = 0x68617a65;

}  // namespace

HazePattern make_haze_pattern(const ScanPlan& plan, FrameState& frame, SteeringRows& rows, BasebandFrame& out) {
  HazePattern haze;
  const auto lines = static_cast<std::size_t>(plan.lines), samples = static_cast<std::size_t>(plan.samples);
  Random random(kHazePatternSeed);
  for (int l = 0; l < plan.lines; ++l) {
    for (std::size_t s = 0; s < samples; ++s) {
      frame.re[plan.echo_row(l) + s] = static_cast<float>(random.normal());
      frame.im[plan.echo_row(l) + s] = static_cast<float>(random.normal());
    }
    find_loudest(plan, frame, l);
  }
  for (int l = 0; l < plan.lines; ++l) spread_echoes(plan, frame, l, rows, out);
  haze.re.assign(out.re.begin(), out.re.begin() + static_cast<std::ptrdiff_t>(lines * samples));
  haze.im.assign(out.im.begin(), out.im.begin() + static_cast<std::ptrdiff_t>(lines * samples));
  haze.phase_re.assign(lines * samples, 0.0F);
  haze.phase_im = haze.phase_re;
  for (std::size_t s = 0; s < samples; ++s) {
    float sum = 0.0F;
    for (std::size_t l = 0; l < lines; ++l) {
      const float re = haze.re[l * samples + s], im = haze.im[l * samples + s];
      sum += re * re + im * im;
    }
    const float scale = std::sqrt(static_cast<float>(lines) / std::max(sum, 1e-12F));
    for (std::size_t l = 0; l < lines; ++l) {
      float &re = haze.re[l * samples + s], &im = haze.im[l * samples + s];
      const float modulus = std::max(std::hypot(re, im), 1e-12F);
      // Another phase than that of the clutter, with the same correlation.
      haze.phase_re[l * samples + s] = im / modulus;
      haze.phase_im[l * samples + s] = re / modulus;
      re *= scale;
      im *= scale;
    }
  }
  fit_frame(frame, plan);  // without the noise
  std::fill(out.re.begin(), out.re.end(), 0.0F);
  std::fill(out.im.begin(), out.im.end(), 0.0F);
  return haze;
}

}  // namespace trocar::ultrasound::detail
