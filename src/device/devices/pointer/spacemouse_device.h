#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "devices/pointer/pointer_device.h"

namespace trocar::devices {

/// Deflection of the cap of a SpaceMouse as spacenavd reports it: x, y, z, rx, ry, rz in counts. x is to the right, y
/// up, z away; rotations are left-handed about these axes (libspnav, src/util.c, spnav_posrot_moveobj).
struct SpaceMouseAxes {
  std::array<int, 6> counts{};
};

inline constexpr double kCapFull_counts = 350.0;  ///< 3Dconnexion's devices at sensitivity 1. Range 100..500. [assumed]
inline constexpr double kCapDeadZone_counts = 15.0;   ///< Noise level of a cap at rest. [assumed]
inline constexpr double kCapExponent = 1.5;           ///< As kStickExponent. [assumed]
inline constexpr double kCapSpeed_mm_per_s = 60.0;    ///< Range 10..200. [assumed]
inline constexpr double kCapTurning_rad_per_s = 0.8;  ///< Range 0.1..3. [assumed]
/// A cap without events for this time counts as released. Based on the event rate of a held cap. [assumed]
inline constexpr std::int64_t kCapSilence_ns = 500'000'000;

/// The grip moves and turns in the direction in which the cap is pushed and turned. Real-time safe.
PointerMotion spacemouse_motion(const SpaceMouseAxes& axes, std::uint32_t buttons) noexcept;

/// Source for the SpaceMouse of spacenavd ($SPNAV_SOCKET, else the socket of /etc/spnavrc, else /var/run/spnav.sock).
/// libspnav has one connection per process.
std::unique_ptr<PointerSource> make_spacemouse_source();

}  // namespace trocar::devices
