#pragma once

#include <optional>
#include <string>

#include "link/client/detail/zmq_handles.h"

namespace trocar::link::detail {

/// Reports why connections of a client's socket fail during the handshake: wrong keys, or keys on only one side.
class HandshakeMonitor {
 public:
  /// Watches `socket` from now on. Returns false if this is not possible; take() then returns nothing.
  bool watch(const ZmqContext& context, ZmqSocket& socket);
  /// Returns the newest failure since the last call.
  std::optional<std::string> take();

 private:
  ZmqSocket events_;
  int watched_ = 0;
};

}  // namespace trocar::link::detail
