#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/pose.h"

namespace trocar::devices {

/// Condition of the Inverse3 in a message of the Inverse service.
enum class HaplyCondition : std::uint8_t {
  kReady,
  kMalformed,  ///< Not JSON, a wrong type, or a number that no device can have.
  kNoDevice,
  kNoPower,
  kNotCalibrated,
  kNotReady,
};
const char* to_string(HaplyCondition condition) noexcept;

/// One state message of the service. Vendor's frame: x to the right, y forward, z up (docs.haply.co, Basis
/// Permutation).
struct HaplyState {
  HaplyCondition condition = HaplyCondition::kMalformed;
  std::string device_id;
  Vec3 p_m = Vec3::Zero();  ///< Cursor from the base of the device; if is_centred, from the middle of the workspace.
  std::optional<Eigen::Quaterniond> q_grip;  ///< Orientation of the grip, unit; empty: no grip.
  std::uint32_t buttons = 0;                 ///< Buttons a, b, c: the first three bits.
  bool is_centred = false;  ///< The device's preset has its origin in the middle of the workspace (first message only).
};

inline constexpr std::size_t kMostHaplyBytes = 256 * 1024;  ///< Of one message: ten devices with their configuration.
inline constexpr double kFarthestHaply_m = 1.0;             ///< Limit of the cursor's distance; the arm is shorter.

/// Accepts any bytes. `wanted_id`: id of the device; empty: the first one.
HaplyState parse_haply_state(std::string_view text, std::string_view wanted_id);

/// The command in reply to a state: a force (N, finite) in the vendor's frame.
std::string haply_force_command(std::string_view device_id, const Vec3& force_n);

/// Middle of the workspace, from the base. Source: cursor in the vendor's example of a first message. [assumed]
inline const Vec3 kHaplyCentre_m{0.0, -0.12, 0.15};

/// X_DS of a state. D has the vendor's axes and its origin in the middle of the workspace. The grip points along its
/// own +y (vendor's tutorial 06), which is +z of S; +x of the grip is +x of S. Without a grip the rotation is the
/// identity.
Pose haply_pose(const HaplyState& state, bool is_centred) noexcept;
/// Converts a force in D to the vendor's frame: the axes are the same.
Vec3 haply_force(const Vec3& f_D) noexcept;

}  // namespace trocar::devices
