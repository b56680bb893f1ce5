#include <algorithm>
#include <array>
#include <cmath>

#include "anatomy/phantom/bone.h"

namespace trocar::anatomy::phantom {
namespace {

/// The border of the iliac wing: height (mm) by the angle from the back's midline (deg). The crest is highest at the
/// level of L4; it ends behind at the posterior superior iliac spine and in front at the anterior one.
constexpr std::array<std::array<float, 2>, 8> kCrest{{{34.0F, -168.0F},
                                                      {40.0F, -148.0F},
                                                      {54.0F, -118.0F},
                                                      {74.0F, -99.0F},
                                                      {90.0F, -101.0F},
                                                      {104.0F, -122.0F},
                                                      {112.0F, -146.0F},
                                                      {114.0F, -172.0F}}};
constexpr float kWingBottom = -226.0F;
constexpr float kOutwardMm = 17.0F;  ///< From the pelvic cavity, with the iliacus between.

const Vec3f kHip(89.0F, -2.0F, -224.0F);  ///< Middle of the left femur's head.
constexpr float kHeadMm = 23.5F, kSocketMm = 27.0F;

float crest_height(float side_deg) {
  if (side_deg <= kCrest.front()[0]) return kCrest.front()[1];
  for (std::size_t n = 1; n < kCrest.size(); ++n)
    if (side_deg < kCrest[n][0])
      return mix(kCrest[n - 1][1], kCrest[n][1],
                 smooth_step(0.0F, 1.0F, (side_deg - kCrest[n - 1][0]) / (kCrest[n][0] - kCrest[n - 1][0])));
  return kCrest.back()[1];
}

/// A sheet along the wall of the pelvic cavity, thick at the crest and towards the hip joint and the sacrum.
float iliac_wing(const Place& place) {
  const Vec3f& p = place.p;
  const float side_deg = std::atan2(std::abs(p.x()), p.y()) / kDegree;
  const float radius = std::hypot(p.x(), p.y());
  const float top = crest_height(side_deg);
  const float below_crest = top - p.z();
  const float to_joint = smooth_step(-178.0F, -220.0F, p.z());
  const float to_sacrum = smooth_step(62.0F, 38.0F, side_deg);
  const float half = 2.6F + 3.4F * std::exp(-std::max(below_crest, 0.0F) / 9.0F) + 6.5F * to_joint + 4.5F * to_sacrum;
  // Towards the hip the wing turns inwards less than the cavity.
  const float sheet = std::abs(place.cavity - kOutwardMm - 4.0F * to_joint + 8.0F * to_sacrum) - half;
  const float back_end = mix(35.0F, 58.0F, smooth_step(-172.0F, -205.0F, p.z()));  // the greater sciatic notch
  const float front_end = mix(114.0F, 101.0F, smooth_step(-150.0F, -200.0F, p.z()));
  const float ends = std::max(back_end - side_deg, side_deg - front_end) * kDegree * radius;
  return smooth_max(smooth_max(sheet, 0.75F * -below_crest, 4.0F), std::max(ends, kWingBottom - p.z()), 5.0F);
}

/// Pubis and ischium.
Tube lower_bones(float sign) {
  const auto at = [sign](float x, float y, float z) { return Vec3f(sign * x, y, z); };
  return Tube({{at(76, -20, -216), at(48, -46, -230), 9.0F, 6.5F},
               {at(48, -46, -230), at(12, -62, -246), 6.5F, 8.5F},
               {at(12, -62, -246), at(10, -60, -268), 9.0F, 7.5F},
               {at(90, 22, -226), at(80, 32, -262), 13.0F, 13.0F},
               {at(80, 32, -262), at(62, 26, -292), 14.0F, 14.0F},
               {at(10, -60, -268), at(40, -20, -292), 6.5F, 7.0F}});
}

Tube femur(float sign) {
  const Vec3f hip(sign * kHip.x(), kHip.y(), kHip.z());
  const auto from_hip = [&](float x, float y, float z) -> Vec3f { return hip + Vec3f(sign * x, y, z); };
  return Tube({{hip, hip, kHeadMm, kHeadMm},
               {from_hip(10, 2, -6), from_hip(38, 8, -26), 15.0F, 15.0F},
               {from_hip(46, 16, -10), from_hip(44, 12, -40), 13.0F, 17.0F},
               {from_hip(44, 10, -40), from_hip(40, 4, -80), 17.0F, 15.0F}});
}

void add_side(Anatomy& anatomy, float sign) {
  const auto& noise = anatomy.noise;
  const float density = marrow_share(anatomy.body);
  const Vec3f hip(sign * kHip.x(), kHip.y(), kHip.z());
  const Tube lower = lower_bones(sign);
  const std::uint8_t hip_label = anatomy.label("hip" + side_of(sign));
  Box half = whole_box();
  (sign < 0.0F ? half.high : half.low).x() = 0.0F;
  half.high.z() = -85.0F;
  anatomy.add({"hip" + side_of(sign), half,
               [=](const Place& place) {
                 const float head = (place.p - hip).norm();
                 const float socket = std::max(head - kSocketMm - 6.0F, 0.6F * (place.p.x() - hip.x()) * sign - 6.0F);
                 const float solid =
                     smooth_min(iliac_wing(place), smooth_min(lower.distance(place.p), socket, 6.0F), 7.0F);
                 return smooth_max(solid, kHeadMm + 2.6F - head, 2.0F);
               },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float marrow = density * 150.0F + 60.0F * noise(place.p / 4.0F);
                 return bone(distance, 1.7F, 780.0F, marrow, hip_label, brush);
               }});
  const Tube thigh = femur(sign);
  const std::uint8_t femur_label = anatomy.label("femur" + side_of(sign));
  anatomy.add({"femur" + side_of(sign), thigh.bounds(), [=](const Place& place) { return thigh.distance(place.p); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float marrow = density * 220.0F + 70.0F * noise(place.p / 4.0F);
                 return bone(distance, 2.2F, 950.0F, marrow, femur_label, brush);
               }});
}

}  // namespace

void add_pelvis(Anatomy& anatomy) {
  if (anatomy.torso.box().low.z() > -120.0F) return;
  add_side(anatomy, -1.0F);
  add_side(anatomy, 1.0F);
}

}  // namespace trocar::anatomy::phantom
