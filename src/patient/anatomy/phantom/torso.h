#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "anatomy/phantom/phantom_data.h"
#include "anatomy/phantom/shapes.h"
#include "volume/grid.h"

namespace trocar::anatomy::phantom {

/// The box that every phantom fills, for any resolution (mm, P).
inline constexpr float kHalfWidth = 180.5F;
inline constexpr float kHalfDepth = 142.5F;
inline constexpr float kHalfHeight = 114.0F;

/// A point in the body and its torso coordinates.
struct Place {
  Vec3f p;          ///< P, mm.
  Vec3f q;          ///< p after the smooth random warp that makes the organs of each patient different.
  float skin;       ///< Signed distance to the skin (mm, negative inside the body).
  float wall;       ///< To the outer surface of the muscles of the trunk.
  float cavity;     ///< To the inner surface of the trunk's wall (negative in the abdominal and thoracic cavity).
  float diaphragm;  ///< Height above the diaphragm, along its normal (negative in the abdomen).
};

/// Closed contours of the trunk, star-shaped around the z axis. phi: angle from the back's midline (rad, 0 posterior,
/// pi/2 lateral, pi anterior), positive towards the patient's left.
class TorsoContours {
 public:
  TorsoContours(std::uint64_t seed, const TorsoData& data);
  float skin_radius(float phi, float z) const;
  float wall_radius(float phi, float z) const;
  float cavity_radius(float phi, float z) const;
  float diaphragm_height(float x, float y, float cavity) const;
  /// A point `outward_mm` (along the ray) outside the cavity's surface.
  Vec3f on_cavity(float phi, float z, float outward_mm) const;

 private:
  float fat_mm(float phi, float z) const;
  float muscle_mm(float phi, float z) const;

  TorsoData data_;
  float half_width_;
  float half_depth_;
  float fatness_;
  float dome_mm_;
  std::array<float, 3> wave_mm_;
  std::array<float, 3> wave_phase_;
};

/// The torso's distances on a lattice of 4 mm, interpolated between the nodes. The contours are accurate within
/// hundredths of a mm.
class Torso {
 public:
  Torso(std::uint64_t seed, const TorsoData& data);
  const TorsoContours& contours() const { return contours_; }
  Place at(const Vec3f& p) const;

 private:
  using Node = Eigen::Array<float, 8, 1>;
  void fill_slice(std::int64_t k, const ValueNoise& warp);

  TorsoContours contours_;
  std::array<std::int64_t, 3> size_;
  std::vector<Node> nodes_;
};

}  // namespace trocar::anatomy::phantom
