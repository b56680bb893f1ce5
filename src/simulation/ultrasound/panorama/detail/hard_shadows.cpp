#include "ultrasound/panorama/detail/hard_shadows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "ultrasound/engine/detail/aperture_paths.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/point_spread.h"
#include "ultrasound/engine/detail/sound_paths.h"
#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr double kSoftImpedance_mrayl = 1.63;

bool is_hard(const AcousticTissue& tissue) {
  return std::abs(reflection(kSoftImpedance_mrayl, tissue.impedance_mrayl())) > kHardReflection ||
         tissue.attenuation_db_per_cm_mhz > kHardLoss_db_per_cm_mhz;
}

}  // namespace

ScanPlan make_shadow_plan(const AcousticScene& scene, const Transducer& transducer, const Acquisition& acquisition) {
  ScanPlan plan = make_scan_plan(scene, transducer, acquisition);
  const auto soft_log_z = static_cast<float>(std::log(kSoftImpedance_mrayl));
  for (std::size_t t = 0; t < scene.table.tissues.size(); ++t) {
    plan.rows[t].delay = 0.0F;
    if (is_hard(scene.table.tissues[t])) continue;
    plan.rows[t].log_z = soft_log_z;
    plan.rows[t].loss = 0.0F;
  }
  plan.slowness.fill(0.0F);
  plan.entry_rows = plan.rows;
  plan.entry_rows[0].log_z = soft_log_z;
  plan.entry_rows[0].loss = 0.0F;
  std::fill(plan.wall_at.begin(), plan.wall_at.end(), std::uint8_t{0});
  return plan;
}

void find_hard_shadows(const AcousticScene& scene, const ScanPlan& plan, FrameState& frame, const LineRange& probed,
                       const LineRange& lines, std::vector<WalkResult>& scratch,
                       std::vector<float>& aperture_rows) noexcept {
  const auto first = static_cast<std::size_t>(probed.first), count = static_cast<std::size_t>(probed.count());
  find_contact(scene.skin_distance_mm, plan.geometry, frame.X_PT, std::span(frame.contact).subspan(first, count),
               probed.first, frame.motion);
  fit_dent(scene, plan, frame);
  aim_lines(plan, frame, probed.first, probed.last);
  for_groups(probed, [&](int group, int begin, int end) {
    probe_lines(plan, frame, scratch[static_cast<std::size_t>(group)], begin, end);
  });
  open_aperture(plan, frame, lines.first, lines.last, aperture_rows);
}

void fill_way_gain(const ScanPlan& plan, FrameState& frame, int line, const std::vector<float>& gain,
                   std::vector<float>& logs) noexcept {
  const auto at = static_cast<std::size_t>(line), samples = static_cast<std::size_t>(plan.samples);
  const float* const open = frame.open_way.data() + at * plan.coarse_samples();
  const auto shift = static_cast<float>(kSurfaceEcho_mm) / plan.sample_mm;
  const GasBorder& gas = frame.gas[at];
  const float gas_at = gas.is_there ? gas.border.walk : static_cast<float>(plan.samples);
  const auto most_gas = static_cast<float>(-kGasShadow_db * std::numbers::ln10 / 20.0);
  const auto last = static_cast<int>(plan.coarse_samples()) - 1;
  const auto at_coarse = [&](int c) {
    const float place = std::clamp(static_cast<float>(c) - shift / kCoarse, 0.0F, static_cast<float>(last) - 1e-3F);
    const auto below = static_cast<std::size_t>(place);
    return std::lerp(open[below], open[below + 1], place - static_cast<float>(below));
  };
  float from = at_coarse(0);
  for (int s = 0, c = 0; s < plan.samples; s += kCoarse, ++c) {
    const float to = at_coarse(c + 1), step = (to - from) / kCoarse;
    for (int k = 0; k < kCoarse; ++k) logs[static_cast<std::size_t>(s + k)] = from + static_cast<float>(k) * step;
    from = to;
  }
  for (auto s = static_cast<std::size_t>(std::max(gas_at, 0.0F)); s < samples; ++s)
    logs[s] = std::max(logs[s], most_gas);
  to_gain(logs.data(), gain.data(), plan.samples, frame.way_gain.data() + at * samples);
}

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
