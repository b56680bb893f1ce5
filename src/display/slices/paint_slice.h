#pragma once

#include <cstdint>
#include <vector>

#include "anatomy/patient.h"
#include "slices/window_level.h"
#include "volume/image.h"
#include "volume/sampling.h"

namespace trocar::slices {

struct SliceStyle {
  Window window;
  double label_opacity = 0.25;  ///< Fill; outlines are always opaque. Range 0..1.
  bool has_outlines = true;
  bool hides_lesions = false;  ///< Lesions (lesions_as_organs) are painted as the organ that they lie in.

  bool operator==(const SliceStyle&) const = default;
};

/// What painting needs besides the picture; kept from one picture to the next.
struct SliceBuffers {
  std::vector<float> hu;
  std::vector<std::uint8_t> gray;
  std::vector<std::uint8_t> ids;
};

/// Paints CT on a plane (trilinear, window/level) and over it the labels (nearest) in their colours, filled and
/// outlined, but for fat, muscle and skin, the ground on which structures lie. Air stands outside the volume. Sets the
/// picture's size to the plane's. Allocates only where a picture is larger than the ones before it. One thread.
void paint_slice(const anatomy::VirtualPatient& patient, const volume::SlicePlane& plane, const SliceStyle& style,
                 SliceBuffers& buffers, volume::RgbImage& picture);

}  // namespace trocar::slices
