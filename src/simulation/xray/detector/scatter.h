#pragma once

#include <span>
#include <vector>

#include "xray/detector/detector_params.h"
#include "xray/geometry/c_arm.h"
#include "xray/projection/mass_image.h"

namespace trocar::xray {

/// Signal of scattered photons behind the grid, relative to the open beam behind the grid, on a coarse raster over the
/// image.
struct Scatter {
  int columns = 0, rows = 0;
  std::vector<float> signal;

  double mean() const noexcept;
};

/// Scatter behind the patient (docs/physics.md, X8): each part of the primary beam scatters in proportion to the
/// mass on its ray; a Gaussian spreads it, so that it falls towards the edges of the irradiated field and with the size
/// of the field. `primary`: signal of each pixel, 0 where the beam is collimated. The raster of `patient` may be
/// coarser.
Scatter estimate_scatter(const MassImage& patient, std::span<const float> primary, const CArm& arm,
                         const DetectorParams& params);

/// signal += scatter, interpolated. All cores.
void add_scatter(const Scatter& scatter, int columns, int rows, std::span<float> signal);

}  // namespace trocar::xray
