#pragma once

#include <optional>
#include <string>

#include "link/client/detail/zmq_handles.h"

namespace trocar::link::detail {

/// Why connections of a client's socket fail before a message: keys that do not fit, one side without keys.
class HandshakeMonitor {
 public:
  /// Watches `socket` from now on. False: not possible; take() then gives nothing.
  bool watch(const ZmqContext& context, ZmqSocket& socket);
  /// The newest failure since the last call.
  std::optional<std::string> take();

 private:
  ZmqSocket events_;
  int watched_ = 0;
};

}  // namespace trocar::link::detail
