#pragma once

#include "link/messages.h"

namespace trocar::attempt {

/// Parameters that a server's scene has in addition to its LoadScene: all messages since the scene was loaded, merged
/// as the server merges them (see link::SetParameters). They are sent again whenever the scene is loaded again.
class ParameterMemory {
 public:
  /// Numbers of tissues replace those of the last message that had any, each option replaces the one before, and a
  /// table replaces the loaded one.
  void apply(const link::SetParameters& message);
  /// All of them in one message; empty: the scene as it was loaded.
  const link::SetParameters& message() const noexcept { return all_; }

 private:
  link::SetParameters all_;
};

}  // namespace trocar::attempt
