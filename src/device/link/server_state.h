#pragma once

#include <cstdint>

namespace trocar::link {

/// What a haptic server is doing.
enum class ServerState : std::uint8_t {
  kNoScene,  ///< Nothing was loaded yet.
  kLoading,  ///< Builds a scene.
  kReady,    ///< Has a scene; no client wants forces.
  kRunning,  ///< A client wants forces; GateMode tells whether they are on.
  kFault,    ///< The safety gate has latched a fault.
};
inline constexpr ServerState kLastServerState = ServerState::kFault;
/// For people: "no scene", "loading", "ready", "running", "fault".
const char* to_string(ServerState state) noexcept;

}  // namespace trocar::link
