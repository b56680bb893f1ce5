#pragma once

#include <cstdint>

#include "geometry/pose.h"
#include "volume/grid.h"
#include "volume/image.h"
#include "volume/sampling.h"

namespace trocar::slices {

/// How an ultrasound volume is shown in a slice of the CT.
enum class FusionKind : std::uint8_t { kOff, kBlend, kCheckerboard };

struct FusionStyle {
  FusionKind kind = FusionKind::kBlend;
  double share = 0.5;      ///< Of the ultrasound in the blend, 0..1.
  double field_mm = 15.0;  ///< Edge of a field of the checkerboard, > 0. The fields do not move with the zoom.

  bool operator==(const FusionStyle&) const = default;
};

/// An ultrasound volume with its pose in the CT. `imaged_U`: not 0 where it shows the body, on the grid of `gray_U`.
struct PlacedUltrasound {
  const volume::LabelGrid& gray_U;
  const volume::MaskGrid& imaged_U;
  double white = 255.0;  ///< Gray level that is shown white, > 0.
  Pose X_PU;
};

/// Draws an ultrasound over an image of paint_slice of the same plane: in orange over the CT, or in the fields of a
/// checkerboard. Nothing is drawn where the ultrasound has no image. One thread.
void fuse_ultrasound(const PlacedUltrasound& ultrasound, const volume::SlicePlane& plane, const FusionStyle& style,
                     volume::RgbImage& picture);

}  // namespace trocar::slices
