#pragma once

#include <atomic>
#include <memory>
#include <vector>

namespace trocar::realtime {

/// Immutable objects built by one thread and used by a real-time thread: the builder calls publish and collect, the
/// user acquire. The user never frees memory. Invariant: `kept_` contains all objects that the user may still read.
template <class T>
class Handover {
 public:
  Handover() = default;
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  /// Called by the builder: sets the object for all later acquires. null: no object.
  void publish(std::shared_ptr<const T> object) {
    offered_.store(object.get(), std::memory_order_seq_cst);
    kept_.push_back(std::move(object));
    collect();
  }
  /// Called regularly by the builder: frees objects that the user can no longer read.
  void collect() {
    const T* offered = offered_.load(std::memory_order_seq_cst);
    const T* trying = trying_.load(std::memory_order_seq_cst);
    const T* used = used_.load(std::memory_order_seq_cst);
    std::erase_if(kept_, [&](const auto& object) {
      return object.get() != offered && object.get() != used && object.get() != trying;
    });
  }
  /// Called by the user once per period: the object is valid until the next acquire. Real-time safe.
  const T* acquire() noexcept {
    // Announces the candidate before checking again that it is still offered, so that collect() cannot free it in
    // between.
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const T* object = offered_.load(std::memory_order_seq_cst);
      if (object == current_) return current_;
      trying_.store(object, std::memory_order_seq_cst);
      if (offered_.load(std::memory_order_seq_cst) != object) continue;
      current_ = object;
      used_.store(object, std::memory_order_seq_cst);
      return current_;
    }
    return current_;
  }

 private:
  static constexpr int kAttempts = 4;
  std::atomic<const T*> offered_{nullptr};
  std::atomic<const T*> used_{nullptr};
  std::atomic<const T*> trying_{nullptr};
  const T* current_ = nullptr;  ///< Accessed by the user only.
  std::vector<std::shared_ptr<const T>> kept_;
};

}  // namespace trocar::realtime
