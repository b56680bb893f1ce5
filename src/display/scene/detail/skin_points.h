#pragma once

#include <vector>

#include "anatomy/patient.h"

namespace trocar::scene::detail {

/// Points near the skin (P, mm), some millimetres apart: what a camera shows before there are surfaces.
std::vector<Vec3> skin_points(const anatomy::VirtualPatient& patient);

}  // namespace trocar::scene::detail
