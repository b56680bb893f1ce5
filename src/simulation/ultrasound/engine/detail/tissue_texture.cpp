#include "ultrasound/engine/detail/tissue_texture.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

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

namespace {

constexpr float kLeastFacing = 0.05F;

/// Share of a tissue in the eight voxels around a fractional index, 0..1.
float tissue_share_at(const FrameState& frame, std::uint8_t tissue, const Vec3& index) noexcept {
  std::array<float, 3> at{};
  for (std::size_t a = 0; a < 3; ++a)
    at[a] = std::clamp(static_cast<float>(index[static_cast<Eigen::Index>(a)]), 0.0F,
                       static_cast<float>(frame.scene->geometry.size[a] - 1) - 1e-3F);
  const CellCorners corners = corners_at(frame.tiles, at[0], at[1], at[2]);
  float share = 0.0F;
  for (std::size_t n = 0; n < 8; ++n)
    if ((frame.tiles.tissue(corners.offset[n]) & ~kMixedCell) == tissue) share += corners.weight[n];
  return share;
}

/// Cosine between the scanline and the normal of the surface of `inside`, at least kLeastFacing.
float facing(const FrameState& frame, const LineWalk& line, std::uint8_t inside, const Border& border) noexcept {
  constexpr double kReach = 0.87;  // voxels along each axis, 1.5 from the border
  const Vec3 corners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const Vec3 spacing_mm = frame.scene->geometry.spacing_mm;
  const Vec3 along = Vec3(line.along[0], line.along[1], line.along[2]).cwiseProduct(spacing_mm);
  Vec3 slope = Vec3::Zero();
  for (const Vec3& corner : corners)
    slope += static_cast<double>(tissue_share_at(
                 frame, inside, Vec3(border.index[0], border.index[1], border.index[2]) + kReach * corner)) *
             corner;
  slope = slope.cwiseQuotient(spacing_mm);
  const double size = slope.norm();
  if (!(size > 1e-6)) return 1.0F;
  return static_cast<float>(std::max(static_cast<double>(kLeastFacing), std::abs(slope.dot(along)) / size));
}

/// Logarithm of the wall's amplitude at a distance from the border, in thicknesses: even, with a soft edge.
float log_profile(float share) noexcept {
  constexpr float kEven = 0.7F;
  const float t = (share - kEven) / (1.0F - kEven);
  return t <= 0.0F ? 0.0F : -8.0F * t * t;
}

}  // namespace

void add_walls(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, WalkResult& walk,
               const Texture& texture) noexcept {
  for (int b = 0; b < walk.border_count; ++b) {
    const Border& border = walk.borders[static_cast<std::size_t>(b)];
    const std::uint8_t number =
        plan.wall_at[static_cast<std::size_t>(border.before & 127U) * kTissues + (border.behind & 127U)];
    if (number == 0) continue;
    const WallRow& wall = plan.walls[number - 1U];
    constexpr float kMostOblique = 0.35F;  // a wall is at most that much longer along the scanline
    const float cosine = facing(frame, line, wall.is_behind ? border.before : border.behind, border);
    const float samples = wall.thickness_mm / (std::max(cosine, kMostOblique) * plan.sample_mm);
    const float log_wall = border.log_gain + wall.log_b + std::log(cosine);
    const float begin = wall.is_behind ? border.walk : border.walk - samples;
    const int first = std::max(0, static_cast<int>(std::ceil(begin)));
    const int last = std::min(plan.samples - 1, static_cast<int>(std::floor(begin + samples)));
    for (int n = first; n <= last; ++n) {
      const auto s = static_cast<std::size_t>(n);
      const float log_gain = log_wall + log_profile(std::abs(static_cast<float>(n) - border.walk) / samples);
      if (log_gain <= walk.log_gain[s] + texture.added[s]) continue;
      walk.log_gain[s] = log_gain - texture.added[s];
      walk.share[s] = 0;  // fully developed
    }
  }
}

namespace {

float value_at(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
  auto h = static_cast<std::uint32_t>(x) * 0x9e3779b1U ^ static_cast<std::uint32_t>(y) * 0x85ebca77U ^
           static_cast<std::uint32_t>(z) * 0xc2b2ae3dU;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 12)) * 0x297a2d39U;
  return static_cast<float>((h ^ (h >> 15)) & 0xffffU) / 32767.5F - 1.0F;
}

float ease(float t) noexcept {
  return t * t * (3.0F - 2.0F * t);
}

}  // namespace

float smooth_noise(float x, float y, float z) noexcept {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const auto i = static_cast<std::int32_t>(fx), j = static_cast<std::int32_t>(fy), k = static_cast<std::int32_t>(fz);
  const float u = ease(x - fx), v = ease(y - fy), w = ease(z - fz);
  const auto row = [&](std::int32_t b, std::int32_t c) {
    return std::lerp(value_at(i, b, c), value_at(i + 1, b, c), u);
  };
  return std::lerp(std::lerp(row(j, k), row(j + 1, k), v), std::lerp(row(j, k + 1), row(j + 1, k + 1), v), w);
}

}  // namespace trocar::ultrasound::detail
