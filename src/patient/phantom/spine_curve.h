#pragma once

#include <vector>

#include "geometry/vec.h"

namespace trocar::phantom {

/// Inclination of the spine at a height: how far it leads backwards on the way down, rad.
struct SpineInclination {
  float s_mm;     ///< Position along the spine, see SpineCurve.
  float neutral;  ///< Lying flat.
  float flexed;   ///< Back bent, knees drawn up.
};

/// What bends the spine of one patient.
struct SpineBend {
  float flexion = 0.0F;        ///< 0 lying flat .. 1 bent as for a lumbar puncture.
  float scoliosis_rad = 0.0F;  ///< Cobb angle between the ends of the curve; positive: convex to the patient's left.
};

/// The middle line of the vertebral bodies, and coordinates that follow it: x to the patient's left, y backwards and z
/// up along the spine, all measured from the middle line (mm). z is the arc length, and equals the z of P at the
/// anchor. In these coordinates the spine is straight. Distances are stretched by up to 1 / (1 - curvature * distance):
/// behind a lordosis vertebral arches come nearer to each other, and a bent back opens the spaces between them.
class SpineCurve {
 public:
  /// A coordinate frame on the middle line: columns of P.
  struct Frame {
    Vec3f origin, left, back, up;
  };

  SpineCurve() = default;
  /// `anchor_P`: a point of the middle line, which bending does not move. `inclinations` in descending order of s.
  SpineCurve(const Vec3f& anchor_P, const std::vector<SpineInclination>& inclinations, const SpineBend& bend);

  /// Coordinates along the spine of a point of P.
  Vec3f straighten(const Vec3f& p_P) const;
  /// Point of P at coordinates along the spine.
  Vec3f bend(const Vec3f& along) const;
  /// A direction along the spine at s, in P.
  Vec3f direction(const Vec3f& along, float s_mm) const;
  /// y in P of the middle line at a height z of P.
  float y_at(float z) const;

 private:
  Frame frame_at(float s_mm) const;
  std::vector<Frame> frames_;  ///< From below, every kStep.
};

}  // namespace trocar::phantom
