#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "ultrasound/engine/detail/needle_image.h"
#include "ultrasound/engine/detail/tissue_texture.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr double kSteelSpeed_m_per_s = 5790.0;  // longitudinal, stainless steel 347, CRC Handbook
constexpr double kBoreSpeed_m_per_s = 1480.0;   // water, 20 degrees C
constexpr float kGrain_mm = 0.25F;              // several within a resolution cell
constexpr int kMostSegments = 1024;

float needle_amplitude(double level_db, double diameter_mm) noexcept {
  return static_cast<float>(std::pow(10.0, level_db / 20.0) * std::sqrt(diameter_mm / kNeedleReference_mm));
}

/// Gaps in an oblique shaft: tissue beside it deflects its weak echo over some millimetres (assumed; docs/physics.md
/// U13). The mean power over a long shaft stays the same.
class Dropouts {
 public:
  /// Amplitude at a place of the shaft tilted by `tilt_rad` from perpendicular to the beam.
  float at(float from_tip_mm, float seed, float tilt_rad) const noexcept {
    constexpr float kFrom_rad = 0.35F, kFull_rad = 0.8F, kDeepest = 0.9F;  // 20 to 45 degrees; 20 dB deep
    const float depth = kDeepest * std::clamp((tilt_rad - kFrom_rad) / (kFull_rad - kFrom_rad), 0.0F, 1.0F);
    const float left = 1.0F - depth * gap(from_tip_mm, seed);
    return left / std::sqrt(1.0F - 2.0F * depth * mean_ + depth * depth * mean_square_);
  }

  static const Dropouts& instance() noexcept {
    static const Dropouts dropouts;
    return dropouts;
  }

 private:
  Dropouts() noexcept {
    constexpr int kPlaces = 20000;
    for (int n = 0; n < kPlaces; ++n) {
      const float here = gap(0.37F * static_cast<float>(n), static_cast<float>(n / 1000));
      mean_ += here / kPlaces;
      mean_square_ += here * here / kPlaces;
    }
  }
  /// 0: none, 1: the middle of a gap.
  static float gap(float from_tip_mm, float seed) noexcept {
    constexpr float kLength_mm = 6.0F, kFrom = 0.05F, kTo = 0.4F;
    const float noise = smooth_noise(from_tip_mm / kLength_mm, 17.0F * seed + 0.5F, 0.5F);
    return std::clamp((noise - kFrom) / (kTo - kFrom), 0.0F, 1.0F);
  }

  float mean_ = 0.0F, mean_square_ = 0.0F;
};

/// A point of a shaft in the beam.
struct Spot {
  float line, walk;
  std::size_t sample;
  float zeta;                        ///< From the image plane, in sigmas of the beam.
  float spacing_mm;                  ///< Between scanlines.
  float lateral_sigma_mm;            ///< Of the applied point spread.
  float along, sideways, elevation;  ///< Direction cosines of the shaft.
  float run_mm;                      ///< Length of the shaft within a resolution cell.
  float level;                       ///< Share of it perpendicular to the beam.
};

bool find_spot(const ScanPlan& plan, const FrameState& frame, const Vec3f& p_T, const Vec3f& direction_T,
               Spot& spot) noexcept {
  const ScanGeometry& g = plan.geometry;
  const Polar at = g.to_polar(Vec2(static_cast<double>(p_T.x()), static_cast<double>(p_T.y())));
  spot.line = static_cast<float>(at.line);
  if (!(spot.line > -2.0F && spot.line < static_cast<float>(plan.lines + 1))) return false;
  const auto near_line =
      static_cast<std::size_t>(std::clamp(spot.line + 0.5F, 0.0F, static_cast<float>(plan.lines - 1)));
  const double pressed_mm = static_cast<double>(frame.walks[near_line].pressed_mm);
  if (!(at.depth_mm > -pressed_mm)) return false;
  const double depth_mm =
      pressed_depth_mm(at.depth_mm, pressed_mm, static_cast<double>(frame.dent_reach) * g.sample_mm());
  spot.walk = static_cast<float>(depth_mm / g.sample_mm() - 0.5);
  if (!(spot.walk >= 0.0F && spot.walk <= static_cast<float>(plan.samples - 1))) return false;
  spot.sample = static_cast<std::size_t>(spot.walk);
  spot.zeta = p_T.z() * plan.inverse_elevation_sigma[spot.sample];
  if (std::abs(spot.zeta) > kBeamEdge) return false;
  spot.spacing_mm = std::max(static_cast<float>(g.line_spacing_mm(depth_mm)), 0.02F);
  spot.line -= frame.bend_mm[near_line * plan.coarse_samples() + spot.sample / kCoarse] / spot.spacing_mm;

  Vec3f along(0.0F, 1.0F, 0.0F);
  if (g.is_fan) along = Vec3f(p_T.x(), p_T.y() + static_cast<float>(g.radius_mm), 0.0F).normalized();
  spot.along = direction_T.dot(along);
  spot.sideways = direction_T.x() * along.y() - direction_T.y() * along.x();
  spot.elevation = direction_T.z();
  const float root_two_pi = std::sqrt(2.0F * std::numbers::pi_v<float>);
  spot.lateral_sigma_mm = spot.spacing_mm / (plan.surface_scale[spot.sample] * root_two_pi);
  const float l = spot.sideways / spot.lateral_sigma_mm;
  const float a = spot.along / static_cast<float>(plan.beam.axial_sigma_mm);
  const float e = spot.elevation * plan.inverse_elevation_sigma[spot.sample];
  spot.run_mm = root_two_pi / std::sqrt(l * l + a * a + e * e);
  spot.level = (l * l + e * e) / (l * l + a * a + e * e);
  return true;
}

/// A needle under construction, from its tip backwards.
class Layer {
 public:
  Layer(const ScanPlan& plan, const FrameState& frame, const NeedleEcho& needle, NeedleImage& image,
        NeedleImage::Part& part, std::uint64_t seed) noexcept
      : plan_(plan), frame_(frame), image_(image), part_(part), seed_(seed) {
    const double diameter_mm = std::clamp(needle.diameter_mm, 0.2, 5.0);
    part.diameter_mm = static_cast<float>(diameter_mm);
    tip_mm_ = static_cast<float>(std::clamp(needle.tip_mm, 0.0, 30.0));
    smooth_ = needle_amplitude(kShaftSmooth_db, diameter_mm);
    rough_ = needle_amplitude(kShaftRough_db, diameter_mm);
    tip_rough_ = needle_amplitude(kTipRough_db, diameter_mm);
    tip_point_ = needle_amplitude(kTipPoint_db, diameter_mm);
  }

  void add_tip(const Vec3f& tip_T, const Vec3f& direction_T) noexcept {
    Spot spot;
    if (!find_spot(plan_, frame_, tip_T, direction_T, spot)) return;
    push_grain(spot, tip_point_ * std::exp(-0.5F * spot.zeta * spot.zeta), 1.0F, 0.0F);
  }

  /// From `near_T`, the end next to the tip, backwards.
  void add_segment(const Vec3f& near_T, const Vec3f& far_T) noexcept {
    const Vec3f way = far_T - near_T;
    const float length_mm = way.norm();
    if (length_mm < 1e-4F) return;
    const Vec3f back = way / length_mm;
    float from = 0.0F, to = length_mm;
    for (int a = 0; a < 3; ++a) clip(near_T[a], back[a], image_.low_T[a], image_.high_T[a], from, to);
    if (from < to) {
      lay_pieces(near_T, back, from, to);
      lay_grains(near_T, back, from, to);
    }
    from_tip_mm_ += length_mm;
  }

 private:
  static void clip(float start, float slope, float low, float high, float& from, float& to) noexcept {
    if (std::abs(slope) < 1e-9F) {
      if (start < low || start > high) to = from;
      return;
    }
    const float a = (low - start) / slope, b = (high - start) / slope;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }

  void lay_pieces(const Vec3f& near_T, const Vec3f& back, float from, float to) noexcept {
    constexpr float kUnheardStep_mm = 0.5F, kLeastStep_mm = 0.01F;
    Spot spot;
    float u = from, step = kLeastStep_mm;
    while (u < to && part_.last_piece < image_.pieces.size()) {
      const float length = std::min(step, to - u);
      const bool is_heard = find_spot(plan_, frame_, near_T + back * (u + 0.5F * length), back, spot);
      if (is_heard) push_piece(spot, from_tip_mm_ + u, length);
      u += length;
      step = kUnheardStep_mm;
      if (!is_heard) continue;
      step = std::min(0.7F * plan_.sample_mm / std::max(std::abs(spot.along), 1e-3F),
                      0.5F * spot.spacing_mm / std::max(std::abs(spot.sideways), 1e-3F));
      step = std::min(step, 0.4F * plan_.elevation_sigma_mm[spot.sample] / std::max(std::abs(spot.elevation), 1e-3F));
      step = std::max(step, kLeastStep_mm);
    }
  }

  void push_piece(const Spot& spot, float from_tip_mm, float length_mm) noexcept {
    const float tilt = std::asin(std::min(std::abs(spot.along), 1.0F));
    const float lobe =
        std::exp(-0.5F * (tilt / static_cast<float>(kShaftTilt_rad)) * (tilt / static_cast<float>(kShaftTilt_rad)));
    ShaftPiece piece;
    piece.line = spot.line;
    piece.walk = spot.walk;
    piece.echo = smooth_ * lobe * std::exp(-0.5F * spot.zeta * spot.zeta) * length_mm / spot.run_mm;
    piece.echo *= from_tip_mm < tip_mm_ ? static_cast<float>(kTipSmoothShare) : dropout(from_tip_mm, tilt);
    piece.ring = lobe;
    piece.level = spot.level;
    piece.half_lines = 0.5F * length_mm * std::abs(spot.sideways) / spot.spacing_mm;
    piece.miss2 = 0.5F * spot.zeta * spot.zeta;
    const float lateral_mm = std::numbers::sqrt2_v<float> * spot.lateral_sigma_mm;
    const float elevation_mm = std::numbers::sqrt2_v<float> * plan_.elevation_sigma_mm[spot.sample];
    piece.line_sigmas = spot.spacing_mm / lateral_mm;
    const float across = std::max(spot.sideways * spot.sideways + spot.elevation * spot.elevation, 1e-6F);
    piece.strip_lateral = spot.elevation * spot.elevation / across;
    piece.strip_sigma2_mm2 =
        piece.strip_lateral * lateral_mm * lateral_mm + (1.0F - piece.strip_lateral) * elevation_mm * elevation_mm;
    constexpr float kEndOn = 0.2F;  // closer to the beam's direction it covers less
    piece.cover = std::min(1.0F, std::sqrt(across) / kEndOn);
    image_.pieces[part_.last_piece++] = piece;
  }

  float dropout(float from_tip_mm, float tilt_rad) const noexcept {
    return Dropouts::instance().at(from_tip_mm, static_cast<float>(seed_ & 0xffU), tilt_rad);
  }

  /// Grains have fixed positions on the needle, independent of the visible part.
  void lay_grains(const Vec3f& near_T, const Vec3f& back, float from, float to) noexcept {
    const float first = std::ceil((from_tip_mm_ + from) / kGrain_mm - 0.5F);
    Spot spot;
    for (float n = first;; n += 1.0F) {
      const float from_tip_mm = (n + 0.5F) * kGrain_mm;
      if (from_tip_mm >= from_tip_mm_ + to) return;
      if (!find_spot(plan_, frame_, near_T + back * (from_tip_mm - from_tip_mm_), back, spot)) continue;
      const float facing = std::sqrt(std::max(0.0F, 1.0F - spot.along * spot.along));
      const float tilt = std::asin(std::min(std::abs(spot.along), 1.0F));
      const float level = from_tip_mm < tip_mm_ ? tip_rough_ : rough_ * facing * dropout(from_tip_mm, tilt);
      // Grains add up incoherently: their mean square is that of the resolution cell.
      const float share = std::sqrt(kGrain_mm * std::numbers::sqrt2_v<float> / spot.run_mm);
      const std::uint64_t bits = mix64(seed_ + static_cast<std::uint64_t>(n));
      push_grain(spot, level * share * std::exp(-0.5F * spot.zeta * spot.zeta), facing,
                 static_cast<float>(bits & 0xffffU) / 65536.0F);
    }
  }

  void push_grain(const Spot& spot, float echo, float ring, float turn) noexcept {
    if (part_.last_grain < image_.grains.size())
      image_.grains[part_.last_grain++] = {spot.line, spot.walk, echo, ring, turn};
  }

  const ScanPlan& plan_;
  const FrameState& frame_;
  NeedleImage& image_;
  NeedleImage::Part& part_;
  std::uint64_t seed_;
  float tip_mm_ = 0.0F, from_tip_mm_ = 0.0F;
  float smooth_ = 0.0F, rough_ = 0.0F, tip_rough_ = 0.0F, tip_point_ = 0.0F;
};

bool is_valid(const NeedleEcho& needle) noexcept {
  constexpr double kFarthest_mm = 1e5;
  if (needle.shaft_P.size() < 2) return false;
  const bool are_numbers = std::isfinite(needle.diameter_mm) && std::isfinite(needle.tip_mm) &&
                           std::isfinite(needle.displacement_mm) && std::isfinite(needle.bore_share);
  return are_numbers && std::all_of(needle.shaft_P.begin(), needle.shaft_P.end(), [](const Vec3& p) {
           return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest_mm;
         });
}

/// Unit direction from hub to tip at the tip; zero if all points coincide.
Vec3 tip_axis(std::span<const Vec3> shaft) noexcept {
  for (std::size_t n = shaft.size() - 1; n-- > 0;) {
    const Vec3 way = shaft.back() - shaft[n];
    if (way.norm() > 1e-3) return way.normalized();
  }
  return Vec3::Zero();
}

/// The needle with the largest drag: only one needle drags tissue.
void drag_tissue(FrameState& frame, const NeedleEcho& needle, const Pose& X_TP, const Vec3& axis_P) noexcept {
  constexpr double kMostDrag_mm = 10.0;
  const double shift_mm = std::clamp(needle.displacement_mm, -kMostDrag_mm, kMostDrag_mm);
  const Vec3f shift_T = (X_TP.R() * axis_P * shift_mm).cast<float>();
  if (shift_T.norm() <= frame.drag.shift_T.norm()) return;
  frame.drag = {(X_TP * needle.shaft_P.back()).cast<float>(), shift_T, kDragReach_mm};
}

}  // namespace

double repeat_spacing_mm(const NeedleEcho& needle) noexcept {
  const double diameter_mm = std::clamp(needle.diameter_mm, 0.2, 5.0);
  const double bore_mm = diameter_mm * std::clamp(needle.bore_share, 0.0, 0.9);
  const double assumed_m_per_s = 1000.0 * kScannerSpeed_mm_per_us;
  return assumed_m_per_s * ((diameter_mm - bore_mm) / kSteelSpeed_m_per_s + bore_mm / kBoreSpeed_m_per_s);
}

NeedleImage make_needle_image(const ScanPlan& plan) {
  NeedleImage image;
  const auto pieces = static_cast<std::size_t>(4 * plan.samples + 4 * plan.lines);
  image.pieces.resize(pieces);
  image.grains.resize(4096);
  const ScanGeometry::Extent extent = plan.geometry.extent();
  const float thick = *std::max_element(plan.elevation_sigma_mm.begin(), plan.elevation_sigma_mm.end());
  const auto corner = [&](double x, double y, float side) {
    return Vec3f(static_cast<float>(x), static_cast<float>(y), side * kBeamEdge * thick);
  };
  // Indentation moves tissue in front of the face, refraction moves it sideways.
  constexpr double kMargin_mm = 15.0;
  image.low_T = corner(extent.x0 - kMargin_mm, extent.y0 - kMargin_mm, -1.0F);
  image.high_T = corner(extent.x1 + kMargin_mm, extent.y1 + kMargin_mm, 1.0F);
  return image;
}

void lay_out_needles(const ScanPlan& plan, FrameState& frame, std::span<const NeedleEcho> needles,
                     NeedleImage& image) noexcept {
  image.count = 0;
  frame.drag = {};
  const Pose X_TP = frame.X_PT.inverse();
  std::size_t piece = 0, grain = 0;
  for (const NeedleEcho& needle : needles) {
    if (image.count == NeedleImage::kMostNeedles) return;
    if (!is_valid(needle)) continue;
    const std::span<const Vec3> shaft = needle.shaft_P;
    const Vec3 axis_P = tip_axis(shaft);
    if (axis_P.isZero()) continue;
    drag_tissue(frame, needle, X_TP, axis_P);
    NeedleImage::Part& part = image.parts[image.count];
    part = {piece, piece, grain, grain, 0.0F, static_cast<float>(repeat_spacing_mm(needle)) / plan.sample_mm};
    Layer layer(plan, frame, needle, image, part, mix64(image.count));
    Vec3f near_T = (X_TP * shaft.back()).cast<float>();
    layer.add_tip(near_T, (X_TP.R() * axis_P).cast<float>());
    int left = kMostSegments;
    for (std::size_t n = shaft.size() - 1; n-- > 0 && left-- > 0;) {
      const Vec3f far_T = (X_TP * shaft[n]).cast<float>();
      layer.add_segment(near_T, far_T);
      near_T = far_T;
    }
    piece = part.last_piece;
    grain = part.last_grain;
    ++image.count;
  }
}

}  // namespace trocar::ultrasound::detail
