#pragma once

#include "geometry/vec.h"
#include "volume/image.h"

namespace trocar::scene {

/// A fingertip on the skin. Frame P, mm.
struct Fingertip {
  Vec3 p_P = Vec3::Zero();           ///< Where it touches the skin.
  Vec3 inward_P = Vec3::UnitY();     ///< Unit, into the body.
  volume::Rgb color{200, 200, 200};  ///< Of the ring around it: what it feels.
};

}  // namespace trocar::scene
