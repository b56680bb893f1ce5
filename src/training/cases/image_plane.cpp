#include "cases/image_plane.h"

namespace trocar::cases {

metrics::ImagePlane image_plane(const ultrasound::Transducer& transducer, double depth_mm) {
  const bool is_linear = transducer.kind == ultrasound::TransducerKind::kLinear;
  metrics::ImagePlane plane;
  plane.depth_mm = depth_mm;
  plane.field_of_view_rad = is_linear ? 0.0 : transducer.field_of_view_rad;
  plane.radius_mm = is_linear || transducer.kind == ultrasound::TransducerKind::kPhased ? 0.0 : transducer.radius_mm;
  plane.width_mm = transducer.face_width_mm();
  plane.elevation_mm = transducer.elevation_aperture_mm;
  plane.elevation_focus_mm = transducer.elevation_focus_mm;
  return plane;
}

}  // namespace trocar::cases
