#pragma once

#include <optional>

#include "phantom/phantom_data.h"
#include "phantom/spine_curve.h"
#include "phantom/structure.h"
#include "phantom/torso.h"

namespace trocar::phantom {

/// The rib above the intercostal space at a place of the chest wall; empty without ribs on both sides.
std::optional<int> intercostal_space(const AbdomenData& data, const Place& place);

// Levels of SpineData.
inline constexpr int kT8 = 3, kT12 = 7, kL1 = 8, kL3 = 10, kL5 = 12;

/// Bone: a dense shell around marrow. An old patient's marrow is less dense.
inline Paint bone(float distance, float cortex_mm, float cortex_hu, float marrow_hu, std::uint8_t label,
                  const Brush& brush) {
  return {mix(cortex_hu, marrow_hu, brush.cover(distance + cortex_mm)), label};
}

/// HU of spongy bone by age, as a share of the reference: it falls by about a fifth each ten years from 40 on
/// (L1 trabecular attenuation: P. J. Pickhardt et al., Ann Intern Med 158:588, 2013, table 1: about 2.5 HU a year).
float marrow_share(const BodyParameters& body);

/// Section of the vertebral canal at a position along the spine, in coordinates along it.
struct CanalSection {
  float y;                   ///< Middle, behind that of the bodies, mm.
  float radius_x, radius_y;  ///< mm.
};
CanalSection canal_section(const SpineData& spine, float s_mm);
/// Signed distance to the canal's wall of a point along the spine; below S4 there is no canal.
float canal(const SpineData& spine, const Vec3f& along);
/// Position along the spine of the middle of the disc below a vertebra.
float disc_position(const SpineData& spine, int above);
/// 1 between the laminae, 0 in front of them.
float between_laminae(const SpineData& spine, float s_mm);

void add_discs(Anatomy& anatomy);
/// Ligaments, epidural fat, sac with fluid, cord and roots of the nerves.
void add_spinal_canal(Anatomy& anatomy);
void add_vertebrae(Anatomy& anatomy);
void add_sacrum(Anatomy& anatomy);
void add_spine(Anatomy& anatomy);
/// Hip bones and the heads of the femurs.
void add_pelvis(Anatomy& anatomy);

}  // namespace trocar::phantom
