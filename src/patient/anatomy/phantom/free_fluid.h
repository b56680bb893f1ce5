#pragma once

#include <memory>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {

/// Free fluid in the abdomen: fills the lowest space of the peritoneal cavity for the patient's posture, and surrounds
/// the bowel on its mesentery, which floats up.
class FreeFluid {
 public:
  /// Adds the fluid before the organs, which cover it. Nothing if the body has no ascites.
  explicit FreeFluid(Anatomy& anatomy);
  /// Call when all organs are there: sets the level at which the space below it holds the wanted volume. Returns the
  /// volume, which is less if the cavity cannot hold it (ml, in the patient's size).
  double settle(Anatomy& anatomy);

 private:
  struct Level {
    float below_mm = 0.0F;  ///< Along gravity; fluid lies where a point is farther along gravity.
  };
  std::shared_ptr<Level> level_;
  std::size_t index_ = 0;  ///< Of the fluid among the structures.
};

}  // namespace trocar::anatomy::phantom
