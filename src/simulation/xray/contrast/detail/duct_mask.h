#pragma once

#include "anatomy/patient.h"
#include "volume/grid.h"

namespace trocar::xray::detail {

/// The bile ducts' voxels on an isotropic grid around them, with gaps of up to `bridge_mm` between pieces bridged by
/// lines of voxels. Pieces below 20 mm³ that are not joined are left out. Empty without ducts.
volume::MaskGrid make_duct_mask(const anatomy::VirtualPatient& patient, double bridge_mm, double finest_mm);

}  // namespace trocar::xray::detail
