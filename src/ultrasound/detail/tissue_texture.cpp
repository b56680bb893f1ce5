#include "ultrasound/detail/tissue_texture.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "volume/sampling.h"

namespace trocar::detail {
namespace {

/// Layers of muscle and septa of fat lie along the skin, about so far apart (assumed, range 1..4 mm), waving over …
constexpr float kLayer_mm = 2.2F;
/// … this distance.
constexpr float kWave_mm = 9.0F;

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

/// Smooth noise, -1..1, a lattice unit wide.
float noise(float x, float y, float z) noexcept {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const auto i = static_cast<std::int32_t>(fx), j = static_cast<std::int32_t>(fy), k = static_cast<std::int32_t>(fz);
  const float u = ease(x - fx), v = ease(y - fy), w = ease(z - fz);
  const auto row = [&](std::int32_t b, std::int32_t c) {
    return std::lerp(value_at(i, b, c), value_at(i + 1, b, c), u);
  };
  return std::lerp(std::lerp(row(j, k), row(j + 1, k), v), std::lerp(row(j, k + 1), row(j + 1, k + 1), v), w);
}

/// -0.5 between layers, to 1 on a layer's bright sheet; sheets come and go.
float layers(float below_skin_mm, const Vec3& p_mm) noexcept {
  const auto x = static_cast<float>(p_mm.x()), y = static_cast<float>(p_mm.y()), z = static_cast<float>(p_mm.z());
  const float wave = noise(x / kWave_mm, y / kWave_mm, z / kWave_mm);
  const float phase = below_skin_mm / kLayer_mm + 0.9F * wave;
  const float part = noise(phase, 7.3F, 0.4F * wave);
  const float sheet = std::exp(-part * part / 0.03F);
  const float strength = 0.6F + 0.4F * noise(x / 5.0F + 31.0F, y / 5.0F, z / 5.0F);
  return 1.5F * sheet * strength - 0.5F;
}

float texture_at(const AcousticScene& scene, std::int32_t cell) noexcept {
  return static_cast<float>(scene.texture[static_cast<std::size_t>(cell)]);
}

/// Texture between the voxels of a cell.
float texture_between(const AcousticScene& scene, const WalkResult& walk, std::size_t s) noexcept {
  const auto& size = scene.geometry.size;
  const std::int32_t cell = walk.cell[s];
  const float x = walk.index[0][s], y = walk.index[1][s], z = walk.index[2][s];
  const float u = x - std::floor(x), v = y - std::floor(y), w = z - std::floor(z);
  const auto j = static_cast<std::int32_t>(size[0]), k = static_cast<std::int32_t>(size[0] * size[1]);
  const auto row = [&](std::int32_t at) { return std::lerp(texture_at(scene, at), texture_at(scene, at + 1), u); };
  return std::lerp(std::lerp(row(cell), row(cell + j), v), std::lerp(row(cell + k), row(cell + k + j), v), w);
}

}  // namespace

void make_texture(const ScanPlan& plan, const FrameState& frame, const WalkResult& walk, int line, bool is_central,
                  Texture& texture) noexcept {
  const AcousticScene& scene = *frame.scene;
  const auto coarse = static_cast<int>(plan.coarse_samples());
  const float* focus = frame.focus_log.data() + static_cast<std::size_t>(line) * plan.coarse_samples();
  const Vec3 spacing = scene.geometry.spacing_mm;
  float last = 0.0F;
  for (int c = 0; c < coarse; ++c) {
    const auto s = static_cast<std::size_t>(std::min(c * kCoarse, plan.samples - 1));
    const std::uint8_t tissue = walk.tissue[s];
    float value = focus[c];
    if (walk.cell[s] >= 0) {
      if (is_central) {
        float& fibre = texture.fibres[static_cast<std::size_t>(c)];
        fibre = 0.0F;
        if (plan.fibre_gain[tissue] > 0.0F) {
          const Vec3 p_mm = Vec3(walk.index[0][s], walk.index[1][s], walk.index[2][s]).cwiseProduct(spacing);
          const Vec3 p_P = scene.geometry.origin_P + scene.geometry.R_PV * p_mm;
          const double skin_mm =
              scene.skin_distance_mm.empty() ? -p_mm.y() : sample_linear(scene.skin_distance_mm, p_P);
          fibre = layers(static_cast<float>(-skin_mm), p_mm);
        }
      }
      value += plan.fibre_gain[tissue] * texture.fibres[static_cast<std::size_t>(c)];
      if (!scene.texture.empty()) {
        const float step = std::clamp(texture_between(scene, walk, s), -128.0F, 126.9F) + 128.0F;
        const auto low = static_cast<std::size_t>(step);
        const auto& gain = plan.texture_gain[tissue];
        value += std::lerp(gain[low], gain[low + 1], step - static_cast<float>(low));
      }
    }
    if (c > 0)
      for (int n = 0; n < kCoarse; ++n)
        texture.added[static_cast<std::size_t>((c - 1) * kCoarse + n)] =
            last + (value - last) * static_cast<float>(n) / static_cast<float>(kCoarse);
    last = value;
  }
}

}  // namespace trocar::detail
