#pragma once

#include <array>
#include <string>

#include "registration/shadow/shadow_mask.h"
#include "volume/image.h"

namespace trocar::report::detail {

/// Index axes of a slice: its rows run along `along` (the sound, downwards), its columns along `column`.
struct SliceAxes {
  int column = 0, along = 1, across = 2;
};

/// The axes of the grid nearest to the beam, the lateral and the elevation direction.
SliceAxes slice_axes(const registration::Beams& beams, const volume::GridGeometry& geometry);

/// A slice of an ultrasound volume as an SVG image; one unit is half a millimetre.
struct VolumeSlice {
  volume::RgbImage image;
  volume::GridGeometry geometry;
  SliceAxes axes;

  double width() const noexcept;
  double height() const noexcept;
  /// Place (x, y) of a point of the volume, projected on the slice.
  std::array<double, 2> place(const Vec3& p_P) const noexcept;
  std::string svg(double x) const;
};

/// Gray levels as far as the volume uses them. `region`: shadows are drawn bluish; may be null.
VolumeSlice cut_slice(const volume::LabelGrid& gray, const registration::ImagedRegion* region, const SliceAxes& axes,
                      std::int64_t index);
/// With lines where `source` changes.
VolumeSlice cut_borders(const volume::LabelGrid& gray, const volume::LabelGrid& source, const SliceAxes& axes,
                        std::int64_t index);

}  // namespace trocar::report::detail
