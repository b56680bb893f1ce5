#include "anatomy/skin_now.h"

#include <cmath>

#include "volume/sampling.h"

namespace trocar::anatomy {

double SkinNow::distance_mm(const Vec3& p_P) const noexcept {
  const volume::FloatGrid& grid = patient_->skin_distance_mm;
  if (motion_.is_rest()) return volume::sample_linear(grid, p_P);
  const Vec3 p_A = motion_.to_rest(p_P);
  const double at_rest_mm = volume::sample_linear(grid, p_A);
  const double slope_A = volume::gradient_per_mm(grid, p_A).norm();
  const double slope_P = motion_.gradient_to_now(p_A, volume::gradient_per_mm(grid, p_A)).norm();
  return slope_P > 1e-6 ? at_rest_mm * slope_A / slope_P : at_rest_mm;
}

Vec3 SkinNow::inward(const Vec3& p_P) const noexcept {
  const Vec3 p_A = motion_.to_rest(p_P);
  const Vec3 outward_P = motion_.gradient_to_now(p_A, volume::gradient_per_mm(patient_->skin_distance_mm, p_A));
  const double size = outward_P.norm();
  return size > 1e-6 ? Vec3(-outward_P / size) : Vec3(0.0, 1.0, 0.0);
}

Vec3 SkinNow::nearest(const Vec3& p_P) const noexcept {
  Vec3 q_P = p_P;
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    const double away_mm = distance_mm(q_P);
    if (std::abs(away_mm) < 1e-3) break;
    q_P += away_mm * inward(q_P);
  }
  return q_P;
}

}  // namespace trocar::anatomy
