#include "phantom/spine_curve.h"

#include <algorithm>
#include <cmath>

#include "phantom/shapes.h"

namespace trocar::phantom {
namespace {

constexpr float kLowest = -340.0F, kHighest = 260.0F, kStep = 2.0F;
constexpr int kIterations = 3;

// The scoliotic part: T10 to L5, with its apex at L2. The vertebrae at the apex turn by this share of the Cobb angle
// [assumed: a moderate curve].
constexpr float kScoliosisLow = -130.0F, kScoliosisHigh = 92.0F;
constexpr float kTurnShare = 0.4F;

/// 0 at the ends of the scoliotic part and outside, 1 at its apex.
float scoliosis_share(float s) {
  const float t = clamp01((s - kScoliosisLow) / (kScoliosisHigh - kScoliosisLow));
  return 0.5F - 0.5F * std::cos(2.0F * kPi * t);
}

/// Sideways deviation of the apex at which the steepest parts enclose the Cobb angle.
float scoliosis_mm(float cobb_rad) {
  return std::tan(0.5F * cobb_rad) * (kScoliosisHigh - kScoliosisLow) / kPi;
}

float inclination(const std::vector<SpineInclination>& knots, float s, float flexion) {
  const auto of = [&](const SpineInclination& knot) { return mix(knot.neutral, knot.flexed, flexion); };
  if (s >= knots.front().s_mm) return of(knots.front());
  for (std::size_t n = 1; n < knots.size(); ++n)
    if (s >= knots[n].s_mm)
      return mix(of(knots[n - 1]), of(knots[n]),
                 smooth_step(0.0F, 1.0F, (knots[n - 1].s_mm - s) / (knots[n - 1].s_mm - knots[n].s_mm)));
  return of(knots.back());
}

}  // namespace

SpineCurve::SpineCurve(const Vec3f& anchor_P, const std::vector<SpineInclination>& inclinations,
                       const SpineBend& bend) {
  const auto count = static_cast<std::size_t>(std::lround((kHighest - kLowest) / kStep)) + 1;
  frames_.resize(count);
  const auto s_of = [](std::size_t n) { return kLowest + kStep * static_cast<float>(n); };
  const float apex_mm = scoliosis_mm(bend.scoliosis_rad);
  for (std::size_t n = 0; n < count; ++n) {
    const float s = s_of(n);
    const float back = inclination(inclinations, s, bend.flexion);
    const float sideways = apex_mm * (scoliosis_share(s + 1.0F) - scoliosis_share(s - 1.0F)) * 0.5F;
    Frame& frame = frames_[n];
    frame.up = Vec3f(sideways, -std::sin(back), std::cos(back)).normalized();
    const Vec3f y = Vec3f::UnitY();
    const Vec3f straight_back = (y - frame.up * frame.up.dot(y)).normalized();
    const Vec3f straight_left = straight_back.cross(frame.up);
    const float turn = kTurnShare * bend.scoliosis_rad * scoliosis_share(s);
    frame.back = std::cos(turn) * straight_back + std::sin(turn) * straight_left;
    frame.left = frame.back.cross(frame.up);
  }
  for (std::size_t n = 1; n < count; ++n)
    frames_[n].origin = frames_[n - 1].origin + 0.5F * kStep * (frames_[n - 1].up + frames_[n].up);
  const Vec3f anchor = frame_at(anchor_P.z()).origin;
  const Vec3f shift(anchor_P.x() + apex_mm * scoliosis_share(anchor_P.z()) - anchor.x(), anchor_P.y() - anchor.y(),
                    anchor_P.z() - anchor.z());
  for (Frame& frame : frames_) frame.origin += shift;
}

SpineCurve::Frame SpineCurve::frame_at(float s_mm) const {
  const float index = std::clamp((s_mm - kLowest) / kStep, 0.0F, static_cast<float>(frames_.size() - 1));
  const auto low = std::min(static_cast<std::size_t>(index), frames_.size() - 2);
  const float t = index - static_cast<float>(low);
  const Frame &a = frames_[low], &b = frames_[low + 1];
  const auto between = [t](const Vec3f& u, const Vec3f& v) -> Vec3f { return u + t * (v - u); };
  return {between(a.origin, b.origin), between(a.left, b.left), between(a.back, b.back), between(a.up, b.up)};
}

Vec3f SpineCurve::straighten(const Vec3f& p_P) const {
  float s = p_P.z();
  for (int n = 0; n < kIterations; ++n) {
    const Frame frame = frame_at(s);
    s = std::clamp(s + (p_P - frame.origin).dot(frame.up), kLowest, kHighest);
  }
  const Frame frame = frame_at(s);
  const Vec3f off = p_P - frame.origin;
  return {off.dot(frame.left), off.dot(frame.back), s + off.dot(frame.up)};
}

Vec3f SpineCurve::bend(const Vec3f& along) const {
  const Frame frame = frame_at(along.z());
  return frame.origin + along.x() * frame.left + along.y() * frame.back;
}

Vec3f SpineCurve::direction(const Vec3f& along, float s_mm) const {
  const Frame frame = frame_at(s_mm);
  return along.x() * frame.left + along.y() * frame.back + along.z() * frame.up;
}

float SpineCurve::y_at(float z) const {
  const auto above = std::lower_bound(frames_.begin(), frames_.end(), z,
                                      [](const Frame& f, float height) { return f.origin.z() < height; });
  if (above == frames_.begin()) return frames_.front().origin.y();
  if (above == frames_.end()) return frames_.back().origin.y();
  const Frame &a = *(above - 1), &b = *above;
  return mix(a.origin.y(), b.origin.y(), (z - a.origin.z()) / (b.origin.z() - a.origin.z()));
}

}  // namespace trocar::phantom
