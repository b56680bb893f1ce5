#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::haptics {

/// Tool represented by the device's stylus.
enum class Tool : std::uint8_t {
  kNeedle,
  kTransducer,  ///< Convex array on the skin (physics.md B9).
  kFinger,      ///< Palpation (physics.md B10).
};
const char* to_string(Tool tool) noexcept;
/// "needle", "probe", "finger"; else exit status 2.
Result<Tool> parse_tool(std::string_view name);

inline constexpr int kMaxContactPoints = 32;
inline constexpr int kColumnCells = 15;
inline constexpr double kColumn_mm = 40.0;  ///< Tissue deeper than this does not yield. Range 20..80. [assumed]
/// Borders of a column's cells. Cells are larger at depths that carry less of the load.
inline constexpr std::array<double, kColumnCells + 1> kCellBorder_mm{0,  2,  4,  6,  8,  10, 12, 14,
                                                                     16, 18, 20, 24, 28, 32, 36, kColumn_mm};

/// The face of a tool on the skin, as points with an area and an outward normal each, in the tool's frame T
/// (transducer: x lateral, y into the body, z elevation, origin at the array's centre; finger: the same, +y along the
/// finger out of its tip, origin at the tip).
struct ContactFace {
  int count = 0;
  std::array<Vec3, kMaxContactPoints> point_T{};
  std::array<Vec3, kMaxContactPoints> normal_T{};  ///< Unit, out of the tool.
  std::array<double, kMaxContactPoints> area_mm2{};
  double friction_mu = 0.0;  ///< Coefficient of friction against the skin. Range 0..2.
  /// Half the width of the face. The rotational coupling equals that of two springs this far apart.
  double lever_mm = 1.0;
  double reach_mm = 0.0;   ///< Stylus origin (grip) to T's origin, along +z of S.
  double spread_mm = 1.0;  ///< Radius of the disc with the same decrease of load with depth.
  /// Compliance times modulus (mm) of homogeneous tissue down to each cell border of a column, under that disc.
  std::array<double, kColumnCells + 1> settlement_mm{};
};

/// Convex array: an arc of `radius_mm` over `width_mm` (chord), `thickness_mm` in elevation. With gel: mu is small. A
/// larger width is limited to the arc's diameter.
ContactFace make_transducer_face(double radius_mm = 60.0, double width_mm = 60.0, double thickness_mm = 14.0);
/// A fingertip: half a ball, on bare skin.
ContactFace make_finger_face(double radius_mm = 8.0);
/// Needle: no face.
ContactFace make_face(Tool tool);
/// Pose of the tool in the stylus: +y of T along +z of S, x of T along x of S, origin `reach_mm` from the grip.
Pose tool_in_stylus(const ContactFace& face) noexcept;

/// Settlement (mm) of the surface down to `depth_mm` for a pressure equal to E*: the share of tissue above that depth
/// (physics.md B9). Grows from 0 to pi/2 spread. Real-time safe.
double settlement_mm(double depth_mm, double spread_mm) noexcept;

}  // namespace trocar::haptics
