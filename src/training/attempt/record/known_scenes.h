#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "link/messages.h"

namespace trocar::attempt {

/// The parameters of a scene.
struct SceneParameters {
  std::vector<std::string> options;  ///< See haptics/option_texts.h.
  std::string tissue_table_toml;
};

/// The scenes that a client requested from a server, by number, as described in the server's replies.
class KnownScenes {
 public:
  void learn(const link::Reply& reply) {
    if (!reply.is_done || reply.scene == 0) return;
    newest_ = reply.scene;
    scenes_[newest_] = {reply.options, reply.tissues_toml};
  }
  /// Call after a restart of the server: it numbers its scenes from 1 again.
  void clear() noexcept {
    scenes_.clear();
    newest_ = 0;
  }
  /// Null: no reply yet.
  const SceneParameters* find(std::uint64_t number) const {
    const auto found = scenes_.find(number);
    return found == scenes_.end() ? nullptr : &found->second;
  }
  const SceneParameters* newest() const { return find(newest_); }
  std::uint64_t newest_number() const noexcept { return newest_; }  ///< 0: none.

 private:
  std::map<std::uint64_t, SceneParameters> scenes_;
  std::uint64_t newest_ = 0;
};

}  // namespace trocar::attempt
