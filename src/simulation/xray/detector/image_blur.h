#pragma once

#include <vector>

#include "xray/detector/detector_params.h"
#include "xray/geometry/c_arm.h"

namespace trocar::xray {

/// Convolves an image with a Gaussian of `sigma_px` (range 0..100) that keeps the mean; beyond the image its edge goes
/// on. Below 0.7 pixels, where a sampled Gaussian has a wrong width, three weights with the Gaussian's variance. All
/// cores.
void blur_image(std::vector<float>& pixels, int columns, int rows, double sigma_px);

/// Standard deviations of Gaussian blur at the detector, mm: light in the scintillator, from the modulation transfer at
/// one half, and the focal spot's shadow of objects at the isocentre. docs/physics.md, X10.
double scintillator_sigma_mm(const DetectorParams& params) noexcept;
double focal_spot_sigma_mm(const DetectorParams& params, const CArm& arm) noexcept;

}  // namespace trocar::xray
