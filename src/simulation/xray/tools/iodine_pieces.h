#pragma once

#include <vector>

#include "motion/patient_motion.h"
#include "xray/contrast/iodine.h"
#include "xray/geometry/c_arm.h"

namespace trocar::xray {

/// Adds the mass of iodine (g/cm²) in ducts and vessels along each ray, averaged over the pixel. Each piece has the
/// mass of its truncated cone; its ends fade into the next piece. Negative concentrations and non-finite pieces are
/// ignored. `rays` are in the frame of the pieces; an empty image is made. All cores.
void add_iodine(const std::vector<IodinePiece>& pieces, const XrayRays& rays, std::vector<float>& iodine_g_per_cm2);

/// Pieces at rest, in frame A, as they are now: their ends move with the tissue, their radii and concentrations change
/// with its stretch so that each keeps its mass.
std::vector<IodinePiece> moved_pieces(std::vector<IodinePiece> pieces, const motion::PatientMotion& motion);

}  // namespace trocar::xray
