#include "ultrasound/engine/detail/tissue_texture.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ultrasound/engine/detail/smooth_noise.h"
#include "volume/sampling.h"

namespace trocar::ultrasound::detail {
namespace {

/// Distance of the layers of muscle and septa of fat, which are parallel to the skin (assumed, range 1..4 mm).
constexpr float kLayer_mm = 2.2F;
/// Length scale of their waviness.
constexpr float kWave_mm = 9.0F;

Layering layering_at(float below_skin_mm, const Vec3& p_mm) noexcept {
  const auto x = static_cast<float>(p_mm.x()), y = static_cast<float>(p_mm.y()), z = static_cast<float>(p_mm.z());
  const float wave = smooth_noise(x / kWave_mm, y / kWave_mm, z / kWave_mm);
  return {below_skin_mm / kLayer_mm + 0.9F * wave, 0.6F + 0.4F * smooth_noise(x / 5.0F + 31.0F, y / 5.0F, z / 5.0F)};
}

/// Profile of the layers along their phase: -0.5 between them, up to 1 on a bright sheet; the sheets are irregular.
class LayerProfile {
 public:
  LayerProfile() {
    for (std::size_t n = 0; n < steps; ++n) {
      const float part = smooth_noise(static_cast<float>(n) / stepsAUnit, 7.3F, 0.0F);
      values_[n] = std::exp(-part * part / 0.03F);
    }
  }
  float at(float phase, float strength) const noexcept {
    constexpr float kTurns = 64.0F;  // depths below the skin stay below that many periods of the profile: no floor
    const auto n = static_cast<std::size_t>(static_cast<std::int32_t>(phase * stepsAUnit + kTurns * steps)) % steps;
    return 1.5F * values_[n] * strength - 0.5F;
  }

 private:
  static constexpr std::size_t steps = 4096;
  static constexpr float stepsAUnit = 32.0F;
  std::array<float, steps> values_;
};

Layering layers_at(const FrameState& frame, const WalkResult& walk, std::size_t sample) noexcept {
  const AcousticScene& scene = *frame.scene;
  const Vec3 p_mm =
      Vec3(walk.index[0][sample], walk.index[1][sample], walk.index[2][sample]).cwiseProduct(scene.geometry.spacing_mm);
  const Vec3 p_P = scene.geometry.origin_P + scene.geometry.R_PV * p_mm;
  const double skin_mm =
      scene.skin_distance_mm.empty() ? -p_mm.y() : volume::sample_linear(scene.skin_distance_mm, p_P);
  return layering_at(static_cast<float>(-skin_mm), p_mm);
}

/// Samples from the face to the n-th value of FrameState::layers.
std::size_t layer_sample(const ScanPlan& plan, std::size_t n) noexcept {
  return std::min((n + 1) * kLayering, static_cast<std::size_t>(plan.samples - 1));
}

bool is_layered(const ScanPlan& plan, const WalkResult& walk, std::size_t sample) noexcept {
  return plan.fibre_gain[walk.tissue[sample]] > 0.0F && walk.cell[sample] >= 0;
}

/// Layers along the central plane: phase in coarse steps, sheets sample by sample.
void make_fibres(const ScanPlan& plan, const FrameState& frame, const WalkResult& walk, int line,
                 Texture& texture) noexcept {
  static const LayerProfile profile;
  const Layering* const noted = frame.layers.data() + static_cast<std::size_t>(line) * plan.layer_steps();
  const float mirror = frame.walks[static_cast<std::size_t>(line)].mirror_depth_mm / plan.sample_mm;
  Layering last;
  bool was_in = false;
  for (std::size_t step = 0; step < plan.layer_steps(); ++step) {
    const std::size_t at = layer_sample(plan, step), begin = step * kLayering;
    const bool is_in = is_layered(plan, walk, at);
    Layering next;
    if (is_in) {
      const bool is_noted = noted[step].strength >= 0.0F && static_cast<float>(at) < mirror;
      next = is_noted ? noted[step] : layers_at(frame, walk, at);
    }
    if (is_in && !was_in) last = next;
    if (!is_in && was_in) next = last;
    float* const fibres = texture.fibres.data() + begin;
    if (is_in || was_in) {
      const float phase_step = (next.phase - last.phase) / kLayering;
      const float strength_step = (next.strength - last.strength) / kLayering;
      for (int n = 0; n < kLayering; ++n) {
        const float gain = plan.fibre_gain[walk.tissue[begin + static_cast<std::size_t>(n)]];
        const auto part = static_cast<float>(n);
        fibres[n] = gain * profile.at(last.phase + part * phase_step, last.strength + part * strength_step);
      }
    } else {
      std::fill_n(fibres, kLayering, 0.0F);
    }
    last = next;
    was_in = is_in;
  }
}

}  // namespace

void note_layers(const ScanPlan& plan, FrameState& frame, const WalkResult& walk, int line) noexcept {
  Layering* const noted = frame.layers.data() + static_cast<std::size_t>(line) * plan.layer_steps();
  for (std::size_t step = 0; step < plan.layer_steps(); ++step) {
    const std::size_t at = layer_sample(plan, step);
    const bool is_heard = walk.path_loss[at] > kInaudible;
    noted[step] = is_heard && is_layered(plan, walk, at) ? layers_at(frame, walk, at) : Layering{};
  }
}

void fill_layers_between(const ScanPlan& plan, FrameState& frame, int line, int before, int after) noexcept {
  const std::size_t steps = plan.layer_steps();
  const auto row = [&](int of) { return frame.layers.data() + static_cast<std::size_t>(of) * steps; };
  Layering* const noted = row(line);
  const Layering *const left = row(before), *const right = row(after);
  for (std::size_t step = 0; step < steps; ++step) {
    const bool has_both = left[step].strength >= 0.0F && right[step].strength >= 0.0F;
    noted[step] = has_both ? Layering{0.5F * (left[step].phase + right[step].phase),
                                      0.5F * (left[step].strength + right[step].strength)}
                           : Layering{};
  }
}

void make_texture(const ScanPlan& plan, const FrameState& frame, const WalkResult& walk, int line, bool is_central,
                  Texture& texture) noexcept {
  if (is_central) make_fibres(plan, frame, walk, line, texture);
  // The CT's texture is smoothed over more than a millimetre.
  constexpr float kTextureStep_mm = 1.5F;
  const int step = plan.sample_mm * kCoarse < kTextureStep_mm ? kCoarse : kCoarse / 2;
  const auto value_at = [&](int s) {
    const auto at = static_cast<std::size_t>(std::min(s, plan.samples - 1));
    const std::uint8_t tissue = walk.tissue[at];
    if (walk.cell[at] < 0 || plan.has_texture[tissue] == 0 || !frame.tiles.has_texture()) return 0.0F;
    return plan.texture_gain[tissue][static_cast<std::size_t>(frame.tiles.texture(walk.cell[at]) + 128)];
  };
  float last = value_at(0);
  for (int begin = 0; begin < plan.samples; begin += step) {
    const float next = value_at(begin + step), slope = (next - last) / static_cast<float>(step);
    static_assert(kCoarse % 8 == 0);
    for (int s = begin; s < begin + step; s += 4) {
      const float here = last + slope * static_cast<float>(s - begin);
      Eigen::Map<Eigen::Array4f>(texture.added.data() + s) =
          here + slope * Eigen::Array4f(0.0F, 1.0F, 2.0F, 3.0F) +
          Eigen::Map<const Eigen::Array4f>(texture.fibres.data() + s);
    }
    last = next;
  }
}

}  // namespace trocar::ultrasound::detail
