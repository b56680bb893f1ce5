#include "phantom/shapes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

namespace trocar::phantom {

void Box::add(const Vec3f& p, float radius) {
  low = low.cwiseMin(p - Vec3f::Constant(radius));
  high = high.cwiseMax(p + Vec3f::Constant(radius));
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
  if (std::abs(a) >= 1.0F) return 0.0F;
  const float b = noise(cell + Vec3f(11.5F, 3.7F, 6.1F)) / thickness;
  return std::max(0.0F, 1.0F - a * a - b * b);
}

namespace {

constexpr float kCellMm = 8.0F;

}  // namespace

struct Tube::Data {
  /// A cone prepared for distances.
  struct Piece {
    Vec3f a, along;
    float inverse_square;  ///< 1 / length^2.
    float radius, widening;
    float arc_begin, length;

    explicit Piece(const Cone& cone, float arc)
        : a(cone.a),
          along(cone.b - cone.a),
          inverse_square(1.0F / std::max(along.squaredNorm(), 1e-6F)),
          radius(cone.radius_a),
          widening(cone.radius_b - cone.radius_a),
          arc_begin(arc),
          length(along.norm()) {}
    float share(const Vec3f& p) const { return clamp01((p - a).dot(along) * inverse_square); }
  };

  std::uint64_t number = next_number();  ///< No other tube has it.
  std::vector<Cone> cones;
  std::vector<Piece> pieces;
  Box bounds;
  std::array<int, 3> cells{0, 0, 0};
  std::vector<std::uint32_t> cell_begin;
  std::vector<std::uint16_t> members;  ///< Of each cell, those nearest to its centre first.

  explicit Data(std::vector<Cone> cones_) : cones(std::move(cones_)) {
    float arc = 0.0F;
    for (const Cone& cone : cones) {
      pieces.emplace_back(cone, arc);
      arc += pieces.back().length;
      bounds.add(cone.a, cone.radius_a);
      bounds.add(cone.b, cone.radius_b);
    }
    build_cells();
  }

  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> count{0};
    return ++count;
  }

  void build_cells() {
    const Box outer = bounds.grown(kReach);
    const Vec3f extent = (outer.high - outer.low) / kCellMm;
    for (int a = 0; a < 3; ++a) cells[static_cast<std::size_t>(a)] = static_cast<int>(std::ceil(extent[a])) + 1;
    cell_begin.push_back(0);
    std::vector<std::pair<float, std::uint16_t>> near;
    for (int k = 0; k < cells[2]; ++k)
      for (int j = 0; j < cells[1]; ++j)
        for (int i = 0; i < cells[0]; ++i) {
          const Vec3f cell(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
          find_near(outer.low + kCellMm * (cell + Vec3f::Constant(0.5F)), near);
          for (const auto& [distance, n] : near) members.push_back(n);
          cell_begin.push_back(static_cast<std::uint32_t>(members.size()));
        }
  }

  /// The pieces that can be the nearest one, within reach, of a point of the cell.
  void find_near(const Vec3f& centre, std::vector<std::pair<float, std::uint16_t>>& near) const {
    const float half_diagonal = 0.5F * kCellMm * std::sqrt(3.0F);
    near.clear();
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      const Piece& piece = pieces[n];
      const float t = piece.share(centre);
      const float axis = (centre - piece.a - t * piece.along).norm();
      const float distance = axis - piece.radius - t * piece.widening;
      if (axis - std::max(piece.radius, piece.radius + piece.widening) > kReach + half_diagonal) continue;
      near.emplace_back(distance, static_cast<std::uint16_t>(n));
      nearest = std::min(nearest, distance);
    }
    // A distance changes by at most the slope of a cone's surface times the way.
    constexpr float kSlope = 1.5F;
    std::erase_if(near, [&](const auto& piece) { return piece.first > nearest + 2.0F * kSlope * half_diagonal; });
    std::sort(near.begin(), near.end());
  }

  TubeHit nearest(const Vec3f& p) const {
    TubeHit hit{kReach, 0.0F, 0.0F, p};
    const Vec3f index = (p - bounds.low + Vec3f::Constant(kReach)) / kCellMm;
    const std::array<int, 3> cell{static_cast<int>(std::floor(index.x())), static_cast<int>(std::floor(index.y())),
                                  static_cast<int>(std::floor(index.z()))};
    for (std::size_t a = 0; a < 3; ++a)
      if (cell[a] < 0 || cell[a] >= cells[a]) return hit;
    const auto offset = static_cast<std::size_t>((cell[2] * cells[1] + cell[1]) * cells[0] + cell[0]);
    for (std::uint32_t m = cell_begin[offset]; m < cell_begin[offset + 1]; ++m) {
      const Piece& piece = pieces[members[m]];
      const float t = piece.share(p);
      const Vec3f centre = piece.a + t * piece.along;
      const float radius = piece.radius + t * piece.widening;
      const float square = (p - centre).squaredNorm();
      const float limit = hit.distance + radius;
      if (limit <= 0.0F || square >= limit * limit) continue;
      hit = {std::sqrt(square) - radius, piece.arc_begin + t * piece.length, radius, centre};
    }
    return hit;
  }
};

Tube::Tube(std::vector<Cone> cones) {
  if (!cones.empty()) data_ = std::make_shared<const Data>(std::move(cones));
}

const Box& Tube::bounds() const {
  static const Box kNone;
  return data_ ? data_->bounds : kNone;
}

const std::vector<Cone>& Tube::cones() const {
  static const std::vector<Cone> kNone;
  return data_ ? data_->cones : kNone;
}

TubeHit Tube::nearest(const Vec3f& p) const {
  struct Last {
    std::uint64_t tube = 0;
    Vec3f p;
    TubeHit hit;
  };
  thread_local Last last;
  if (!data_) return {kReach, 0.0F, 0.0F, p};
  if (last.tube != data_->number || last.p != p) last = {data_->number, p, data_->nearest(p)};
  return last.hit;
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

}  // namespace trocar::phantom
