#include "haptics/insertion/insertion_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "geometry/pose.h"

namespace trocar::haptics {

double prepuncture_force_n(double x_mm, double v_mm_per_s, const LoadingLaw& law) noexcept {
  if (!(x_mm > 0.0)) return 0.0;
  const double k = law.stiffness_n_per_mm;
  const double dx = law.delta_x_mm;
  const double bracket =
      6.0 * law.viscosity_ns_per_mm * v_mm_per_s * dx + k * x_mm * x_mm + 3.0 * k * x_mm * dx + 2.0 * k * dx * dx;
  return std::max(0.0, x_mm * bracket / (6.0 * dx * dx));
}

double static_displacement_mm(double force_n, const LoadingLaw& law) noexcept {
  if (!(force_n > 0.0)) return 0.0;
  double low = 0.0;
  double high = law.delta_x_mm;
  while (prepuncture_force_n(high, 0.0, law) < force_n && high < 1e6) high *= 2.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (prepuncture_force_n(middle, 0.0, law) < force_n ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double tangent_stiffness_n_per_mm(double x_mm, const LoadingLaw& law) noexcept {
  const double x = std::max(0.0, x_mm);
  const double dx = law.delta_x_mm;
  return law.stiffness_n_per_mm * (3.0 * x * x + 6.0 * x * dx + 2.0 * dx * dx) / (6.0 * dx * dx);
}

double contact_area_cm2(double radius_mm, double inserted_mm) noexcept {
  constexpr double kMm2PerCm2 = 100.0;
  return 2.0 * std::numbers::pi * radius_mm * std::max(0.0, inserted_mm) / kMm2PerCm2;
}

double friction_noise(std::uint64_t seed, std::uint32_t tissue, double travel_mm) noexcept {
  const double position = travel_mm / kNoiseCorrelation_mm;
  const double node = std::floor(position);
  const double t = position - node;
  const auto index = static_cast<std::uint64_t>(static_cast<std::int64_t>(node));
  const std::uint64_t stream = mix64(seed ^ (static_cast<std::uint64_t>(tissue) << 32));
  const double a = 2.0 * uniform01(stream, index) - 1.0;
  const double b = 2.0 * uniform01(stream, index + 1) - 1.0;
  return a + (b - a) * t * t * (3.0 - 2.0 * t);
}

namespace {

/// Progress (0..1) through the fade.
double fade_share(double depth_mm, const PathConstraintParams& params) noexcept {
  return std::clamp(depth_mm / params.fade_mm, 0.0, 1.0);
}

double fade_slope_per_mm(double depth_mm, const PathConstraintParams& params) noexcept {
  const double t = fade_share(depth_mm, params);
  return 6.0 * t * (1.0 - t) / params.fade_mm;
}

/// From X' to X_i, the closest point of the path.
Vec3 way_to_path(const PathLine& line, const Vec3& stylus_P) noexcept {
  const Vec3 p_PX = stylus_P - line.origin_P;
  return line.direction_P * line.direction_P.dot(p_PX) - p_PX;
}

/// Energy of a spring that is linear up to `linear` and has a constant force beyond.
double spring_energy(double stretch, double force, double linear) noexcept {
  return stretch < linear ? 0.5 * force / linear * stretch * stretch : force * (stretch - 0.5 * linear);
}

/// U + W: the energy without the fade.
double unfaded_energy_nmm(const PathLine& line, const NeedleAtPath& needle,
                          const PathConstraintParams& params) noexcept {
  return spring_energy(way_to_path(line, needle.stylus_P).norm(), params.force_n, params.linear_mm) +
         spring_energy(angle_between_rad(needle.axis_P, line.direction_P), params.torque_nmm, params.linear_rad);
}

}  // namespace

PathConstraintParams renderable(PathConstraintParams params) noexcept {
  params.linear_rad = std::max(params.linear_rad, params.torque_nmm / kMostPathTurning_nmm_per_rad);
  return params;
}

double tip_depth_mm(const PathLine& line, const NeedleAtPath& needle) noexcept {
  return line.direction_P.dot(needle.stylus_P + needle.length_mm * needle.axis_P - line.origin_P);
}

double path_fade(double depth_mm, const PathConstraintParams& params) noexcept {
  const double t = fade_share(depth_mm, params);
  return t * t * (3.0 - 2.0 * t);
}

double path_energy_nmm(const PathLine& line, const NeedleAtPath& now, const PathConstraintParams& params) noexcept {
  return path_fade(tip_depth_mm(line, now), params) * unfaded_energy_nmm(line, now, params);
}

Wrench path_constraint(const PathLine& line, const NeedleAtPath& now, const NeedleAtPath& ahead,
                       const PathConstraintParams& params) noexcept {
  const double depth_mm = tip_depth_mm(line, now);
  const double fade = path_fade(depth_mm, params);
  const Vec3 along_n =
      line.direction_P * (-fade_slope_per_mm(depth_mm, params) * unfaded_energy_nmm(line, now, params));
  const Vec3 restoring = way_to_path(line, ahead.stylus_P);
  Wrench wrench;
  wrench.force_n = along_n + restoring * (fade * params.force_n / std::max(restoring.norm(), params.linear_mm));
  wrench.torque_nmm = Vec3(now.length_mm * now.axis_P).cross(along_n);

  const Vec3 turn = ahead.axis_P.cross(line.direction_P);
  const double sine = turn.norm();
  constexpr double kParallel = 1e-9;
  if (sine > kParallel) {
    const double theta = angle_between_rad(ahead.axis_P, line.direction_P);
    wrench.torque_nmm += turn * (fade * params.torque_nmm * theta / std::max(theta, params.linear_rad) / sine);
  }
  return wrench;
}

}  // namespace trocar::haptics
