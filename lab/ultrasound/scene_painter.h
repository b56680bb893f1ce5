#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "ultrasound/probe/transducer.h"
#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound {

/// Block of tissue of a test scene. The middle of the face is the origin of P. The face points along +y; x is lateral,
/// z is elevation: X_PT is the identity.
struct SceneBox {
  double half_width_mm = 30.0;      ///< Along x.
  double depth_mm = 60.0;           ///< Along y, from the face.
  double half_thickness_mm = 15.0;  ///< Along z.
  double spacing_mm = 1.0;          ///< Range 0.2..3. Borders at multiples of the spacing are exact.
  double face_radius_mm = 0.0;      ///< The skin follows a convex face of that radius; 0: flat.
};
/// A box that contains the transducer's scan to that depth.
SceneBox box_for(const Transducer& transducer, double depth_mm, double spacing_mm = 1.0);

/// Tissue (index into the table) at a point of P within the body.
using TissueAt = std::function<std::uint8_t(const Vec3& p_P)>;
/// Distance to the skin, mm, negative inside, if it differs from the box's own.
using SkinDistanceAt = std::function<double(const Vec3& p_P)>;

/// Builds a scene. Tissue outside the skin is 0 (air). Spacing and sizes must be positive.
AcousticScene paint_scene(const SceneBox& box, AcousticTable table, const TissueAt& tissue_at,
                          const SkinDistanceAt& skin_distance_at = {});

}  // namespace trocar::ultrasound
