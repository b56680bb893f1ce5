#pragma once

#include "volume/grid.h"
#include "xray/geometry/c_arm.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {

/// Masses of water and bone along each ray (a digitally reconstructed radiograph before the physics of the beam). All
/// cores. The volume is in the patient now (moved_volume.h). docs/physics.md, X6.
void project(const XrayVolume& volume, const XrayRays& rays, MassImage& masses);

/// Integrals of a grid along each ray, in units of the grid times cm: for agents in a small part of the body.
void project(const volume::FloatGrid& grid, const XrayRays& rays, std::vector<float>& integrals);

}  // namespace trocar::xray
