#include "anatomy/phantom/torso.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kLatticeMm = 4.0F;
constexpr float kMargin = 8.0F;  ///< The lattice extends beyond the box, so that nothing is extrapolated.
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

/// One contour of a slice as a polygon, with the factor that converts the distance in the slice to that in space.
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

  /// Signed distance in space from a point of the slice.
  float distance(float px, float py) const {
    constexpr std::size_t kCoarse = 4;
    std::size_t near = 0;
    float least = std::numeric_limits<float>::infinity();
    const auto look_at = [&](std::size_t n) {
      const float square = (x[n] - px) * (x[n] - px) + (y[n] - py) * (y[n] - py);
      if (square < least) {
        least = square;
        near = n;
      }
    };
    for (std::size_t n = 0; n < kPoints; n += kCoarse) look_at(n);
    const std::size_t middle = near + kPoints;
    for (std::size_t n = middle - kCoarse; n <= middle + kCoarse; ++n) look_at(n % kPoints);
    const float before = to_edge((near + kPoints - 1) % kPoints, near, px, py);
    const float after = to_edge(near, (near + 1) % kPoints, px, py);
    return (std::abs(before) < std::abs(after) ? before : after) * slope_factor[near];
  }

 private:
  /// Signed distance to an edge; the inside is to the right of the direction of travel.
  float to_edge(std::size_t a, std::size_t b, float px, float py) const {
    const float dx = x[b] - x[a];
    const float dy = y[b] - y[a];
    const float ux = px - x[a];
    const float uy = py - y[a];
    const float t = clamp01((ux * dx + uy * dy) / (dx * dx + dy * dy));
    return std::copysign(std::hypot(ux - t * dx, uy - t * dy), uy * dx - ux * dy);
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
  if (side > 0.5F * kPi) r -= 6.0F * bump(std::hypot(x, z - kUmbilicusZ), 0.0F, 13.0F);
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
  // Height at which the diaphragm leaves the wall: low behind (the costophrenic recess), high in front.
  const float rim =
      16.0F + 17.0F * smooth_step(rad(20.0F), rad(95.0F), side) + 41.0F * smooth_step(rad(92.0F), rad(160.0F), side);
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
  const SliceContour skin([&](float phi, float height) { return contours_.skin_radius(phi, height); }, z);
  const SliceContour wall([&](float phi, float height) { return contours_.wall_radius(phi, height); }, z);
  const SliceContour cavity([&](float phi, float height) { return contours_.cavity_radius(phi, height); }, z);
  const auto columns = static_cast<std::size_t>(size_[0]);
  const auto rows = static_cast<std::size_t>(size_[1]);
  Node* const slice = &nodes_[static_cast<std::size_t>(k) * columns * rows];
  std::vector<float> height(columns * rows);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const float x = static_cast<float>(i) * kLatticeMm - kHalfWidth - kMargin;
      const float y = static_cast<float>(j) * kLatticeMm - kHalfDepth - kMargin;
      Node& node = slice[j * columns + i];
      node << skin.distance(x, y), wall.distance(x, y), cavity.distance(x, y), 0, 0, 0, 0, 0;
      height[j * columns + i] = contours_.diaphragm_height(x, y, node[2]);
      const Vec3f cell = Vec3f(x, y, z) / kWarpSizeMm;
      for (int a = 0; a < 3; ++a) node[4 + a] = kWarpMm * warp(cell + Vec3f::Constant(7.3F * static_cast<float>(a)));
    }
  // The distance from the diaphragm is the height difference corrected for its slope.
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const auto slope = [&](std::size_t low, std::size_t high, std::size_t steps) {
        return (height[high] - height[low]) / (kLatticeMm * static_cast<float>(steps));
      };
      const std::size_t i0 = i > 0 ? i - 1 : i;
      const std::size_t i1 = std::min(i + 1, columns - 1);
      const std::size_t j0 = j > 0 ? j - 1 : j;
      const std::size_t j1 = std::min(j + 1, rows - 1);
      const float gx = slope(j * columns + i0, j * columns + i1, i1 - i0);
      const float gy = slope(j0 * columns + i, j1 * columns + i, j1 - j0);
      slice[j * columns + i][3] = (z - height[j * columns + i]) / std::sqrt(1.0F + gx * gx + gy * gy);
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

}  // namespace trocar::anatomy::phantom
