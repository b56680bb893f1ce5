#include "anatomy/phantom/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::anatomy::phantom {

void Box::add(const Vec3f& p, float radius) {
  low = low.cwiseMin(p - Vec3f::Constant(radius));
  high = high.cwiseMax(p + Vec3f::Constant(radius));
}

float smooth_step(float low, float high, float x) {
  const float t = clamp01((x - low) / (high - low));
  return t * t * (3.0F - 2.0F * t);
}

float bump(float x, float centre, float width) {
  const float t = (x - centre) / width;
  return std::exp(-t * t);
}

float smooth_min(float a, float b, float radius) {
  const float h = std::max(radius - std::abs(a - b), 0.0F) / radius;
  return std::min(a, b) - 0.25F * h * h * radius;
}

float smooth_max(float a, float b, float radius) {
  return -smooth_min(-a, -b, radius);
}

float ellipsoid(const Vec3f& p, const Vec3f& radii) {
  const Vec3f scaled = p.cwiseQuotient(radii);
  const float k0 = scaled.norm();
  const float k1 = scaled.cwiseQuotient(radii).norm();
  return k1 < 1e-6F ? -radii.minCoeff() : k0 * (k0 - 1.0F) / k1;
}

float elliptic_cylinder(float x, float y, float a, float b) {
  const float u = x / a;
  const float v = y / b;
  const float k0 = std::sqrt(u * u + v * v);
  const float k1 = std::sqrt(u * u / (a * a) + v * v / (b * b));
  return k1 < 1e-6F ? -std::min(a, b) : k0 * (k0 - 1.0F) / k1;
}

ValueNoise::ValueNoise(std::uint64_t seed) : values_(static_cast<std::size_t>(kCells * kCells * kCells)) {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = static_cast<float>(2.0 * uniform01(seed, i) - 1.0);
}

float ValueNoise::operator()(const Vec3f& cell) const {
  std::array<int, 3> low;
  std::array<int, 3> high;
  std::array<float, 3> t;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a);
    const float floor = std::floor(cell[a]);
    const float f = cell[a] - floor;
    low[n] = static_cast<int>(floor) & (kCells - 1);
    high[n] = (low[n] + 1) & (kCells - 1);
    t[n] = f * f * (3.0F - 2.0F * f);
  }
  const auto at = [&](int i, int j, int k) { return values_[static_cast<std::size_t>((k * kCells + j) * kCells + i)]; };
  const auto row = [&](int j, int k) { return mix(at(low[0], j, k), at(high[0], j, k), t[0]); };
  const auto plane = [&](int k) { return mix(row(low[1], k), row(high[1], k), t[1]); };
  return mix(plane(low[2]), plane(high[2]), t[2]);
}

float ValueNoise::fractal(const Vec3f& p, float size_mm) const {
  const Vec3f cell = p / size_mm;
  return 0.7F * (*this)(cell) + 0.3F * (*this)(cell * 2.1F + Vec3f(5.3F, 9.1F, 2.7F));
}

float thread(const ValueNoise& noise, const Vec3f& cell, float thickness) {
  const float a = noise(cell) / thickness;
  const float b = noise(cell + Vec3f(11.5F, 3.7F, 6.1F)) / thickness;
  return std::max(0.0F, 1.0F - a * a - b * b);
}

Tube::Tube(std::vector<Cone> cones) : cones_(std::move(cones)) {
  float arc = 0.0F;
  for (const Cone& cone : cones_) {
    arc_begin_.push_back(arc);
    arc += (cone.b - cone.a).norm();
    bounds_.add(cone.a, cone.radius_a);
    bounds_.add(cone.b, cone.radius_b);
  }
  if (!cones_.empty()) build_cells();
}

namespace {
constexpr float kCellMm = 10.0F;
}

void Tube::build_cells() {
  const Box outer = bounds_.grown(kReach);
  const Vec3f extent = (outer.high - outer.low) / kCellMm;
  for (int a = 0; a < 3; ++a) cells_[static_cast<std::size_t>(a)] = static_cast<int>(std::ceil(extent[a])) + 1;
  const float half_diagonal = 0.5F * kCellMm * std::sqrt(3.0F);
  cell_begin_.push_back(0);
  for (int k = 0; k < cells_[2]; ++k)
    for (int j = 0; j < cells_[1]; ++j)
      for (int i = 0; i < cells_[0]; ++i) {
        const Vec3f centre =
            outer.low + kCellMm * (Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)) +
                                   Vec3f::Constant(0.5F));
        for (std::size_t n = 0; n < cones_.size(); ++n) {
          const Cone& cone = cones_[n];
          const Vec3f along = cone.b - cone.a;
          const float t = clamp01((centre - cone.a).dot(along) / std::max(along.squaredNorm(), 1e-6F));
          const float reach = kReach + half_diagonal + std::max(cone.radius_a, cone.radius_b);
          if ((centre - cone.a - t * along).squaredNorm() < reach * reach)
            members_.push_back(static_cast<std::uint16_t>(n));
        }
        cell_begin_.push_back(static_cast<std::uint32_t>(members_.size()));
      }
}

TubeHit Tube::nearest(const Vec3f& p) const {
  TubeHit hit{kReach, 0.0F, 0.0F, p};
  const Vec3f index = (p - bounds_.low + Vec3f::Constant(kReach)) / kCellMm;
  const std::array<int, 3> cell{static_cast<int>(std::floor(index.x())), static_cast<int>(std::floor(index.y())),
                                static_cast<int>(std::floor(index.z()))};
  for (std::size_t a = 0; a < 3; ++a)
    if (cell[a] < 0 || cell[a] >= cells_[a]) return hit;
  const auto offset = static_cast<std::size_t>((cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0]);
  for (std::uint32_t m = cell_begin_[offset]; m < cell_begin_[offset + 1]; ++m) {
    const Cone& cone = cones_[members_[m]];
    const Vec3f along = cone.b - cone.a;
    const float t = clamp01((p - cone.a).dot(along) / std::max(along.squaredNorm(), 1e-6F));
    const Vec3f centre = cone.a + t * along;
    const float radius = mix(cone.radius_a, cone.radius_b, t);
    const float distance = (p - centre).norm() - radius;
    if (distance < hit.distance) hit = {distance, arc_begin_[members_[m]] + t * along.norm(), radius, centre};
  }
  return hit;
}

std::vector<Cone> chain(const std::vector<Knot>& knots, int pieces_per_span) {
  std::vector<Cone> cones;
  const auto last = knots.size() - 1;
  for (std::size_t n = 0; n < last; ++n) {
    const Vec3f& p0 = knots[n == 0 ? 0 : n - 1].p;
    const Vec3f& p1 = knots[n].p;
    const Vec3f& p2 = knots[n + 1].p;
    const Vec3f& p3 = knots[std::min(n + 2, last)].p;
    const auto at = [&](float t) -> Vec3f {
      return 0.5F * (2.0F * p1 + (p2 - p0) * t + (2.0F * p0 - 5.0F * p1 + 4.0F * p2 - p3) * (t * t) +
                     (3.0F * p1 - p0 - 3.0F * p2 + p3) * (t * t * t));
    };
    for (int piece = 0; piece < pieces_per_span; ++piece) {
      const float t0 = static_cast<float>(piece) / static_cast<float>(pieces_per_span);
      const float t1 = static_cast<float>(piece + 1) / static_cast<float>(pieces_per_span);
      cones.push_back({at(t0), at(t1), mix(knots[n].radius, knots[n + 1].radius, t0),
                       mix(knots[n].radius, knots[n + 1].radius, t1)});
    }
  }
  return cones;
}

std::vector<Knot> moved(std::vector<Knot> knots, const Vec3f& offset) {
  for (Knot& knot : knots) knot.p = offset + knot.p;
  return knots;
}

std::vector<Knot> mirrored(std::vector<Knot> knots) {
  for (Knot& knot : knots) knot.p.x() = -knot.p.x();
  return knots;
}

}  // namespace trocar::anatomy::phantom
