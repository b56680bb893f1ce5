#pragma once

#include <span>
#include <vector>

#include "xray/detector/detector.h"
#include "xray/geometry/c_arm.h"
#include "xray/projection/xray_volume.h"

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

/// Convolves an image with a Gaussian of `sigma_px` (range 0..100) that keeps the mean; beyond the image its edge goes
/// on. Below 0.7 pixels, where a sampled Gaussian has a wrong width, three weights with the Gaussian's variance. All
/// cores.
void blur_image(std::vector<float>& pixels, int columns, int rows, double sigma_px);

/// Standard deviations of Gaussian blur at the detector, mm: light in the scintillator, from the modulation transfer at
/// one half, and the focal spot's shadow of objects at the isocentre. docs/physics.md, X10.
double scintillator_sigma_mm(const DetectorParams& params) noexcept;
double focal_spot_sigma_mm(const DetectorParams& params, const CArm& arm) noexcept;

}  // namespace trocar::xray
