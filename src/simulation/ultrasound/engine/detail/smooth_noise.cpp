#include "ultrasound/engine/detail/smooth_noise.h"

#include <cmath>
#include <cstdint>

namespace trocar::ultrasound::detail {
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
