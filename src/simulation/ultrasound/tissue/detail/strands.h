#pragma once

#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound::detail {

/// Sheets of connective tissue too small for labels (walls of portal triads in the liver): rows of points close
/// together, which add up where they lie along the wave front and cancel elsewhere. A pure function of the place in P,
/// where the whole row lies in a tissue that has them. Appends to scene.points.
void add_strands(AcousticScene& scene);

}  // namespace trocar::ultrasound::detail
