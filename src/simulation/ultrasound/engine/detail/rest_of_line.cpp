#include "ultrasound/engine/detail/rest_shift.h"
#include "ultrasound/engine/detail/tissue_walk.h"

namespace trocar::ultrasound::detail {
namespace {

/// Index of a sample's place now, as place_samples computes it.
Vec3 place_now(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
               const WalkResult& result, int sample) noexcept {
  const auto s = static_cast<std::size_t>(sample);
  const float along = (static_cast<float>(sample) + 0.5F) * plan.sample_mm - line.pressed_mm * frame.contact_shape[s];
  const float elevation = zeta * plan.elevation_sigma_mm[s], sideways = result.sideways_mm[s];
  float behind = 0.0F;
  if (line.has_mirror())
    behind = std::max(0.0F,
                      line.mirror[0] + line.mirror[1] * along + line.mirror[2] * elevation + line.mirror[3] * sideways);
  Vec3 index;
  for (std::size_t a = 0; a < 3; ++a)
    index[static_cast<Eigen::Index>(a)] =
        static_cast<double>(line.origin[a] + along * line.along[a] + elevation * frame.elevation[a] +
                            sideways * line.lateral[a] - behind * line.mirror_normal[a]);
  return index;
}

}  // namespace

void find_rest(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
               WalkResult& result) noexcept {
  const volume::GridGeometry& grid = frame.scene->geometry;
  find_rest_shifts(
      frame.motion, plan.samples, [&](int s) { return place_now(plan, frame, line, zeta, result, s); },
      [&](const Vec3& index) { return grid.to_mm(index); }, [&](const Vec3& p_A) { return grid.to_index(p_A); },
      result.to_rest);
}

}  // namespace trocar::ultrasound::detail
