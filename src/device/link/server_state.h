#pragma once

#include <cstdint>

namespace trocar::link {

/// State of a haptic server.
enum class ServerState : std::uint8_t {
  kNoScene,  ///< No scene was loaded yet.
  kLoading,  ///< Builds a scene.
  kReady,    ///< Has a scene; forces are not requested.
  kRunning,  ///< Forces are requested; GateMode states whether they are on.
  kFault,    ///< The safety gate has latched a fault.
};
inline constexpr ServerState kLastServerState = ServerState::kFault;
/// Text for messages: "no scene", "loading", "ready", "running", "fault".
const char* to_string(ServerState state) noexcept;

}  // namespace trocar::link
