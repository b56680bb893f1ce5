#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/random.h"
#include "geometry/vec.h"

// Implicit shapes: functions of a point (mm) that are negative inside, zero on the surface, and near it grow by about 1
// per mm. All are Lipschitz within kSteepness, the bound by which blocks of voxels that a shape cannot reach are
// skipped.
namespace trocar::anatomy::phantom {

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
float smooth_step(float low, float high, float x);
/// exp(-((x - centre) / width)^2).
float bump(float x, float centre, float width);
/// Union and intersection with a fillet of about `radius` mm.
float smooth_min(float a, float b, float radius);
float smooth_max(float a, float b, float radius);

/// Ellipsoid around the origin.
float ellipsoid(const Vec3f& p, const Vec3f& radii);
/// Elliptic cylinder along z around the origin; a and b are its half axes along x and y.
float elliptic_cylinder(float x, float y, float a, float b);

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

/// Many cones (a vessel tree, a bowel loop, a bone's process), found through a grid of cells.
class Tube {
 public:
  static constexpr float kReach = 14.0F;  ///< Larger distances are not distinguished.

  Tube() = default;
  explicit Tube(std::vector<Cone> cones);
  bool empty() const { return cones_.empty(); }
  const Box& bounds() const { return bounds_; }
  const std::vector<Cone>& cones() const { return cones_; }
  TubeHit nearest(const Vec3f& p) const;
  float distance(const Vec3f& p) const { return nearest(p).distance; }

 private:
  void build_cells();
  std::vector<Cone> cones_;
  std::vector<float> arc_begin_;
  Box bounds_;
  std::array<int, 3> cells_{0, 0, 0};
  std::vector<std::uint32_t> cell_begin_;
  std::vector<std::uint16_t> members_;
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

}  // namespace trocar::anatomy::phantom
