#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "anatomy/patient.h"
#include "volume/grid.h"

namespace trocar::motion_builder::detail {

/// What breathing moves in its own way.
enum class Part : std::uint8_t {
  kOutside,  ///< Air around the body, and beyond the CT.
  kOther,    ///< Of the body, without a rule of its own: fat, bowel, vessels.
  kLung,
  kLiver,
  kKidney,
  kSpleen,
  kPancreas,
  kStomach,
  kHeart,
  kBowel,
  kRib,    ///< Ribs, their cartilages, sternum.
  kStill,  ///< Spine, pelvis and what lies on them: aorta, back muscles.
  kWall,   ///< Skin, subcutaneous fat, muscles of the wall.
};
inline constexpr std::size_t kParts = 13;

/// The body as the motion model sees it.
struct BodyMap {
  volume::Grid<std::uint8_t> parts;  ///< Part, isotropic, axes of P.
  /// How deep a voxel is inside of the wall (mm); negative: in the wall. Multiples of 1/16, within kDeepest_mm.
  volume::FloatGrid depth_mm;
  /// Middle of the spine in each axial slice of `parts` (x, y).
  std::vector<Eigen::Vector2d> spine_P;
};

inline constexpr double kVoxel_mm = 2.5;
inline constexpr double kDeepest_mm = 48.0;

/// Error: nothing is labelled that breathing moves, or no bone.
Result<BodyMap> map_body(const anatomy::VirtualPatient& patient);

}  // namespace trocar::motion_builder::detail
