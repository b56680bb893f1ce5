#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "geometry/vec.h"

// Implicit shapes: functions of a point (mm) that are negative inside, zero on the surface, and near it grow by about 1
// per mm. All are Lipschitz within kSteepness, the bound by which blocks of voxels that a shape cannot reach are
// skipped.
namespace trocar::phantom {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kDegree = kPi / 180.0F;

/// Upper bound of the slope of every structure's distance function, noise and warp included.
inline constexpr float kSteepness = 1.7F;

/// An axis-aligned box of P; empty by default.
struct Box {
  Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity());
  Vec3f high = Vec3f::Constant(-std::numeric_limits<float>::infinity());

  static Box around(const Vec3f& centre, const Vec3f& half) { return {centre - half, centre + half}; }
  void add(const Vec3f& p, float radius);
  Box grown(float mm) const { return {low - Vec3f::Constant(mm), high + Vec3f::Constant(mm)}; }
  bool overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

inline float mix(float a, float b, float t) {
  return a + (b - a) * t;
}
inline float clamp01(float t) {
  return t < 0.0F ? 0.0F : (t > 1.0F ? 1.0F : t);
}
/// 0 below `low`, 1 above `high`, smooth between.
inline float smooth_step(float low, float high, float x) {
  const float t = clamp01((x - low) / (high - low));
  return t * t * (3.0F - 2.0F * t);
}
/// exp(-((x - centre) / width)^2).
inline float bump(float x, float centre, float width) {
  const float t = (x - centre) / width;
  return std::exp(-t * t);
}
/// Union and intersection with a fillet of about `radius` mm.
inline float smooth_min(float a, float b, float radius) {
  const float h = std::max(radius - std::abs(a - b), 0.0F) / radius;
  return std::min(a, b) - 0.25F * h * h * radius;
}
inline float smooth_max(float a, float b, float radius) {
  return -smooth_min(-a, -b, radius);
}

/// Ellipsoid around the origin.
inline float ellipsoid(const Vec3f& p, const Vec3f& radii) {
  const Vec3f scaled = p.cwiseQuotient(radii);
  const float k0 = scaled.norm();
  const float k1 = scaled.cwiseQuotient(radii).norm();
  return k1 < 1e-6F ? -radii.minCoeff() : k0 * (k0 - 1.0F) / k1;
}
/// Elliptic cylinder along z around the origin; a and b are its half axes along x and y.
inline float elliptic_cylinder(float x, float y, float a, float b) {
  const float u = x / a;
  const float v = y / b;
  const float k0 = std::sqrt(u * u + v * v);
  const float k1 = std::sqrt(u * u / (a * a) + v * v / (b * b));
  return k1 < 1e-6F ? -std::min(a, b) : k0 * (k0 - 1.0F) / k1;
}

/// Smooth random function of position, periodic far away, values about -1..1; one unit of the argument is one cell.
class ValueNoise {
 public:
  explicit ValueNoise(std::uint64_t seed);
  float operator()(const Vec3f& cell) const;
  /// Two octaves with features of about `size_mm`.
  float fractal(const Vec3f& p, float size_mm) const;

 private:
  static constexpr int kCells = 32;
  std::vector<float> values_;
};

/// Thin winding lines where two noises cross zero together: small vessels and septa. 1 on the line, 0 off it.
float thread(const ValueNoise& noise, const Vec3f& cell, float thickness);

/// A piece of a tube: a cone with round ends.
struct Cone {
  Vec3f a, b;
  float radius_a, radius_b;
};

/// The nearest point on a tube's centre line.
struct TubeHit {
  float distance;  ///< To the tube's surface; kReach where the tube is farther than that.
  float arc_mm;    ///< Along the centre line from the tube's beginning (of a chain).
  float radius;
  Vec3f centre;
};

/// Many cones (a vessel tree, a bowel loop, a bone's process), found through a grid of cells. Copies share their data.
class Tube {
 public:
  static constexpr float kReach = 14.0F;  ///< Larger distances are not distinguished.

  Tube() = default;
  explicit Tube(std::vector<Cone> cones);
  bool empty() const { return !data_; }
  const Box& bounds() const;
  const std::vector<Cone>& cones() const;
  /// The result of the last point is kept per thread: structures ask for the same point several times.
  TubeHit nearest(const Vec3f& p) const;
  float distance(const Vec3f& p) const { return nearest(p).distance; }

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// A point with the tube's radius there.
struct Knot {
  Vec3f p;
  float radius;
};
/// A smooth chain of cones through the knots (Catmull-Rom).
std::vector<Cone> chain(const std::vector<Knot>& knots, int pieces_per_span = 6);
/// All knots moved by an offset.
std::vector<Knot> moved(std::vector<Knot> knots, const Vec3f& offset);
/// The mirror image at the median plane x = 0.
std::vector<Knot> mirrored(std::vector<Knot> knots);

}  // namespace trocar::phantom
