#pragma once

#include <atomic>
#include <memory>
#include <vector>

namespace trocar::realtime {

/// Immutable objects that one thread makes and a real-time thread uses: publish and collect belong to the maker,
/// acquire to the user. The user never frees anything. Invariant: `kept_` holds everything that the user may still be
/// reading.
template <class T>
class Handover {
 public:
  Handover() = default;
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  /// By the maker: the object for all later acquires; null: none.
  void publish(std::shared_ptr<const T> object) {
    offered_.store(object.get(), std::memory_order_seq_cst);
    kept_.push_back(std::move(object));
    collect();
  }
  /// By the maker, now and then: frees what nobody can be reading any more.
  void collect() {
    const T* offered = offered_.load(std::memory_order_seq_cst);
    const T* trying = trying_.load(std::memory_order_seq_cst);
    const T* used = used_.load(std::memory_order_seq_cst);
    std::erase_if(kept_, [&](const auto& object) {
      return object.get() != offered && object.get() != used && object.get() != trying;
    });
  }
  /// By the user, once a period: valid until its next acquire. Real-time safe.
  const T* acquire() noexcept {
    // What is tried is announced before it is looked at again: offered still, so it was not collected in between.
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
  const T* current_ = nullptr;  ///< Of the user.
  std::vector<std::shared_ptr<const T>> kept_;
};

}  // namespace trocar::realtime
