#include "attempt/tools/resting_transducer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "volume/sampling.h"

namespace trocar::attempt {
namespace {

constexpr double kPressing_mm_s = 10.0;           // [assumed]
constexpr double kTremor_mm = 0.1;                // amplitude [assumed]
constexpr std::array kTremor_hz{8.0, 9.7, 11.9};  // physiological: 8 to 12 Hz

constexpr double kNearlyAlongBody = 0.99;  // skin that faces head or feet has no direction along the body

struct SkinPoint {
  Vec3 p_P;
  Vec3 outwards_P;  ///< Unit.
};

SkinPoint find_skin(const volume::FloatGrid& distance_mm, Vec3 p_P) noexcept {
  constexpr int kSteps = 20;  // the distance is nearly exact: a few steps suffice
  Vec3 outwards_P = -Vec3::UnitY();
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 slope = volume::gradient_per_mm(distance_mm, p_P);
    if (slope.norm() > 0.0) outwards_P = slope.normalized();
    p_P -= volume::sample_linear(distance_mm, p_P) * outwards_P;
  }
  return {p_P, outwards_P};
}

}  // namespace

RestingTransducer::RestingTransducer(const anatomy::VirtualPatient& patient, const Segment& path_P) noexcept {
  const volume::FloatGrid& distance_mm = patient.skin_distance_mm;
  const SkinPoint entry = find_skin(distance_mm, path_P.a);
  const bool is_on_top = std::abs(entry.outwards_P.z()) > kNearlyAlongBody;
  const Vec3 across = entry.outwards_P.cross(is_on_top ? Vec3::UnitX() : Vec3::UnitZ());
  const Vec3 along_body_P = across.cross(entry.outwards_P).normalized();
  const SkinPoint head = find_skin(distance_mm, entry.p_P + kBeside_mm * along_body_P);
  const SkinPoint feet = find_skin(distance_mm, entry.p_P - kBeside_mm * along_body_P);
  const bool is_head = head.outwards_P.dot(entry.outwards_P) >= feet.outwards_P.dot(entry.outwards_P);
  const SkinPoint& place = is_head ? head : feet;

  Mat3 R_PT;
  R_PT.col(1) = -place.outwards_P;
  // Lateral direction: across the body.
  R_PT.col(0) = (across - across.dot(R_PT.col(1)) * R_PT.col(1)).normalized();
  R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
  X_PT_skin_ = Pose(R_PT, place.p_P);
}

link::HandTarget RestingTransducer::at(double time_s) const noexcept {
  const double lowered_mm = std::min(std::max(0.0, time_s) * kPressing_mm_s, kAbove_mm + kPress_mm);
  const bool is_moving = time_s > 0.0 && lowered_mm < kAbove_mm + kPress_mm;
  Vec3 tremor_T, tremor_mm_s_T;
  for (std::size_t i = 0; i < kTremor_hz.size(); ++i) {
    const double rad_s = 2.0 * std::numbers::pi * kTremor_hz[i];
    tremor_T[static_cast<Eigen::Index>(i)] = kTremor_mm * std::sin(rad_s * time_s);
    tremor_mm_s_T[static_cast<Eigen::Index>(i)] = kTremor_mm * rad_s * std::cos(rad_s * time_s);
  }
  link::HandTarget hand;
  const Vec3 offset_T = (lowered_mm - kAbove_mm) * Vec3::UnitY() + tremor_T;
  hand.X_PN = X_PT_skin_ * Pose::translation(offset_T);
  hand.v_P = X_PT_skin_.R() * (tremor_mm_s_T + (is_moving ? kPressing_mm_s : 0.0) * Vec3::UnitY());
  return hand;
}

}  // namespace trocar::attempt
