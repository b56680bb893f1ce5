#pragma once

#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound::detail {

/// Adds sheets of connective tissue that are too small for labels (walls of portal triads in the liver), as rows of
/// closely spaced points. The echoes of a row add up along the wave front and cancel elsewhere. A pure function of the
/// position in P; a row is added where its middle and both ends lie in a tissue with strands. Appends to scene.points.
void add_strands(AcousticScene& scene);

/// Divides kidneys, which labels and CT show as one tissue, into what a scan shows: cortex, pyramids and sinus
/// (docs/physics.md U6). Pyramids are cones between cortex and sinus; the sinus is the fat within the kidney's closed
/// outline, and the middle of a kidney without any. Tables without "kidney", "kidney_pyramid" and "renal_sinus" leave
/// the scene as it is. Call before mark_mixed_cells.
void add_kidney_parts(AcousticScene& scene);

}  // namespace trocar::ultrasound::detail
