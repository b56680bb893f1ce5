#pragma once

#include <span>
#include <string>
#include <vector>

#include "registration/rigid_fit.h"

namespace trocar::registration {

/// A point with its label (mm, frame of its volume).
struct NamedPoint {
  std::string name;
  Vec3 p;
};

/// Rigid fit of landmarks that two volumes share.
struct LandmarkFit {
  RigidFit fit;                        ///< A: CT, B: ultrasound.
  std::vector<std::string> names;      ///< Of the pairs, in the order of the residuals.
  std::vector<std::string> unmatched;  ///< Labels of one side only.
  std::string worst;                   ///< Pair whose omission improves the fit most.
  double worst_mm = 0.0;               ///< Its residual.
  std::string warning;                 ///< Why the fit is doubtful; empty if it is not.
};

/// Pairs the points by label and fits them (docs/physics.md R10). Errors: a label twice on one side, fewer than three
/// pairs, points on one line, mirrored pairs, pairs that do not fit rigidly (rms above 6 mm, or a scale more than 5 %
/// from 1).
Result<LandmarkFit> fit_landmarks(std::span<const NamedPoint> ct, std::span<const NamedPoint> us);

}  // namespace trocar::registration
