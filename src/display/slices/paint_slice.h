#pragma once

#include <cstdint>
#include <vector>

#include "anatomy/patient.h"
#include "motion/patient_motion.h"
#include "slices/window_level.h"
#include "volume/image.h"
#include "volume/sampling.h"

namespace trocar::slices {

struct SliceStyle {
  Window window;
  double label_opacity = 0.25;  ///< Fill; outlines are always opaque. Range 0..1.
  bool has_outlines = true;
  bool hides_lesions = false;  ///< Lesions (lesions_as_organs) are painted as the organ that contains them.

  bool operator==(const SliceStyle&) const = default;
};

/// Buffers of paint_slice, reused for the next image.
struct SliceBuffers {
  std::vector<float> hu;
  std::vector<std::uint8_t> gray;
  std::vector<std::uint8_t> ids;
  std::vector<Vec3f> rest_A;
};

/// Labels that paint_slice draws: not fat, muscle and skin, which are the background of the structures.
bool is_drawn(const anatomy::Label& label) noexcept;

/// Paints CT on a plane (trilinear, window/level) and over it the labels (nearest) in their colours, filled and
/// outlined. Fat, muscle and skin are not painted, as they are the background of structures. The value outside of the
/// volume is air. The plane is in the patient now; `motion` tells where its tissue is at rest. Sets the image size to
/// that of the plane. Allocates only if an image is larger than the previous ones. One thread.
void paint_slice(const anatomy::VirtualPatient& patient, const volume::SlicePlane& plane, const SliceStyle& style,
                 SliceBuffers& buffers, volume::RgbImage& picture, const motion::PatientMotion& motion = {});

}  // namespace trocar::slices
