#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phantom/cases.h"
#include "phantom/phantom_data.h"
#include "phantom/shapes.h"
#include "phantom/spine_curve.h"

namespace trocar::phantom {

/// The height of the reference body; others are scaled.
inline constexpr double kReferenceHeight_cm = 172.0;

/// How far free fluid lifts the front of the belly, mm.
float belly_bulge_mm(double ascites_ml);

/// A point in the body and its torso coordinates.
struct Place {
  Vec3f p;          ///< P, mm.
  Vec3f q;          ///< p after the smooth random warp that makes the organs of each patient different.
  float skin;       ///< Signed distance to the skin (mm, negative inside the body).
  float wall;       ///< To the outer surface of the muscles of the trunk.
  float cavity;     ///< To the inner surface of the trunk's wall (negative in the abdominal and thoracic cavity).
  float diaphragm;  ///< Height above the diaphragm, along its normal (negative in the abdomen).
  Vec3f spine;      ///< Coordinates along the spine (SpineCurve).
};

/// Closed contours of the trunk, star-shaped around the z axis. phi: angle from the back's midline (rad, 0 posterior,
/// pi/2 lateral, pi anterior), positive towards the patient's left.
class TorsoContours {
 public:
  TorsoContours(std::uint64_t seed, const TorsoData& data, const BodyParameters& body);
  float skin_radius(float phi, float z) const;
  float wall_radius(float phi, float z) const;
  float cavity_radius(float phi, float z) const;
  float diaphragm_height(float x, float y, float cavity) const;
  /// A point `outward_mm` (along the ray) outside the cavity's surface.
  Vec3f on_cavity(float phi, float z, float outward_mm) const;

 private:
  /// The skin of a body with the reference thickness of fat.
  float reference_radius(float phi, float z) const;
  float fat_mm(float phi, float z) const;
  float bulge_mm(float phi, float z) const;
  float muscle_mm(float phi, float z) const;

  TorsoData data_;
  float half_width_;
  float half_depth_;
  float fatness_;  ///< Of the subcutaneous fat, 1 for the reference.
  float flexion_;
  float hip_mm_;
  float bulge_mm_;  ///< Of the belly's front, by free fluid.
  float dome_mm_;
  std::array<float, 3> wave_mm_;
  std::array<float, 3> wave_phase_;
};

/// The torso's distances on a lattice of 4 mm, interpolated between the nodes. The contours are accurate within
/// hundredths of a mm.
class Torso {
 public:
  /// `box`: part of the body in which places are asked for.
  Torso(std::uint64_t seed, const TorsoData& data, const BodyParameters& body, SpineCurve spine, const Box& box);
  const TorsoContours& contours() const { return contours_; }
  const SpineCurve& spine() const { return spine_; }
  const Box& box() const { return box_; }
  Place at(const Vec3f& p) const;

 private:
  using Node = Eigen::Array<float, 12, 1>;
  void fill_slice(std::int64_t k, const ValueNoise& warp);

  TorsoContours contours_;
  SpineCurve spine_;
  Box box_;
  Vec3f corner_;  ///< The lattice's first node.
  std::array<std::int64_t, 3> size_;
  std::vector<Node> nodes_;
};

}  // namespace trocar::phantom
