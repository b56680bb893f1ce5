#pragma once

#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound::detail {

/// Adds sheets of connective tissue that are too small for labels (walls of portal triads in the liver), as rows of
/// closely spaced points. The echoes of a row add up along the wave front and cancel elsewhere. A pure function of the
/// position in P; a row is added where its middle and both ends lie in a tissue with strands. Appends to scene.points.
void add_strands(AcousticScene& scene);

}  // namespace trocar::ultrasound::detail
