#include "anatomy/phantom/torso.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace trocar::phantom {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kLatticeMm = 4.0F;
constexpr float kMargin = 8.0F;  ///< The lattice reaches beyond the box, so that nothing is extrapolated.
constexpr float kWarpMm = 4.5F;
constexpr float kWarpSizeMm = 75.0F;

float rad(float degrees) {
  return degrees * kPi / 180.0F;
}

/// Radius of a superellipse |x/a|^n + |y/b|^n = 1 at the angle phi.
float superellipse(float phi, float a, float b, float exponent) {
  const float u = std::abs(std::sin(phi)) / a;
  const float v = std::abs(std::cos(phi)) / b;
  return std::pow(std::pow(u, exponent) + std::pow(v, exponent), -1.0F / exponent);
}

/// One contour of a slice as a polygon, with the factor that turns the distance in the slice into that in space.
struct SliceContour {
  static constexpr std::size_t kPoints = 200;
  std::array<float, kPoints> x, y, slope_factor;

  template <class Radius>
  SliceContour(const Radius& radius, float z) {
    for (std::size_t n = 0; n < kPoints; ++n) {
      const float phi = 2.0F * kPi * static_cast<float>(n) / static_cast<float>(kPoints) - kPi;
      const float r = radius(phi, z);
      const float slope = 0.5F * (radius(phi, z + 1.0F) - radius(phi, z - 1.0F));
      x[n] = r * std::sin(phi);
      y[n] = r * std::cos(phi);
      slope_factor[n] = 1.0F / std::sqrt(1.0F + slope * slope);
    }
  }

  /// Distance in space from a point of the slice; the sign is the caller's.
  float distance(float px, float py) const {
    std::size_t best = 0;
    float best_square = 1e12F;
    for (std::size_t n = 0; n < kPoints; ++n) {
      const float square = (x[n] - px) * (x[n] - px) + (y[n] - py) * (y[n] - py);
      if (square < best_square) {
        best_square = square;
        best = n;
      }
    }
    const std::size_t before = (best + kPoints - 1) % kPoints;
    const std::size_t after = (best + 1) % kPoints;
    return std::min(to_edge(before, best, px, py), to_edge(best, after, px, py)) * slope_factor[best];
  }

 private:
  float to_edge(std::size_t a, std::size_t b, float px, float py) const {
    const float dx = x[b] - x[a];
    const float dy = y[b] - y[a];
    const float t = clamp01(((px - x[a]) * dx + (py - y[a]) * dy) / (dx * dx + dy * dy));
    return std::hypot(px - x[a] - t * dx, py - y[a] - t * dy);
  }
};

}  // namespace

TorsoContours::TorsoContours(std::uint64_t seed) {
  Random random(seed ^ 0x7072736fU);
  const auto vary = [&](double centre, double spread) {
    return static_cast<float>(random.uniform(centre - spread, centre + spread));
  };
  half_width_ = vary(161.0, 5.0);
  half_depth_ = vary(119.0, 4.0);
  fatness_ = vary(1.0, 0.2);
  dome_mm_ = vary(0.0, 4.0);
  for (std::size_t n = 0; n < 3; ++n) {
    wave_mm_[n] = vary(1.5, 1.0) / static_cast<float>(n + 1);
    wave_phase_[n] = vary(0.0, 3.14);
  }
}

float TorsoContours::skin_radius(float phi, float z) const {
  const float side = std::abs(phi);
  const float waist = 6.0F * bump(z, -45.0F, 50.0F) + 3.0F * smooth_step(60.0F, 125.0F, z);
  const float a = half_width_ - waist;
  const float belly = half_depth_ - 5.0F * smooth_step(20.0F, 120.0F, z) + 2.0F * bump(z, -60.0F, 60.0F);
  const float back = 108.0F;
  const float anterior = superellipse(phi, a, belly, 2.25F);
  const float posterior = superellipse(phi, a, back, 2.6F);
  float r = side > 0.5F * kPi ? anterior : posterior;
  const float x = r * std::sin(side);
  // The furrow over the spine between the erector muscles, and shallow furrows beside the rectus.
  r -= (7.5F - 2.0F * smooth_step(20.0F, 110.0F, z)) * (side < 0.5F * kPi ? bump(x, 0.0F, 17.0F) : 0.0F);
  r += 3.0F * bump(side, rad(28.0F), rad(14.0F));
  if (side > 0.5F * kPi) r -= 2.0F * bump(x, 0.0F, 8.0F);
  // The umbilicus.
  if (side > 0.5F * kPi) r -= 9.0F * bump(std::hypot(x, z - kUmbilicusZ), 0.0F, 9.0F);
  for (std::size_t n = 0; n < 3; ++n)
    r += wave_mm_[n] * std::sin(static_cast<float>(n + 2) * phi + wave_phase_[n] + 0.012F * z);
  return r;
}

float TorsoContours::fat_mm(float phi, float z) const {
  const float side = std::abs(phi);
  const float chest = smooth_step(-10.0F, 70.0F, z);
  const float flank = 9.0F * bump(side, rad(80.0F), rad(38.0F)) * mix(1.0F, 0.62F, chest);
  const float love_handle = 10.0F * bump(side, rad(48.0F), rad(20.0F)) * (1.0F - smooth_step(-90.0F, -10.0F, z));
  const float belly = mix(9.0F, 4.0F, chest) * bump(side, rad(158.0F), rad(32.0F));
  const float navel = -6.0F * bump(std::hypot((kPi - side) * 110.0F, z - kUmbilicusZ), 0.0F, 9.0F);
  return fatness_ * (8.5F + flank + love_handle + belly) + navel;
}

float TorsoContours::muscle_mm(float phi, float z) const {
  const float side = std::abs(phi);
  const float chest = smooth_step(-10.0F, 60.0F, z);
  const float back = mix(29.0F, 26.0F, chest) * bump(side, 0.0F, rad(34.0F));
  const float lateral = mix(7.0F, 8.0F, chest) * bump(side, rad(95.0F), rad(35.0F));
  const float median = -4.0F * bump(side, kPi, rad(4.0F));
  return 12.0F + back + lateral + median;
}

float TorsoContours::wall_radius(float phi, float z) const {
  return skin_radius(phi, z) - fat_mm(phi, z);
}

float TorsoContours::cavity_radius(float phi, float z) const {
  return wall_radius(phi, z) - muscle_mm(phi, z);
}

float TorsoContours::diaphragm_height(float x, float y, float cavity) const {
  const float side = std::atan2(std::abs(x), y);
  // Where the diaphragm leaves the wall: low behind (the costophrenic recess), high in front.
  const float rim =
      16.0F + 20.0F * smooth_step(rad(20.0F), rad(95.0F), side) + 38.0F * smooth_step(rad(85.0F), rad(160.0F), side);
  const float right = 16.0F * bump(x, -72.0F, 58.0F) * bump(y, -5.0F, 75.0F);
  const float left = 7.0F * bump(x, 70.0F, 52.0F) * bump(y, 0.0F, 75.0F);
  const float dome = 72.0F + dome_mm_ + right + left;
  const float inward = std::max(-cavity, 0.0F);
  return mix(rim, dome, 1.0F - std::exp(-inward / 24.0F));
}

Vec3f TorsoContours::on_cavity(float phi, float z, float outward_mm) const {
  const float r = cavity_radius(phi, z) + outward_mm;
  return {r * std::sin(phi), r * std::cos(phi), z};
}

Torso::Torso(std::uint64_t seed) : contours_(seed) {
  const auto nodes = [](float half) {
    return static_cast<std::int64_t>(std::ceil(2.0F * (half + kMargin) / kLatticeMm)) + 1;
  };
  size_ = {nodes(kHalfWidth), nodes(kHalfDepth), nodes(kHalfHeight)};
  nodes_.resize(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
  const ValueNoise warp(seed ^ 0x77617270U);
  parallel_for(static_cast<std::size_t>(size_[2]), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) fill_slice(static_cast<std::int64_t>(k), warp);
  });
}

void Torso::fill_slice(std::int64_t k, const ValueNoise& warp) {
  const float z = static_cast<float>(k) * kLatticeMm - kHalfHeight - kMargin;
  const auto skin_radius = [&](float phi, float height) { return contours_.skin_radius(phi, height); };
  const auto wall_radius = [&](float phi, float height) { return contours_.wall_radius(phi, height); };
  const auto cavity_radius = [&](float phi, float height) { return contours_.cavity_radius(phi, height); };
  const SliceContour skin(skin_radius, z);
  const SliceContour wall(wall_radius, z);
  const SliceContour cavity(cavity_radius, z);
  for (std::int64_t j = 0; j < size_[1]; ++j)
    for (std::int64_t i = 0; i < size_[0]; ++i) {
      const float x = static_cast<float>(i) * kLatticeMm - kHalfWidth - kMargin;
      const float y = static_cast<float>(j) * kLatticeMm - kHalfDepth - kMargin;
      const float r = std::hypot(x, y);
      const float phi = std::atan2(x, y);
      const auto signed_distance = [&](const SliceContour& contour, float radius) {
        return std::copysign(contour.distance(x, y), r - radius);
      };
      Node& node = nodes_[static_cast<std::size_t>((k * size_[1] + j) * size_[0] + i)];
      node[0] = signed_distance(skin, skin_radius(phi, z));
      node[1] = signed_distance(wall, wall_radius(phi, z));
      node[2] = signed_distance(cavity, cavity_radius(phi, z));
      const auto height = [&](float hx, float hy) { return contours_.diaphragm_height(hx, hy, node[2]); };
      const float inward_slope = 1.0F / 24.0F * std::exp(std::min(node[2], 0.0F) / 24.0F) * 45.0F;
      const float gx = 0.25F * (height(x + 2.0F, y) - height(x - 2.0F, y));
      const float gy = 0.25F * (height(x, y + 2.0F) - height(x, y - 2.0F));
      node[3] = (z - height(x, y)) / std::sqrt(1.0F + gx * gx + gy * gy + inward_slope * inward_slope);
      const Vec3f cell = Vec3f(x, y, z) / kWarpSizeMm;
      for (int a = 0; a < 3; ++a) node[4 + a] = kWarpMm * warp(cell + Vec3f::Constant(7.3F * static_cast<float>(a)));
      node[7] = 0.0F;
    }
}

Place Torso::at(const Vec3f& p) const {
  const Vec3f index = (p + Vec3f(kHalfWidth + kMargin, kHalfDepth + kMargin, kHalfHeight + kMargin)) / kLatticeMm;
  std::array<std::int64_t, 3> low;
  std::array<float, 3> t;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a);
    low[n] = std::clamp(static_cast<std::int64_t>(index[a]), std::int64_t{0}, size_[n] - 2);
    t[n] = clamp01(index[a] - static_cast<float>(low[n]));
  }
  const Node* corner = &nodes_[static_cast<std::size_t>((low[2] * size_[1] + low[1]) * size_[0] + low[0])];
  const auto row = [&](const Node* node) -> Node { return node[0] + (node[1] - node[0]) * t[0]; };
  const auto plane = [&](const Node* node) -> Node {
    const Node a = row(node);
    return a + (row(node + size_[0]) - a) * t[1];
  };
  const Node below = plane(corner);
  const Node v = below + (plane(corner + size_[0] * size_[1]) - below) * t[2];
  return {p, p + Vec3f(v[4], v[5], v[6]), v[0], v[1], v[2], v[3]};
}

}  // namespace trocar::phantom
