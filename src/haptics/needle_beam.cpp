#include "haptics/needle_beam.h"

#include <numbers>

namespace trocar {

double bending_stiffness_n_mm2(const NeedleGeometry& needle, bool is_stylet_in) noexcept {
  constexpr double kNPerMm2PerGpa = 1000.0;
  const auto second_moment = [](double r) { return std::numbers::pi / 4.0 * r * r * r * r; };
  double moment = second_moment(needle.radius_mm) - second_moment(needle.inner_radius_mm);
  if (is_stylet_in) moment += second_moment(needle.stylet_radius_mm);
  return needle.young_gpa * kNPerMm2PerGpa * moment;
}

NeedleBeam make_needle_beam(const NeedleGeometry& needle, bool is_stylet_in) noexcept {
  const int nodes = needle.body_proxies + 1;
  return {nodes, needle.length_mm / nodes, bending_stiffness_n_mm2(needle, is_stylet_in)};
}

}  // namespace trocar
