#include "xray/tools/detail/tube_piece.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace trocar::xray::detail {
namespace {

constexpr double kCm_per_mm = 0.1;
constexpr double kSteepSine = 0.2;    ///< Sine of the angle of ray and axis below which rays are cast one by one.
constexpr double kWidening = 0.1;     ///< Greatest growth of the radius within half a chord, relative to the chord.
constexpr double kLeastDepth = 0.02;  ///< Distance of a piece from the source, relative to the detector's.
constexpr double kLeastPiece_mm = 1e-6;
constexpr int kBand = 32;  ///< Rows of one thread's work.

/// Pixel of a point: (column, row), and its distance from the source as a share of the detector's.
struct Shadow {
  double column, row, depth;
};

class Projector {
 public:
  explicit Projector(const XrayRays& rays) {
    Mat3 to_P;
    to_P << rays.column_P, rays.row_P, Vec3(rays.first_pixel_P - rays.source_P);
    to_pixel_ = to_P.inverse();
    source_P_ = rays.source_P;
  }
  Shadow operator()(const Vec3& p_P) const {
    const Vec3 q = to_pixel_ * (p_P - source_P_);
    return {q.x() / q.z(), q.y() / q.z(), q.z()};
  }

 private:
  Mat3 to_pixel_;
  Vec3 source_P_;
};

/// Second integral, from 0 to s, of the chord 2 sqrt(R² - s²) of a circle.
double chord_double_integral(double s, double radius) {
  const double x = std::min(std::abs(s) / radius, 1.0);
  const double root = std::sqrt(1.0 - x * x);
  const double inside = radius * radius * radius * (x * std::asin(x) + root - root * root * root / 3.0 - 2.0 / 3.0);
  return inside + 0.5 * std::numbers::pi * radius * radius * std::max(0.0, std::abs(s) - radius);
}

/// Share of the interval centre ± half that lies below `limit`.
double share_below(double limit, double centre, double half) {
  return std::clamp((limit - centre) / (2.0 * half) + 0.5, 0.0, 1.0);
}

/// A ray relative to a piece's axis.
struct RayAtAxis {
  Vec3 direction_P;     ///< Unit vector.
  Vec3 normal_P;        ///< Unit vector, perpendicular to ray and axis.
  double sine, cosine;  ///< Of the angle of ray and axis.
  double distance_mm;   ///< Signed distance of ray and axis, along normal_P.
};

RayAtAxis ray_at_axis(const TubePiece& piece, const XrayRays& rays, double column, double row) {
  RayAtAxis ray;
  ray.direction_P = (rays.pixel_P(column, row) - rays.source_P).normalized();
  const Vec3 normal = ray.direction_P.cross(piece.axis_P);
  ray.sine = normal.norm();
  ray.cosine = ray.direction_P.dot(piece.axis_P);
  ray.normal_P = normal / ray.sine;
  ray.distance_mm = (rays.source_P - piece.a_P).dot(ray.normal_P);
  return ray;
}

/// Place on the axis, from its start, that is closest to the ray.
double place_on_axis_mm(const TubePiece& piece, const XrayRays& rays, const RayAtAxis& ray) {
  const Vec3 w = rays.source_P - piece.a_P;
  return (w.dot(piece.axis_P) - ray.cosine * w.dot(ray.direction_P)) / (ray.sine * ray.sine);
}

/// Signed distances from the axis: of a pixel's ray and of the rays of its neighbours.
struct Strip {
  double before_mm, middle_mm, after_mm;
};

/// Chord averaged over a strip of rays, with weights that fall linearly to its neighbours. `step_mm`: length of the
/// axis that the strip stands for.
double strip_chord_mm(const TubePiece& piece, const XrayRays& rays, const RayAtAxis& middle, const Strip& strip,
                      double step_mm) {
  const double place = place_on_axis_mm(piece, rays, middle);
  const double share = std::clamp(place / piece.length_mm, 0.0, 1.0);
  const double radius = piece.radius_a_mm + share * (piece.radius_b_mm - piece.radius_a_mm);
  const auto [least, most] = std::minmax({strip.before_mm, strip.after_mm});
  if (!(radius > 0.0) || least >= radius || most <= -radius) return 0.0;
  const auto integral = [&](double s) { return chord_double_integral(s, radius); };
  const double at_middle = integral(strip.middle_mm);
  const double after = (integral(strip.after_mm) - at_middle) / (strip.after_mm - strip.middle_mm);
  const double before = (at_middle - integral(strip.before_mm)) / (strip.middle_mm - strip.before_mm);
  const double chord = 2.0 * (after - before) / (strip.after_mm - strip.before_mm);
  // The ray passes the axis obliquely: a chord near an end lies in the piece by a share.
  const double offset = std::clamp(strip.middle_mm, -radius, radius);
  const double half_mm = std::sqrt(radius * radius - offset * offset) * std::abs(middle.cosine) / middle.sine;
  const double reach_mm = std::max({half_mm, 0.5 * step_mm, 0.5 * piece.end_softness_mm, 1e-9});
  const double start_mm = -offset * middle.normal_P.dot(piece.start_tilt);
  const double end_mm = piece.length_mm - offset * middle.normal_P.dot(piece.end_tilt);
  const double inside = share_below(end_mm, place, reach_mm) - share_below(start_mm, place, reach_mm);
  return std::max(0.0, inside) * chord / middle.sine;
}

/// Interval of a ray, mm from the source.
struct RayInterval {
  double from = 0.0, to = 0.0;
  double length() const { return std::max(0.0, to - from); }
};

/// Keeps the part where value + slope * t >= 0.
void clip(RayInterval& t, double value, double slope) {
  if (slope > 0.0) t.from = std::max(t.from, -value / slope);
  if (slope < 0.0) t.to = std::min(t.to, -value / slope);
  if (slope == 0.0 && value < 0.0) t.to = t.from;
}

/// Length of the part of t where a t² + b t + c <= 0.
double length_within(const RayInterval& t, double a, double b, double c) {
  if (t.length() == 0.0) return 0.0;
  if (std::abs(a) < 1e-14) {
    RayInterval part = t;
    clip(part, -c, -b);
    return part.length();
  }
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant <= 0.0) return a > 0.0 ? 0.0 : t.length();
  const double root = std::sqrt(discriminant);
  const double low = (-b - std::copysign(root, a)) / (2.0 * a), high = (-b + std::copysign(root, a)) / (2.0 * a);
  const RayInterval between{std::max(t.from, low), std::min(t.to, high)};
  return a > 0.0 ? between.length() : t.length() - between.length();
}

/// Chord of one ray.
double ray_chord_mm(const TubePiece& piece, const Vec3& source_P, const Vec3& direction_P) {
  const Vec3 w = source_P - piece.a_P;
  const double place = w.dot(piece.axis_P), along = direction_P.dot(piece.axis_P);
  const Vec3 offset = w - place * piece.axis_P, across = direction_P - along * piece.axis_P;
  RayInterval t{0.0, 1e6};
  clip(t, place + offset.dot(piece.start_tilt), along + across.dot(piece.start_tilt));
  clip(t, piece.length_mm - place - offset.dot(piece.end_tilt), -along - across.dot(piece.end_tilt));
  const double slope = (piece.radius_b_mm - piece.radius_a_mm) / piece.length_mm;
  const double radius = piece.radius_a_mm + slope * place, growth = slope * along;
  return length_within(t, across.squaredNorm() - growth * growth, 2.0 * (offset.dot(across) - radius * growth),
                       offset.squaredNorm() - radius * radius);
}

/// The part of an image that a piece can reach.
struct Reach {
  Shadow a, b;
  double half_width;  ///< Pixels.
};

/// Distributes a value at a place between four pixels, as in linear interpolation.
void splat(double column, double row, double value, const PixelRows& pixels) {
  const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
  for (int v = std::max(r, pixels.first_row); v <= std::min(r + 1, pixels.last_row - 1); ++v)
    for (int u = std::max(c, 0); u <= std::min(c + 1, pixels.rays.columns - 1); ++u) {
      const double weight = (1.0 - std::abs(column - u)) * (1.0 - std::abs(row - v));
      pixels.at(u, v) += static_cast<float>(weight * value);
    }
}

void add_ray_by_ray(const TubePiece& piece, const Reach& reach, const PixelRows& pixels) {
  const XrayRays& rays = pixels.rays;
  const double radius = std::max(piece.radius_a_mm, piece.radius_b_mm);
  const double pixel_mm = rays.column_P.norm() * std::max(reach.a.depth, reach.b.depth);
  const int samples = std::clamp(static_cast<int>(std::ceil(10.0 * pixel_mm / radius)), 3, 24);
  const double scale = piece.density_g_per_cm3 * kCm_per_mm / (samples * samples);
  const auto first = [&](double x, double y) {
    return static_cast<int>(std::floor(std::min(x, y) - reach.half_width));
  };
  const auto last = [&](double x, double y) { return static_cast<int>(std::ceil(std::max(x, y) + reach.half_width)); };
  const int r0 = std::max(pixels.first_row - 1, first(reach.a.row, reach.b.row));
  const int r1 = std::min(pixels.last_row, last(reach.a.row, reach.b.row));
  const int c0 = std::max(-1, first(reach.a.column, reach.b.column));
  const int c1 = std::min(rays.columns, last(reach.a.column, reach.b.column));
  for (int v = r0 * samples; v < (r1 + 1) * samples; ++v)
    for (int u = c0 * samples; u < (c1 + 1) * samples; ++u) {
      const double column = (u + 0.5) / samples - 0.5, row = (v + 0.5) / samples - 0.5;
      const Vec3 direction_P = (rays.pixel_P(column, row) - rays.source_P).normalized();
      const double chord_mm = ray_chord_mm(piece, rays.source_P, direction_P);
      if (chord_mm > 0.0) splat(column, row, chord_mm * scale, pixels);
    }
}

/// Integrates exactly across the shadow, along the image axis that crosses it more steeply; samples along the other.
class StripPainter {
 public:
  StripPainter(const TubePiece& piece, const Reach& reach, const PixelRows& pixels)
      : piece_(piece), reach_(reach), pixels_(pixels) {
    const double columns = reach.b.column - reach.a.column, rows = reach.b.row - reach.a.row;
    is_upright_ = std::abs(rows) >= std::abs(columns);
    along_from_ = is_upright_ ? reach.a.row : reach.a.column;
    across_from_ = is_upright_ ? reach.a.column : reach.a.row;
    const double along = is_upright_ ? rows : columns;
    slope_ = (is_upright_ ? columns : rows) / along;
    shadow_ = std::abs(along);
    half_ = reach.half_width * std::hypot(1.0, slope_);
    // At a joint two pieces complement each other. The free ends of a short piece need finer sampling.
    const bool is_soft = piece.end_softness_mm > 0.0 && reach.half_width > 3.0;
    const int fine = std::clamp(static_cast<int>(std::ceil(40.0 / std::max(shadow_, 1.0))), 3, 12);
    samples_ = is_soft ? 1 : piece.has_free_end ? fine : 3;
  }

  void paint() const {
    const double end = along_from_ + (is_upright_ ? reach_.b.row - reach_.a.row : reach_.b.column - reach_.a.column);
    const int most = is_upright_ ? pixels_.last_row : pixels_.rays.columns;
    const int least = is_upright_ ? pixels_.first_row : 0;
    const int first = std::max(least, static_cast<int>(std::floor(std::min(along_from_, end) - reach_.half_width)));
    const int last = std::min(most - 1, static_cast<int>(std::ceil(std::max(along_from_, end) + reach_.half_width)));
    for (int n = first; n <= last; ++n)
      for (int k = 0; k < samples_; ++k) paint_line(n, n - 0.5 + (k + 0.5) / samples_);
  }

 private:
  RayAtAxis ray(double along, double across) const {
    return is_upright_ ? ray_at_axis(piece_, pixels_.rays, across, along)
                       : ray_at_axis(piece_, pixels_.rays, along, across);
  }

  void paint_line(int n, double along) const {
    const double centre = across_from_ + (along - along_from_) * slope_;
    const int least = is_upright_ ? 0 : pixels_.first_row;
    const int most = is_upright_ ? pixels_.rays.columns : pixels_.last_row;
    const int first = std::max(least, static_cast<int>(std::floor(centre - half_)));
    const int last = std::min(most - 1, static_cast<int>(std::ceil(centre + half_)));
    if (first > last) return;
    const double next = place_on_axis_mm(piece_, pixels_.rays, ray(along + 1.0 / samples_, centre + slope_ / samples_));
    const double here = place_on_axis_mm(piece_, pixels_.rays, ray(along, centre));
    const double step_mm = std::abs(next - here);
    const double scale = piece_.density_g_per_cm3 * kCm_per_mm / samples_;
    RayAtAxis before = ray(along, first - 1.0), middle = ray(along, first);
    for (int m = first; m <= last; ++m) {
      const RayAtAxis after = ray(along, m + 1.0);
      const Strip strip{before.distance_mm, middle.distance_mm, after.distance_mm};
      const double chord = strip_chord_mm(piece_, pixels_.rays, middle, strip, step_mm);
      (is_upright_ ? pixels_.at(m, n) : pixels_.at(n, m)) += static_cast<float>(chord * scale);
      before = middle;
      middle = after;
    }
  }

  const TubePiece& piece_;
  const Reach& reach_;
  const PixelRows& pixels_;
  bool is_upright_ = true;  ///< The shadow runs along the columns.
  double along_from_ = 0.0, across_from_ = 0.0, slope_ = 0.0, shadow_ = 0.0, half_ = 0.0;
  int samples_ = 4;
};

/// Vector that tilts the end of a piece into the plane between its direction and the neighbour's.
Vec3 tilt_between(const Vec3& axis, const Vec3& neighbour) {
  constexpr double kSharpest = 0.5;  // cosine of half the angle: beyond 120 degrees the ends stay square
  const Vec3 normal = (axis + neighbour).normalized();
  const double along = normal.dot(axis);
  if (!(along > kSharpest)) return Vec3::Zero();
  return (normal - along * axis) / along;
}

}  // namespace

void add_piece(const TubePiece& piece, const PixelRows& pixels) {
  const Projector project(pixels.rays);
  const Vec3 end_P = piece.a_P + piece.length_mm * piece.axis_P;
  Reach reach{project(piece.a_P), project(end_P), 0.0};
  if (!(std::min(reach.a.depth, reach.b.depth) > kLeastDepth)) return;
  const double radius = std::max(piece.radius_a_mm, piece.radius_b_mm) + 0.5 * piece.end_softness_mm;
  const double tilt = std::max(piece.start_tilt.norm(), piece.end_tilt.norm());
  const double near = std::min(reach.a.depth, reach.b.depth);
  const double mm_per_pixel = near * std::min(pixels.rays.column_P.norm(), pixels.rays.row_P.norm());
  // Rays at the edge of the image are oblique to the detector.
  const Vec3 middle = (0.5 * (piece.a_P + end_P) - pixels.rays.source_P).normalized();
  const double oblique = std::abs(middle.dot(pixels.rays.column_P.cross(pixels.rays.row_P).normalized()));
  reach.half_width = radius * (1.0 + tilt) / mm_per_pixel / std::max(0.1, oblique) + 1.5;
  const double sine = middle.cross(piece.axis_P).norm(), cosine = std::abs(middle.dot(piece.axis_P));
  const double widening = std::abs(piece.radius_b_mm - piece.radius_a_mm) / piece.length_mm * cosine / sine;
  const bool has_shadow = std::hypot(reach.b.column - reach.a.column, reach.b.row - reach.a.row) > 1e-6;
  if (sine < kSteepSine || widening > kWidening || !has_shadow)
    add_ray_by_ray(piece, reach, pixels);
  else
    StripPainter(piece, reach, pixels).paint();
}

std::vector<TubePiece> pieces_along(const std::vector<Vec3>& line_P, double radius_mm, double density_g_per_cm3) {
  std::vector<TubePiece> pieces;
  for (std::size_t n = 0; n + 1 < line_P.size(); ++n) {
    const Vec3 a_P =
        pieces.empty() ? line_P[n] : Vec3(pieces.back().a_P + pieces.back().length_mm * pieces.back().axis_P);
    const double length = (line_P[n + 1] - a_P).norm();
    if (!(length > kLeastPiece_mm)) continue;
    TubePiece piece;
    piece.a_P = a_P;
    piece.axis_P = (line_P[n + 1] - a_P) / length;
    piece.length_mm = length;
    piece.radius_a_mm = piece.radius_b_mm = radius_mm;
    piece.density_g_per_cm3 = density_g_per_cm3;
    pieces.push_back(piece);
  }
  if (!pieces.empty()) pieces.front().has_free_end = pieces.back().has_free_end = true;
  for (std::size_t n = 0; n + 1 < pieces.size(); ++n) {
    pieces[n].end_tilt = tilt_between(pieces[n].axis_P, pieces[n + 1].axis_P);
    pieces[n + 1].start_tilt = tilt_between(pieces[n + 1].axis_P, pieces[n].axis_P);
  }
  return pieces;
}

void add_pieces(const std::vector<TubePiece>& pieces, const XrayRays& rays, std::vector<float>& g_per_cm2) {
  if (pieces.empty()) return;
  const auto bands = static_cast<std::size_t>((rays.rows + kBand - 1) / kBand);
  parallel_for(bands, 1, [&](std::size_t first, std::size_t last) {
    const PixelRows rows{rays, static_cast<int>(first) * kBand, std::min(static_cast<int>(last) * kBand, rays.rows),
                         g_per_cm2};
    for (const TubePiece& piece : pieces) add_piece(piece, rows);
  });
}

}  // namespace trocar::xray::detail
