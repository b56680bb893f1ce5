#pragma once

#include "anatomy/patient.h"
#include "volume/grid.h"
#include "xray/contrast/duct_tree.h"

namespace trocar::xray::detail {

/// Sets the ends of the ducts and their obstructions: in each stretch of a duct that a lesion encases, the narrowest
/// place is closed if it is narrower than the duct beside it, and else the ends close to it. The papilla is the widest
/// end that touches bowel and is not closed; all other ends are peripheral.
void find_duct_ends(const anatomy::VirtualPatient& patient, double encased_share, DuctTree& tree);

/// The bile ducts' voxels on an isotropic grid around them, with gaps of up to `bridge_mm` between pieces bridged by
/// lines of voxels. Pieces below 20 mm³ that are not joined are left out. Empty without ducts.
volume::MaskGrid make_duct_mask(const anatomy::VirtualPatient& patient, double bridge_mm, double finest_mm);

}  // namespace trocar::xray::detail
