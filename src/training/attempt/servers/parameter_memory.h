#pragma once

#include <map>
#include <string>
#include <vector>

#include "link/messages.h"

namespace trocar::attempt {

/// Parameters that a server's scene has in addition to its LoadScene: all messages since the scene was loaded, merged
/// as the server merges them (see link::SetParameters). They are sent again whenever the scene is loaded again.
class ParameterMemory {
 public:
  /// Numbers of tissues replace those of the last message that named any, options replace those of the same key, and a
  /// table replaces the loaded one. An empty message: the tissues as they were loaded.
  void apply(const link::SetParameters& message);
  /// All of them in one message; empty: the scene as it was loaded.
  link::SetParameters message() const;

 private:
  std::string tissues_toml_;
  std::vector<std::string> tissues_;            ///< "liver.k=0.5", of the last message that named any.
  std::map<std::string, std::string> options_;  ///< "force_model=proxy", by key.
};

}  // namespace trocar::attempt
