#include "link/messages.h"

namespace trocar::link {

const char* to_string(ServerState state) noexcept {
  switch (state) {
    case ServerState::kNoScene:
      return "no scene";
    case ServerState::kLoading:
      return "loading";
    case ServerState::kReady:
      return "ready";
    case ServerState::kRunning:
      return "running";
    case ServerState::kFault:
      return "fault";
  }
  return "unknown";
}

}  // namespace trocar::link
