#include "anatomy/phantom/liver_segment.h"

#include <cmath>

namespace trocar::anatomy::phantom {
namespace {

/// Positive to the patient's left of the upright plane through two points.
float left_of(const Vec3f& p, const Vec3f& from, const Vec3f& to) {
  const Vec3f way = to - from;
  return (way.x() * (p.y() - from.y()) - way.y() * (p.x() - from.x())) / std::hypot(way.x(), way.y());
}

// Where the right hepatic vein points to, from the vena cava: forwards and to the right.
const Vec3f kRightVein(-85.0F, -38.0F, 0.0F);
constexpr float kCaudateMm = 24.0F;

}  // namespace

std::string_view liver_segment(const Anatomy& anatomy, const Place& place) {
  const LiverData& liver = anatomy.data.liver;
  const Vec3f cava = liver.venous_confluence;
  const Vec3f& q = place.q;
  const Vec3f gallbladder(
      0.5F * static_cast<float>(anatomy.data.gallbladder.x_mm.low + anatomy.data.gallbladder.x_mm.high),
      anatomy.data.gallbladder.course.back().p.y(), 0.0F);
  const Vec3f fissure(liver.fissure_x_mm, gallbladder.y(), 0.0F);
  const bool is_upper = q.z() > liver.hilum.z() + 0.25F * (liver.hilum.y() - q.y());
  if (std::hypot(q.x() - cava.x() - 14.0F, q.y() - cava.y()) < kCaudateMm && q.y() > liver.hilum.y()) return "I";
  if (left_of(q, cava, gallbladder) > 0.0F) {
    if (left_of(q, cava, fissure) < 0.0F) return "IV";
    return is_upper ? "II" : "III";
  }
  const bool is_in_front = left_of(q, cava, cava + kRightVein) > 0.0F;
  if (is_in_front) return is_upper ? "VIII" : "V";
  return is_upper ? "VII" : "VI";
}

}  // namespace trocar::anatomy::phantom
