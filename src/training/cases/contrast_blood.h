#pragma once

#include "anatomy/patient.h"
#include "xray/contrast/vessel_streak.h"

namespace trocar::cases {

/// The blood of a patient's vessels (data/flow.toml), which carries contrast agent along; follows the vessels first,
/// which takes seconds. Empty, with a line in the log, where no vessel has flow.
xray::BloodVelocity contrast_blood(const anatomy::VirtualPatient& patient);

}  // namespace trocar::cases
