#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/pose.h"

namespace trocar::devices {

/// What a message of the Inverse service says of its Inverse3.
enum class HaplyCondition : std::uint8_t {
  kReady,
  kMalformed,  ///< Not JSON, a wrong type, a number that no device can mean.
  kNoDevice,
  kNoPower,
  kNotCalibrated,
  kNotReady,
};
const char* to_string(HaplyCondition condition) noexcept;

/// One state of the service. Vendor's frame: x to the right, y forward, z up (docs.haply.co, Basis Permutation).
struct HaplyState {
  HaplyCondition condition = HaplyCondition::kMalformed;
  std::string device_id;
  Vec3 p_m = Vec3::Zero();  ///< Cursor from the device's base or, centred, from the workspace's middle.
  std::optional<Eigen::Quaterniond> q_grip;  ///< Grip's direction, unit; none: no grip.
  std::uint32_t buttons = 0;                 ///< a, b, c: the first three bits.
  bool is_centred =
      false;  ///< The device's preset says that its origin is the workspace's middle (first message only).
};

inline constexpr std::size_t kMostHaplyBytes = 256 * 1024;  ///< Of one message; ten devices with their configuration.
inline constexpr double kFarthestHaply_m = 1.0;             ///< Of a cursor; the arm is shorter.

/// Any bytes may come. `wanted_id`: the device that is ours; empty: the first one.
HaplyState parse_haply_state(std::string_view text, std::string_view wanted_id);

/// The command that answers a state: a force (N, finite) in the vendor's frame.
std::string haply_force_command(std::string_view device_id, const Vec3& force_n);

/// The middle of the workspace from the base. Source: the cursor in the vendor's sample of a first message. [assumed]
inline const Vec3 kHaplyCentre_m{0.0, -0.12, 0.15};

/// X_DS: D has the vendor's axes and its origin in the workspace's middle; the grip points along its own +y (vendor's
/// tutorial 06), which is +z of S, and its +x is +x of S. Without a grip: no rotation.
Pose haply_pose(const HaplyState& state, bool is_centred) noexcept;
/// A force in D for the vendor: the axes are the same.
Vec3 haply_force(const Vec3& f_D) noexcept;

}  // namespace trocar::devices
